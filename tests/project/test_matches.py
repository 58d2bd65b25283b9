"""A match over one of our unions names every member, so that mypy finds where a new one is missing.

mypy's `exhaustive-match` rejects a match that leaves members out, but a final `case _` silences
it, and so does a guard on the last case: a new kind of point or constraint would then be taken for
something else.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache

from sources import having, tree


def _unions(module: ast.Module) -> Iterator[tuple[str, set[str]]]:
    """Yield the name and the members of every `X: TypeAlias = A | B | …` at the top of a file."""
    for node in module.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.value, ast.BinOp):
            name, annotation = ast.unparse(node.target), ast.unparse(node.annotation)
            members = {part.strip() for part in ast.unparse(node.value).split("|")}
            if annotation == "TypeAlias" and all(member.isidentifier() for member in members):
                yield name, members


@cache
def unions() -> dict[str, set[str]]:
    """Members of all our unions, by name."""
    return dict(union for path in having("TypeAlias").values() for union in _unions(tree(path)))


@cache
def _members() -> frozenset[str]:
    return frozenset().union(*unions().values())


def _named(pattern: ast.pattern) -> set[str]:
    """Classes that a pattern names at its top."""
    match pattern:
        case ast.MatchClass(cls=ast.Name(id=name)):
            return {name}
        case ast.MatchOr(patterns=patterns):
            return set().union(*map(_named, patterns))
        case ast.MatchAs(pattern=ast.pattern() as inner):
            return _named(inner)
        case _:
            return set()


def named_members(module: ast.AST) -> set[str]:
    """Members of our unions that the matches of a file name."""
    matches = (node for node in ast.walk(module) if isinstance(node, ast.Match))
    named = (_named(case.pattern) for match in matches for case in match.cases)
    return set().union(*named) & _members()


def _catches_all(case: ast.match_case) -> bool:
    return isinstance(case.pattern, ast.MatchAs) and case.pattern.pattern is None


def _only_for_mypy(case: ast.match_case) -> bool:
    return [ast.unparse(line).partition("(")[0] for line in case.body] == ["assert_never"]


def _open_matches(module: ast.AST) -> Iterator[int]:
    """Yield the lines of last cases after which mypy does not look for missing members."""
    for node in ast.walk(module):
        if isinstance(node, ast.Match):
            named = set().union(*(_named(case.pattern) for case in node.cases))
            last = node.cases[-1]
            silent = last.guard or (_catches_all(last) and not _only_for_mypy(last))
            if named & _members() and silent:
                yield last.pattern.lineno


def test_the_unions_are_found() -> None:
    assert {"Point", "Vector", "Path", "Constraint", "Score", "Value", "Expr"} <= unions().keys()
    assert "FreePoint" in _members()


def test_what_catches_the_rest_of_a_union_is_found() -> None:
    text = "match p:\n case FreePoint() | Moving():\n  pass\n case {}:\n  {}"
    found = {
        rest: list(_open_matches(ast.parse(text.format(*rest))))
        for rest in (("_", "pass"), ("other", "raise ValueError"), ("_", "assert_never(p)"))
    }
    assert list(found.values()) == [[4], [4], []]
    guarded = "match p:\n case FreePoint() if p.x:\n  pass"
    assert list(_open_matches(ast.parse(guarded))) == [2]
    assert list(_open_matches(ast.parse("match p:\n case str():\n  pass\n case _:\n  pass"))) == []


def test_no_match_over_a_union_has_a_case_for_the_rest() -> None:
    found = {name: [*_open_matches(tree(path))] for name, path in having("match ").items()}
    assert {name: lines for name, lines in found.items() if lines} == {}
