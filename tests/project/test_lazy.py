"""Commands load what they need and no more: this is what keeps them quick."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from programs import Python

from azee_rig.machine_code import KEEPS

TEXT = "key 1\n    cstr\n        place @I_TIP(s) @CH\n        orient 'nrm !palm(s) 'along ^up\n"
HEAVY = (
    "PIL",
    "alembic",
    "c3d",
    "distributed",
    "lark",
    "matplotlib",
    "mcp",
    "moderngl",
    "pympi",
    "nlopt",
    "numba",
    "numpy",
    "prompt_toolkit",
    "rich",
    "scipy",
    "sklearn",
    "starlette",
    "sqlalchemy",
    "trimesh",
    "uvicorn",
)
SCRIPT = """
import json, sys
from azee.cli.main import run
code = run(sys.argv[2:])
json.dump([name for name in sys.argv[1].split() if name in sys.modules], sys.stderr)
sys.exit(code)
"""
LOADS: dict[tuple[str, ...], set[str]] = {
    ("--help",): set(),
    ("compile", "--help"): set(),
    ("batch", "--help"): set(),
    ("render", "--help"): set(),
    ("pose", "--help"): set(),
    ("blocks", "text.azee"): {"lark"},
    ("clip", "cut", "--help"): set(),
    ("mcp", "--help"): set(),
    ("repl", "--help"): set(),
    ("repl",): {"lark"},
    ("play", "--help"): set(),
    ("rig", "--help"): set(),
    ("capture", "reconstruct", "--help"): set(),
    ("corpus", "stats", "--help"): set(),
    ("db", "add", "--help"): set(),
    ("db", "create", "--quiet", "--db", "signs.db"): {"alembic", "sqlalchemy"},
    ("db", "list", "--db", "stored.db"): {"sqlalchemy"},
    ("elan", "compare", "--help"): set(),
    ("spell", "--help"): set(),
    ("studio", "--help"): set(),
    ("study", "--help"): set(),
    ("spell", "timing", "word"): {"numpy"},
    ("rig", "sites", "--format", "json"): {"numpy"},
    ("check", "--quiet", "text.azee"): {"lark"},
    ("check", "--format", "json", "text.azee"): {"lark"},
    ("find", "--quiet", "key ?d ?c", "text.azee"): {"lark"},
    ("fmt", "--check", "text.azee"): {"lark"},
    ("score", "text.azee"): {"lark"},
    ("score", "text.azee", "-o", "score.svg"): {"lark"},
    ("compile", "--quiet", "text.azee", "-o", "a.json", "-o", "a.glb", "-o", "a.bvh"): {
        *("lark", "nlopt", "numpy", *([] if KEEPS else ["numba"]))
    },
}
"""Of the heavy packages, those that a command may load."""


@pytest.mark.long
@pytest.mark.parametrize("arguments", LOADS, ids=" ".join)
def test_a_command_loads_no_more_than_it_needs(
    arguments: tuple[str, ...], python: Python, tmp_path: Path
) -> None:
    (tmp_path / "text.azee").write_text(TEXT, encoding="utf-8")
    if "stored.db" in arguments:
        python("-m", "azee", "db", "create", "--db", "stored.db", expect=0)
    if "nlopt" in LOADS[arguments]:  # kernels are compiled once
        python("-m", "azee", *arguments, expect=0)
    done = python("-c", SCRIPT, " ".join(HEAVY), *arguments, expect=0)
    assert set(json.loads(done.stderr)) <= LOADS[arguments]


def test_importing_the_package_loads_none_of_them(python: Python) -> None:
    script = "import azee, sys; print([m for m in sys.argv[1].split() if m in sys.modules])"
    assert python("-c", script, " ".join(HEAVY), expect=0).stdout.strip() == "[]"
