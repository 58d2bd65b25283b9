"""Single changes to a module's text, each of which a good test should notice.

A change replaces the text of one operator, constant, word or expression. The rest of the file stays
as it is, so that a change reads as a diff of one or a few lines. Left out is what no test can see,
or what every import would: annotations, decorators, assertions, messages of errors, unions of
types.
"""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Iterator
from dataclasses import dataclass

COMPARISONS: dict[type[ast.cmpop], tuple[str, tuple[str, ...]]] = {
    ast.Lt: ("<", ("<=", ">")),
    ast.LtE: ("<=", ("<", ">")),
    ast.Gt: (">", (">=", "<")),
    ast.GtE: (">=", (">", "<")),
    ast.Eq: ("==", ("!=",)),
    ast.NotEq: ("!=", ("==",)),
    ast.Is: ("is", ("is not",)),
    ast.IsNot: (r"is\s+not", ("is",)),
    ast.In: ("in", ("not in",)),
    ast.NotIn: (r"not\s+in", ("in",)),
}
"""Per operator how it is written, as a regular expression, and what takes its place."""
ARITHMETIC: dict[type[ast.operator], tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "*"),
    ast.Mod: ("%", "*"),
    ast.Pow: ("**", "*"),
    ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
    ast.BitXor: ("^", "&"),
    ast.LShift: ("<<", ">>"),
    ast.RShift: (">>", "<<"),
}
FUNCTIONS = {
    "min": "max",
    "max": "min",
    "any": "all",
    "all": "any",
    "minimum": "maximum",
    "maximum": "minimum",
    "argmin": "argmax",
    "argmax": "argmin",
    "sin": "cos",
    "cos": "sin",
    "floor": "ceil",
    "ceil": "floor",
    "radians": "degrees",
    "degrees": "radians",
    "sorted": "list",
    "zeros": "ones",
    "ones": "zeros",
    "zeros_like": "ones_like",
    "ones_like": "zeros_like",
    "flatnonzero": "ravel",
    "startswith": "endswith",
    "endswith": "startswith",
    "union": "intersection",
    "intersection": "union",
}
ARGUMENT_FOR_RESULT = {"abs", "sorted", "reversed", "round", "tuple", "set", "frozenset", "sqrt"}
"""Functions of one argument that may stand for their result, so that the call does nothing."""
UNSEEN_KEYWORDS = {"strict", "maxsize", "frozen", "slots", "ensure_ascii", "indent", "stacklevel"}
"""Keyword arguments that guard, remember or lay out; values of others are changed."""


@dataclass(frozen=True, slots=True, order=True)
class Change:
    """One change: the text from `start` to `stop` becomes `text`. line: counted from 1."""

    start: int
    stop: int
    text: str
    kind: str
    line: int

    def applied(self, source: str) -> str:
        """Return the module with the change."""
        return source[: self.start] + self.text + source[self.stop :]

    def diff(self, source: str, name: str) -> str:
        """Return the change as a unified diff."""
        lines = difflib.unified_diff(
            source.splitlines(), self.applied(source).splitlines(), name, name, n=1, lineterm=""
        )
        return "\n".join(lines)


def changes(source: str) -> list[Change]:
    """Return all changes of a module, in the order of their places.

    Each of them compiles, and its syntax tree differs from the module's.
    """
    before = ast.dump(ast.parse(source))
    found = sorted(set(_Finder(source).all()))
    return [change for change in found if _differs(change.applied(source), before)]


def lines_of_statement(source: str, change: Change) -> range:
    """Return the lines of the statement that a change is in, without those of its body."""
    around = [
        node
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.stmt) and node.lineno <= change.line <= (node.end_lineno or 0)
    ]
    node = max(around, key=lambda node: node.lineno)
    body: list[ast.stmt] = getattr(node, "body", [])
    stop = body[0].lineno if body else (node.end_lineno or node.lineno) + 1
    return range(node.lineno, max(stop, change.line + 1))


def _differs(changed: str, before: str) -> bool:
    try:
        return ast.dump(ast.parse(changed)) != before
    except SyntaxError:
        return False


class _Finder:
    """Walks a module's tree and finds the places of its nodes in the text."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.tree = ast.parse(source)
        self.lines = source.splitlines(keepends=True)
        self.offsets = [0]
        for line in self.lines:
            self.offsets.append(self.offsets[-1] + len(line))

    def all(self) -> Iterator[Change]:
        """Yield the changes of the whole module."""
        for statement in self.tree.body:
            if not _is_for_types(statement):
                yield from self._of(statement, None)

    def _of(self, node: ast.AST, function: ast.FunctionDef | None) -> Iterator[Change]:
        if isinstance(node, ast.Assert | ast.Raise | ast.JoinedStr | ast.AsyncFunctionDef):
            return
        if isinstance(node, ast.If) and _is_for_types(node):
            return
        inner = node if isinstance(node, ast.FunctionDef) else function
        yield from self._here(node, inner)
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "decorator_list", "bases", "type_params"):
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.keyword) and child.arg in UNSEEN_KEYWORDS:
                    continue
                if isinstance(child, ast.BinOp) and function is None and _is_union(child):
                    continue
                if isinstance(child, ast.AST):
                    yield from self._of(child, inner)

    def _here(self, node: ast.AST, function: ast.FunctionDef | None) -> Iterator[Change]:
        match node:
            case ast.Compare():
                sides = [node.left, *node.comparators]
                for one, op, other in zip(sides, node.ops, sides[1:], strict=False):
                    written, others = COMPARISONS[type(op)]
                    for text in others:
                        yield from self._between(one, other, written, text, "comparison")
            case ast.BinOp() if type(node.op) in ARITHMETIC:
                written, text = ARITHMETIC[type(node.op)]
                where = re.escape(written)
                yield from self._between(node.left, node.right, where, text, "arithmetic")
            case ast.AugAssign() if type(node.op) in ARITHMETIC:
                written, text = ARITHMETIC[type(node.op)]
                where = re.escape(f"{written}=")
                yield from self._between(node.target, node.value, where, f"{text}=", "arithmetic")
            case ast.BoolOp():
                written, text = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
                for one, other in zip(node.values, node.values[1:], strict=False):
                    yield from self._between(one, other, rf"\b{written}\b", text, "and, or")
            case ast.UnaryOp(op=ast.Not()):
                yield self._for(node, self._text(node.operand), "not dropped")
            case ast.UnaryOp(op=ast.USub()):
                yield self._for(node, self._text(node.operand), "minus dropped")
            case ast.Constant(value=value) if isinstance(value, bool | int | float):
                yield self._for(node, _other_constant(value), "constant")
            case ast.Break():
                yield self._for(node, "continue", "break, continue")
            case ast.Continue():
                yield self._for(node, "break", "break, continue")
            case ast.If() | ast.IfExp() | ast.While():
                yield self._for(node.test, f"(not ({self._text(node.test)}))", "condition")
            case ast.comprehension():
                for test in node.ifs:
                    yield self._for(test, "True", "condition")
            case ast.Expr(value=ast.Call()):
                yield self._for(node, "pass", "call dropped")
            case ast.Call():
                yield from self._call(node)
            case ast.Return(value=ast.expr()) if function is not None:
                yield from self._returned(node, function)

    def _call(self, node: ast.Call) -> Iterator[Change]:
        function = node.func
        name = function.attr if isinstance(function, ast.Attribute) else ""
        name = function.id if isinstance(function, ast.Name) else name
        if name in FUNCTIONS:
            stop = self._stop(function)
            line = function.end_lineno or function.lineno
            yield Change(stop - len(name), stop, FUNCTIONS[name], "function", line)
        if name in ARGUMENT_FOR_RESULT and len(node.args) == 1 and not node.keywords:
            yield self._for(node, f"({self._text(node.args[0])})", "call's result")

    def _returned(self, node: ast.Return, function: ast.FunctionDef) -> Iterator[Change]:
        """Replace what a function returns by another value of the type that it declares."""
        assert node.value is not None
        declared = ast.unparse(function.returns) if function.returns else ""
        value = self._text(node.value)
        other = {
            "bool": f"not ({value})",
            "int": f"({value}) + 1",
            "float": f"({value}) * 1.1",
            "Array": f"({value}) * 1.1",
            "str": '""',
        }.get(declared, "")
        for opening, empty in (("tuple[", "()"), ("list[", "[]"), ("dict[", "{}")):
            if declared.startswith(opening) and (opening != "tuple[" or "..." in declared):
                other = empty
        if declared.endswith("| None"):
            other = "None"
        if other and other != value:
            yield self._for(node.value, other, "returned value")

    def _between(
        self, one: ast.expr, other: ast.expr, written: str, text: str, kind: str
    ) -> Iterator[Change]:
        """Replace what is written between two expressions, comments left out."""
        start, stop = self._stop(one), self._start(other)
        between = re.sub(r"#[^\n]*", lambda m: " " * len(m.group()), self.source[start:stop])
        found = re.search(written, between)
        if found:
            line = self.source.count("\n", 0, start + found.start()) + 1
            yield Change(start + found.start(), start + found.end(), text, kind, line)

    def _for(self, node: ast.expr | ast.stmt, text: str, kind: str) -> Change:
        return Change(self._start(node), self._stop(node), text, kind, node.lineno)

    def _text(self, node: ast.expr) -> str:
        return self.source[self._start(node) : self._stop(node)]

    def _start(self, node: ast.expr | ast.stmt) -> int:
        return self._offset(node.lineno, node.col_offset)

    def _stop(self, node: ast.expr | ast.stmt) -> int:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return self._offset(node.end_lineno, node.end_col_offset)

    def _offset(self, line: int, column: int) -> int:
        """Return the place in the text; the tree counts columns in bytes of UTF-8."""
        before = self.lines[line - 1].encode()[:column]
        return self.offsets[line - 1] + len(before.decode())


def _other_constant(value: bool | float) -> str:
    if isinstance(value, bool):
        return str(not value)
    if isinstance(value, int):
        return str(value + 1)
    return repr(value * 1.1) if value else "0.1"


def _is_for_types(node: ast.stmt) -> bool:
    """Whether a statement is there for a type checker only."""
    if isinstance(node, ast.If):
        return "TYPE_CHECKING" in ast.unparse(node.test)
    return isinstance(node, ast.AnnAssign) and "TypeAlias" in ast.unparse(node.annotation)


def _is_union(node: ast.BinOp) -> bool:
    return isinstance(node.op, ast.BitOr)
