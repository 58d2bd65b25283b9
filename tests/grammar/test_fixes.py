"""Which remedies name a text for the marked place."""

from __future__ import annotations

import pytest

from azee_grammar.diagnostic import Diagnostic
from azee_grammar.fixes import fixes
from azee_grammar.source import Source, Span

SPAN = Span(Source("text.azee", ":arbe"), 0, 5)


@pytest.mark.parametrize(
    ("remedy", "texts"),
    [
        ("did you mean `:arbre`?", (":arbre",)),
        ("did you mean `:age` or `:âge`?", (":age", ":âge")),
        ("write `0.5`", ("0.5",)),
        ("write `2`; times are in seconds", ("2",)),
        ("write `@I_TIP(s)`: s, w, L or R", ("@I_TIP(s)",)),
        ("write `'a`, with the apostrophe of the keyboard", ("'a",)),
        ("`arbre` is a rule: write `:arbre`", (":arbre",)),
        ("write `list(1, 2)`, or the operands one a line", ()),
        ("write `'name = …`", ()),
        ("write `'from 'BLOCK`", ()),
        ("write the operands without names first", ()),
        ("`arbre` is an operator: write it without `^`", ()),
        (None, ()),
    ],
)
def test_the_texts_of_a_remedy(remedy: str | None, texts: tuple[str, ...]) -> None:
    assert fixes(Diagnostic("code", "message", SPAN, help=remedy)) == texts


def test_without_a_place_there_is_nothing_to_replace() -> None:
    assert fixes(Diagnostic("code", "message", None, help="did you mean `:arbre`?")) == ()
