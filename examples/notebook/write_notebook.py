"""Writes azee.ipynb from the cells below; its outputs are not kept, running it makes them."""

from __future__ import annotations

import json
from pathlib import Path

INDENT = "    "
NOTEBOOK = Path(__file__).with_name("azee.ipynb")
CELLS = (
    """# AZee in a notebook

Scores, moving bodies and reports show themselves. Nothing is fetched from anywhere: the player of
the body is part of the output. `pip install azee jupyterlab`, then run the cells.""",
    """    import azee

    made = azee.compile(":info-about(:cinéma, :bien)\\n")
    made.score""",
    """The score names who does what, and when. The body that plays it can be turned with the mouse;
below it is how well each constraint is met.""",
    """    made""",
    """A rule of one's own: the thumb at the ear, the hand pointing forwards.""",
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
    """Everything is data: the residuals, the joint coordinates over time, the body.""",
    """    worst = max(made.report.constraints, key=lambda c: (c.residual or 0) / c.tolerance)
    print(worst.subject, worst.target, worst.residual, worst.unit)
    made.clip.coordinates.shape""",
    """    made.rig""",
    """What is wrong is said as `azee check` says it.""",
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
