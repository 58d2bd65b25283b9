"""Texts for Hypothesis: any text at all, and texts that look like AZee more or less."""

from __future__ import annotations

from hypothesis import strategies as st

_PIECES = (
    *("(", ")", ",", "=", '"', "'", "#", " ", "  ", "    ", "\t", "\n", "\r\n", "\r", "\n\n"),
    *(":a", ".nb-5", ":#p", ":mois sgn1", ":", ":#", "::a", ".", "..", "'topic", "'A:start:-.25"),
    *("^p", "^", "!palm", "!", "@FH", "@", "?x", "?", "s", "w", "L", "R", "1", "-.5", "2s", "1e5"),
    *(
        "key",
        "list",
        "def",
        "use",
        "def a",
        "use 'lsf",
        "\ndef b\n    ",
        "\nuse 'x\n",
        "azop",
        "[x]",
    ),
    *("\n    ", "\n        ", "\n\t", "\n  ", "'a = ", "f(", " (", "),", '"text"', " # note", "’x"),
    *("“q”", "−1", "0,5", "é", "e\u0301", "\u00a0", "\u3000", "\u200b", "\ufeff", "\x00", "日"),
    *("12345678901234567890", "a" * 50, "\ud800", "\u2028", "\x0c", "½", "²", "٣"),
)

any_text = st.text()
"""Whatever Unicode holds."""

azee_like = st.lists(st.sampled_from(_PIECES), max_size=60).map("".join)
"""Pieces of AZee and of what people write in its place, in any order."""

_WORDS = [piece for piece in _PIECES if not {"\n", "\r"} & set(piece)]

lines = st.lists(
    st.tuples(st.integers(0, 4), st.lists(st.sampled_from(_WORDS), max_size=5)), max_size=12
).map(lambda rows: "\n".join("    " * depth + " ".join(words) for depth, words in rows))
"""Indented lines of such pieces, with spaces between them."""

texts = st.one_of(any_text, azee_like, lines)
