"""What bodies with the joint names of many makers make of three texts: `make families-table`.

The bodies are those of `tests/rig/body_families.py`: one shape on the joints of each family, with
and without fingers, in T-pose with Y up in metres and in A-pose with Z up in centimetres. The table
goes into docs/rig/bodies.md.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "rig" / "bodies.md"
BEGIN, END = "<!-- families: make families-table -->\n", "<!-- end of families -->\n"
TEXTS = ("tree", "person-aged-52", "cinema-good")
KINDS = (("t", "y", 1.0, True), ("a", "z", 0.01, True), ("t", "y", 1.0, False))
"""Posture, upward axis, unit in metres, and whether there are fingers."""


def rows() -> Iterator[str]:
    """Yield the rows of the table, one for each body."""
    sys.path[:0] = [str(ROOT / "tests" / "rig")]
    from body_families import make_body
    from joint_names import FAMILIES

    import azee
    from azee_rig.importing.folder import write_folder
    from azee_rig.importing.importer import import_body

    for name, family in FAMILIES.items():
        for pose, up, unit, fingers in KINDS:
            with tempfile.TemporaryDirectory() as folder:
                file = make_body(family, fingers=fingers, pose=pose).file(unit=unit, up=up)
                path = file.write(Path(folder) / "body.glb")
                body = Path(folder) / "body"
                write_folder(import_body(path, name), body)
                cells = [
                    _cell(azee.compile(ROOT / "examples" / text / f"{text}.azee", body))
                    for text in TEXTS
                ]
            kind = f"{pose.upper()}-pose, {up.upper()} up, {'m' if unit == 1.0 else 'cm'}"
            yield f"| {name} | {kind}{'' if fingers else ', no fingers'} | {' | '.join(cells)} |"
            print(name, kind, fingers, cells, file=sys.stderr, flush=True)


def _cell(made: object) -> str:
    from azee.compilation import Compilation
    from azee_solver.outcome import Outcome

    assert isinstance(made, Compilation)
    counts = Counter(c.outcome for c in made.report.constraints)
    parts = *(counts[outcome] for outcome in Outcome), len(made.left_out)
    return " · ".join(map(str, parts))


def main() -> None:
    """Put the table on the page."""
    header = f"| family | body | {' | '.join(f'`{text}`' for text in TEXTS)} |"
    lines = [header, "|---|---|" + "---|" * len(TEXTS), *rows()]
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(BEGIN)
    _, after = rest.split(END)
    table = "\n".join(lines)
    PAGE.write_text(f"{before}{BEGIN}\n{table}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
