"""Who may import whom, read from the sources; CONTRIBUTING.md shows the same as a picture."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from sources import MODULES, ROOT, tree

OURS = {"azee", "azee_grammar", "azee_rig", "azee_solver"}
DECLARATIONS = {f"azee_solver.{name}" for name in ("geometry", "constraint", "notation", "cycles")}

MAY_IMPORT: dict[str, set[str]] = {
    "azee_grammar": {"lark", "platformdirs"},
    "azee_rig": {"numpy"},
    "azee_rig.ahead_of_time": {"azee_rig.object_code"},
    "azee_rig.machine_code": {"azee_rig.ahead_of_time", "azee_rig.object_code", "numpy"},
    "azee_rig.object_code": {"llvmlite"},
    "azee_rig.pointers": {"numba", "llvmlite"},
    "azee_rig.skin_kernel": {"azee_rig.machine_code", "azee_rig.pointers", "numba"},
    "azee_rig.build": {"azee_rig", "numpy", "trimesh"},
    "azee_rig.importing": {"azee_rig", "numpy", "trimesh", "PIL"},
    "azee_solver.geometry": set(),
    "azee_solver.hashing": set(),
    "azee_solver.constraint": {"azee_solver.geometry", "azee_solver.hashing"},
    "azee_solver.notation": {"azee_solver.constraint", "azee_solver.geometry"},
    "azee_solver.cycles": {"azee_solver.constraint", "azee_solver.geometry"},
    "azee_solver": {"azee_rig", "numpy", "nlopt"},
    "azee_solver.kernels": {"azee_rig", "azee_solver.block", "numpy", "numba"},
    "azee_solver.posing": {"azee_rig", "azee_solver", "numba"},
    "azee_solver.surfaces": {"azee_rig", "azee_solver", "numba"},
    "azee.score": DECLARATIONS,
    "azee.score.recorded_motion": {"azee.clip", "azee_rig"},
    "azee.score.articulators": {"azee_grammar"} | DECLARATIONS,
    "azee.lang": {"azee_grammar", "azee.score"} | DECLARATIONS,
    "azee.lang.operators.spelling": {"azee.lang", "azee.spelling.timing"},
    "azee.batch": {
        *("azee.animation", "azee.clip", "azee.compilation", "azee.export.files", "azee.formats"),
        *("azee.lang", "azee.motion", "azee.score"),
        *("azee_grammar", "azee_rig", "azee_solver"),
    },
    "azee.batch.version": OURS,
    "azee.batch.cluster": {"azee.batch", "azee_grammar", "distributed"},
    "azee.blocks": {"azee_grammar"},
    "azee.posing": {
        *("azee.blocks", "azee.compilation", "azee.lang", "azee.motion.tasks", "azee.score"),
        *("azee_grammar", "azee_rig", "azee_solver", "numpy"),
    },
    "azee.corpus": {"azee.lang", "azee.export.files", "azee.wording", "matplotlib", "pympi"},
    "azee.assist": {"azee_grammar", "azee.lang", "azee.score"} | DECLARATIONS,
    "azee.clip": {"azee_rig", "numpy"},
    "azee.signs": {"azee.clip", "azee.score", "azee_rig", "numpy", "sqlalchemy", "alembic"},
    "azee.capture": {"azee.clip", "azee.export.files", "azee_rig", "azee_solver", "numpy", "scipy"},
    "azee.capture.c3d_file": {"azee.capture", "c3d", "numpy"},
    "azee.capture.figures": {"azee.capture", "azee.export.files", "numpy", "matplotlib"},
    "azee.motion.tasks": {"azee.clip", "azee.score", "azee_solver", "azee_rig", "numpy"},
    "azee.motion.curves": {
        *("azee.clip", "azee.score", "azee.motion.tasks"),
        *("azee_solver", "azee_rig", "numpy"),
    },
    "azee.motion.keys": {
        *("azee.clip", "azee.score", "azee.motion.tasks", "azee.motion.curves"),
        *("azee_solver", "azee_rig", "numpy"),
    },
    "azee.motion.timing": {
        *("azee.clip", "azee.score"),
        *("azee.motion.tasks", "azee.motion.curves", "azee.motion.keys"),
        *("azee_solver", "azee_rig", "numpy"),
    },
    "azee.motion.overlay": {
        *("azee.clip", "azee.score", "azee.motion.tasks"),
        *("azee_solver", "azee_rig", "numpy"),
    },
    "azee.motion.projection": {
        *("azee.score", "azee.motion.tasks", "azee.motion.keys"),
        *("azee_solver", "azee_rig", "numpy"),
    },
    "azee.motion": set(),
    "azee.wording": set(),
    "azee.spelling": set(),
    "azee.spelling.text": {"azee.lang", "azee_grammar"},
    "azee.spelling.study": {"numpy", "scipy"},
    "azee.spelling.study.server": {"azee.spelling.study", "starlette", "jinja2"},
    "azee.spelling.study.report": {"azee.spelling.study", "numpy", "matplotlib", "jinja2"},
    "azee.spelling.timing": {"azee.clip", "numpy", "scipy"},
    "azee.spelling.timing.recordings": {
        *("azee.corpus.annotations", "azee.spelling.timing", "numpy"),
    },
    "azee.spelling.timing.fitting": {"azee.spelling.timing", "numpy", "sklearn"},
    "azee.spelling.timing.validation": {
        *("azee.spelling.timing", "numpy", "sklearn", "threadpoolctl"),
    },
    "azee.spelling.timing.evaluation": {"azee.spelling.timing", "numpy", "threadpoolctl"},
    "azee.spelling.timing.figures": {"azee.spelling.timing", "numpy", "matplotlib"},
    "azee.quality": {
        *("azee.clip", "azee.motion", "azee.score", "azee.wording"),
        *("azee_solver", "azee_rig", "numpy"),
    },
    "azee.animation": {"azee.clip", "azee.motion", "azee.quality", "azee.score"}
    | {"azee_solver", "azee_rig", "numpy"},
    "azee.export": {"azee.score", "azee.motion.tasks", "azee_grammar", "azee_rig"} | DECLARATIONS,
    "azee.export.formats": {
        *("azee.export.files", "azee.export.score_layout", "azee.export.track_rows"),
        *("azee.export.npz", "azee.clip", "azee.score", "azee_rig", "numpy"),
        *DECLARATIONS,
    },
    "azee.export.pictures": {
        *("azee.export.files", "azee.export.score_layout", "azee.export.track_rows"),
        *("azee.clip", "azee.score", "azee_rig", "numpy", "PIL", "numba", "av"),
        *DECLARATIONS,
    },
    "azee.export.pictures.opengl": {"azee.export.pictures", "azee_rig", "numpy", "moderngl"},
    "azee.export.landmarks": {
        *("azee.export.files", "azee.export.formats", "azee.export.npz"),
        *("azee.export.pictures", "azee.clip", "azee_rig", "numpy"),
    },
    "azee.export.npz": {"azee.export.files", "numpy"},
    "azee.formats": {"azee.animation", "azee.clip", "azee.export", "azee.motion", "azee.score"}
    | {"azee_grammar", "azee_rig"},
    "azee.clips": {"azee.clip", "azee.formats", "azee_grammar", "azee_rig"},
    "azee.arguments": set(),
    "azee.calibration": {"azee.clip", "azee_rig", "azee_solver", "numpy"},
    "azee.compilation": {
        *("azee.animation", "azee.arguments", "azee.clip", "azee.export.files", "azee.formats"),
        *("azee.lang", "azee.motion", "azee.quality", "azee.score", "azee.wording"),
        *("azee_grammar", "azee_rig", "azee_solver"),
    },
    "azee.lexicon": {"azee.export.files", "azee_grammar", "lark", "lxml"},
    "azee.lsp": {"azee.assist", "azee.lang", "azee_grammar", "pygls", "lsprotocol"},
    "azee.mcp": {
        *("azee.compilation", "azee.export", "azee.formats", "azee.lang", "azee.quality"),
        *("azee_grammar", "azee_rig", "mcp"),
    },
    "azee.notebook": {*OURS, "numpy", "PIL"},
    "azee.repl": {*OURS, "numpy", "PIL", "prompt_toolkit"},
    "azee.cli": {*OURS, "click", "rich", "platformdirs", "sqlalchemy"},
    "azee.cli.study": {*OURS, "click", "uvicorn"},
    "azee.player": {
        *("azee.clip", "azee.compilation", "azee.export", "azee.lang", "azee.motion.keys.rest"),
        *("azee.score", "azee.signs", "azee.spelling", "azee.web"),
        *("azee_grammar", "azee_rig", "numpy", "starlette"),
    },
    "azee.studio": {
        *(OURS - {"azee"}),
        *("azee.animation", "azee.assist", "azee.blocks", "azee.clip", "azee.compilation"),
        *("azee.export", "azee.formats", "azee.lang", "azee.lsp", "azee.motion", "azee.posing"),
        *("azee.score", "azee.web", "azee.webserver", "numpy", "pygls", "starlette"),
    },
    "azee.web": set(),
    "azee.webserver": {"starlette", "uvicorn"},
    "azee": OURS,
}
"""By the longest prefix of the importing module. A package may always import from itself."""

RECURSIVE = {
    "azee.lang",  # evaluation is: an operator evaluates its operands, a rule applies rules
    "azee_grammar.render",  # a diagnostic renders itself
    "azee_solver.handshape",  # fitting a handshape solves a problem of the bound body
}
"""What may take part in a circle of imports, and why."""


@cache
def _imports(path: Path) -> tuple[tuple[str, int], ...]:
    """Every module that a file imports, at the top or inside a function, with its line."""
    return tuple(_imported(path))


def _imported(path: Path) -> Iterator[tuple[str, int]]:
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, node.lineno
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: relative import"
            assert node.module is not None
            yield from ((node.module, node.lineno),)


def _within(module: str, package: str) -> bool:
    return module == package or module.startswith(package + ".")


def _rule(module: str) -> str:
    return max((p for p in MAY_IMPORT if _within(module, p)), key=len)


def _forbidden(module: str) -> Iterator[str]:
    """Yield what a module imports against the graph, with its place."""
    rule = _rule(module)
    allowed = MAY_IMPORT[rule] | {rule}
    for imported, line in _imports(MODULES[module]):
        ours = imported.partition(".")[0] not in sys.stdlib_module_names
        if ours and not any(_within(imported, name) for name in allowed):
            place = f"{MODULES[module].relative_to(ROOT)}:{line}"
            yield f"{place}: {rule} must not import {imported}"


def test_imports_follow_the_graph() -> None:
    assert [found for module in MODULES for found in _forbidden(module)] == []


def test_no_modules_import_each_other_in_a_circle() -> None:
    """Annotations and imports inside functions count too: a circle is one however it is hidden."""
    imported = {
        module: {name for name, _ in _imports(path) if name in MODULES and name != module}
        for module, path in MODULES.items()
        if not any(_within(module, room) for room in RECURSIVE)
    }
    assert list(_circles(imported)) == []


def _circles(imported: Mapping[str, set[str]]) -> Iterator[list[str]]:
    """Yield strongly connected sets of more than one module (Tarjan 1972)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    path: list[str] = []

    def visit(module: str) -> Iterator[list[str]]:
        index[module] = low[module] = len(index)
        path.append(module)
        for other in sorted(imported[module] & imported.keys()):
            if other not in index:
                yield from visit(other)
            if other in path:
                low[module] = min(low[module], low[other])
        if low[module] == index[module]:
            circle = path[path.index(module) :]
            del path[path.index(module) :]
            if len(circle) > 1:
                yield sorted(circle)

    for module in imported:
        if module not in index:
            yield from visit(module)


def test_the_graph_names_packages_that_exist() -> None:
    assert len(MODULES) > 20
    packages = [p for p in MAY_IMPORT if not any(_within(m, p) for m in MODULES)]
    assert packages == []


def test_nlopt_is_imported_in_one_file() -> None:
    users = [
        module
        for module, path in MODULES.items()
        if any(_within(name, "nlopt") for name, _ in _imports(path))
    ]
    assert len(users) == 1


def test_every_module_says_what_it_is_for() -> None:
    assert [name for name, path in MODULES.items() if not ast.get_docstring(tree(path))] == []
