"""Writes azee.ipynb from the cells below, without outputs; running the notebook makes them."""

from __future__ import annotations

import json
from pathlib import Path

INDENT = "    "
NOTEBOOK = Path(__file__).with_name("azee.ipynb")
CELLS = (
    """# AZee in a notebook

Scores, moving bodies and reports show themselves. They need no network: the player of the body is
part of the output. Install with `pip install azee jupyterlab`, then run the cells.""",
    """    import azee

    made = azee.compile(":info-about(:cinéma, :bien)\\n")
    made.score""",
    """The score says what each part of the body does, and when. The next cell shows the body that
signs it; turn the body with the mouse. Below the body is a table of the constraints and their
residuals.""",
    """    made""",
    """This cell adds a rule: the thumb is at the ear, and the hand points forwards.""",
    '''    phone = """
    def phone
        'meaning "telephone"
        key .6
            cstr
                :#fingers('index = 1, 'middle = 1, 'ring = 1)
                :#thumb('spread = 1)
                place @T_PAD(s) @EAR(s) 'dist .02
                orient 'nrm !palm(s) 'along in(s)
                orient 'dir !palm(s) 'along vsum(^fwd, ^up)
    :info-about(:phone, :bien)
    """
    azee.compile(phone)''',
    """The residuals, the joint coordinates over time and the body are Python objects.""",
    """    worst = max(made.report.constraints, key=lambda c: (c.residual or 0) / c.tolerance)
    print(worst.subject, worst.target, worst.residual, worst.unit)
    made.clip.coordinates.shape""",
    """    made.rig""",
    """Mistakes are reported as `azee check` reports them.""",
    """    try:
        azee.compile(":info-about(:cinema, :well)\\n")
    except azee.AZeeError as error:
        print("\\n".join(error._render_traceback_()))""",
    """The same files as everywhere; the suffix is the format.""",
    """    made.save("sentence.glb")
    made.save("sentence.bvh")""",
)
"""Cells of code are indented; the others are Markdown."""


def notebook() -> str:
    """Return the notebook without outputs, in version 4.5 of the format."""
    cells: list[dict[str, object]] = []
    for number, text in enumerate(CELLS):
        code = text.startswith(INDENT)
        lines = [line.removeprefix(INDENT) if code else line for line in text.splitlines()]
        cell: dict[str, object] = {
            "cell_type": "code" if code else "markdown",
            "id": f"cell-{number}",
            "metadata": {},
            "source": "\n".join(lines),
        }
        cells.append(cell | ({"execution_count": None, "outputs": []} if code else {}))
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    document = {
        "cells": cells,
        "metadata": {"kernelspec": kernel},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    NOTEBOOK.write_text(notebook(), encoding="utf-8")
