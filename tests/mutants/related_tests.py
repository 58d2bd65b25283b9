"""Which tests belong to a module: those that import it nearly directly, and those of its folder."""

from __future__ import annotations

import ast
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

PACKAGES = {
    "azee": "azee",
    "azee_grammar": "grammar/azee_grammar",
    "azee_rig": "rig/azee_rig",
    "azee_solver": "solver/azee_solver",
}
"""Folder of each package."""
LEFT_OUT = {"project", "fuzz", "manual", "mutants", "editors", "examples"}
"""Folders of tests that look at the tree, at documents or at everything at once."""
FOLDERS = {"clip": "motion", "azee_grammar": "grammar", "azee_rig": "rig", "azee_solver": "solver"}
"""Folders of tests that bear another name than the part they test."""
NEVER = 1_000_000
FARTHEST = 1
"""Steps of imports from what a test of another folder imports to a module that it belongs to."""


@dataclass(frozen=True)
class Tree:
    """The project's files in a folder, and who imports whom."""

    root: Path

    @cached_property
    def modules(self) -> Mapping[str, Path]:
        """Path of every module of the packages, by its dotted name."""
        found = {}
        for package, folder in PACKAGES.items():
            top = self.root / folder
            for path in sorted(top.rglob("*.py")):
                parts = [package, *path.relative_to(top).with_suffix("").parts]
                found[".".join(parts).removesuffix(".__init__")] = path
        return found

    @cached_property
    def helpers(self) -> Mapping[str, Path]:
        """Path of every module beside the tests, by the name under which tests import it."""
        files = sorted((self.root / "tests").rglob("*.py"))
        return {path.stem: path for path in files if not path.name.startswith("test_")}

    @cached_property
    def imports(self) -> Mapping[str, frozenset[str]]:
        """What each module imports of the packages, also inside of functions."""
        return {name: self._imported(path) for name, path in self.modules.items()}

    def related(self, module: str) -> list[Path]:
        """Return test files that belong to a module, nearest first.

        Those that reach it by few imports, and all of the folder that bears the name of its part,
        for these may start it in a process of its own.
        """
        away = self._steps_to(module)
        part = _part(module)
        found = []
        for path in sorted((self.root / "tests").rglob("test_*.py")):
            folder = path.relative_to(self.root / "tests").parts[0]
            steps = min((away[m] for m in self._of_test(path) if m in away), default=NEVER)
            if folder not in LEFT_OUT and (steps <= FARTHEST or folder == part):
                found.append((steps, folder != part, path))
        return [path for _, _, path in sorted(found)]

    def _steps_to(self, module: str) -> Mapping[str, int]:
        """Return by how many imports modules reach one module; that itself by none."""
        importers: dict[str, set[str]] = {}
        for name, imported in self.imports.items():
            for other in imported:
                importers.setdefault(other, set()).add(name)
        away, queue = {module: 0}, deque([module])
        while queue:
            name = queue.popleft()
            for other in sorted(importers.get(name, ())):
                if other not in away:
                    away[other] = away[name] + 1
                    queue.append(other)
        return away

    def _of_test(self, path: Path) -> frozenset[str]:
        """Return the modules that a test imports, itself or by its helpers."""
        found, seen, queue = set[str](), {path}, deque([path])
        while queue:
            one = queue.popleft()
            found |= self._imported(one)
            for name in _names(one):
                helper = self.helpers.get(name)
                if helper is not None and helper not in seen:
                    seen.add(helper)
                    queue.append(helper)
        return frozenset(found)

    def _imported(self, path: Path) -> frozenset[str]:
        return frozenset(name for name in _names(path) if name in self.modules)


def chosen_modules(tree: Tree, names: Iterable[str]) -> list[str]:
    """Return modules by dotted name, by path, or all below a package or folder.

    Raises: ValueError: no module bears a name.
    """
    found: dict[str, None] = {}
    for name in names:
        path = (tree.root / name).resolve()
        hits = [
            module
            for module, file in tree.modules.items()
            if module == name
            or module.startswith(f"{name}.")
            or file.resolve() == path
            or path in file.resolve().parents
        ]
        if not hits:
            raise ValueError(f"there is no module `{name}`")
        found |= dict.fromkeys(hits)
    return [*found]


@cache
def _names(path: Path) -> frozenset[str]:
    """Return the dotted names that a file imports; of `from a import b` both a and a.b."""
    found = set[str]()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return frozenset(found)


def _part(module: str) -> str:
    """Return the folder of tests of a module's part."""
    parts = module.split(".")
    part = parts[1] if parts[0] == "azee" and len(parts) > 2 else parts[0]
    return FOLDERS.get(part, part)
