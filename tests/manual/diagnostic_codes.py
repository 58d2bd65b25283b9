"""Every code of a diagnostic that our packages can give, read from their source."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import azee
import azee_grammar
import azee_rig
import azee_solver

PACKAGES = (azee, azee_grammar, azee_solver, azee_rig)
"""As they are imported: from the tree, or from an installed wheel."""

MAKERS = {
    *("BindingError", "BodyError", "Diagnostic", "LayoutError", "RecordingError", "SignsError"),
    *("fault", "_problem"),
}
"""Whoever is called by one of these names takes the code as its first argument."""


class UnknownCodeError(Exception):
    """A diagnostic is made with a code that cannot be read from the source."""


def codes() -> set[str]:
    """Return all codes. Raises: UnknownCodeError: one of them is hidden."""
    found: set[str] = set()
    for package in PACKAGES:
        for path in sorted(Path(package.__path__[0]).rglob("*.py")):
            tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
            found |= codes_in(tree, str(path))
    return found


def codes_in(tree: ast.Module, name: str) -> set[str]:
    """Return the codes of one module."""
    found: set[str] = set()
    for function, call in _calls(tree):
        code = _first(call)
        if code is None:
            continue
        values = list(_values(code, function))
        if not values and not _handed_on(code, function):
            raise UnknownCodeError(f"{name}:{call.lineno}: {ast.unparse(code)}")
        found.update(values)
    return found


def _calls(tree: ast.Module) -> Iterator[tuple[ast.FunctionDef | None, ast.Call]]:
    """Yield every call that makes a diagnostic, with the innermost function around it."""

    def walk(
        node: ast.AST, function: ast.FunctionDef | None
    ) -> Iterator[tuple[ast.FunctionDef | None, ast.Call]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Call) and _name(child.func) in MAKERS:
                yield function, child
            inner = child if isinstance(child, ast.FunctionDef) else function
            yield from walk(child, inner)

    yield from walk(tree, None)


def _name(called: ast.expr) -> str:
    if isinstance(called, ast.Attribute):
        return called.attr
    return called.id if isinstance(called, ast.Name) else ""


def _first(call: ast.Call) -> ast.expr | None:
    if call.args:
        return call.args[0]
    return next((k.value for k in call.keywords if k.arg == "code"), None)


def _values(code: ast.expr, function: ast.FunctionDef | None) -> Iterator[str]:
    """Yield what an expression can be: a text, one of two, or a name that is assigned to those."""
    if isinstance(code, ast.Constant) and isinstance(code.value, str):
        yield code.value
    elif isinstance(code, ast.IfExp):
        yield from _values(code.body, function)
        yield from _values(code.orelse, function)
    elif isinstance(code, ast.Name) and function is not None:
        for node in ast.walk(function):
            if isinstance(node, ast.Assign) and _name(node.targets[0]) == code.id:
                yield from _values(node.value, None)


def _handed_on(code: ast.expr, function: ast.FunctionDef | None) -> bool:
    """Whether the code was given to another maker before: `problem.code`, or our own parameter."""
    if isinstance(code, ast.Attribute):
        return code.attr == "code"
    if isinstance(code, ast.Name) and function is not None and function.name in MAKERS:
        return code.id in {argument.arg for argument in function.args.args}
    return False
