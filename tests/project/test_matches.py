"""A match over one of our unions names every member, so that mypy finds where a new one is missing.

mypy's `exhaustive-match` rejects a match that leaves members out, but a final `case _` silences
it, and so does a guard on the last case: a new kind of point or constraint would then be taken for
something else.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = {
    path.relative_to(ROOT).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
    for folder in (".", "grammar", "rig", "solver")
    for path in sorted((ROOT / folder).glob("azee*/**/*.py"))
}


def _unions(tree: ast.Module) -> Iterator[tuple[str, set[str]]]:
    """Yield the name and the members of every `X: TypeAlias = A | B | …` at the top of a file."""
    for node in tree.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.value, ast.BinOp):
            name, annotation = ast.unparse(node.target), ast.unparse(node.annotation)
            members = {part.strip() for part in ast.unparse(node.value).split("|")}
            if annotation == "TypeAlias" and all(member.isidentifier() for member in members):
                yield name, members


UNIONS = dict(union for tree in SOURCES.values() for union in _unions(tree))
MEMBERS = frozenset().union(*UNIONS.values())


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


def named_members(tree: ast.AST) -> set[str]:
    """Members of our unions that the matches of a file name."""
    matches = (node for node in ast.walk(tree) if isinstance(node, ast.Match))
    named = (_named(case.pattern) for match in matches for case in match.cases)
    return set().union(*named) & MEMBERS


def _catches_all(case: ast.match_case) -> bool:
    return isinstance(case.pattern, ast.MatchAs) and case.pattern.pattern is None


def _only_for_mypy(case: ast.match_case) -> bool:
    return [ast.unparse(line).partition("(")[0] for line in case.body] == ["assert_never"]


def _open_matches(tree: ast.AST) -> Iterator[int]:
    """Yield the lines of last cases after which mypy does not look for missing members."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Match):
            named = set().union(*(_named(case.pattern) for case in node.cases))
            last = node.cases[-1]
            silent = last.guard or (_catches_all(last) and not _only_for_mypy(last))
            if named & MEMBERS and silent:
                yield last.pattern.lineno


def test_the_unions_are_found() -> None:
    assert {"Point", "Vector", "Path", "Constraint", "Score", "Value", "Expr"} <= UNIONS.keys()
    assert "FreePoint" in MEMBERS


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


@pytest.mark.parametrize("name", sorted(SOURCES))
def test_no_match_over_a_union_has_a_case_for_the_rest(name: str) -> None:
    assert list(_open_matches(SOURCES[name])) == []
