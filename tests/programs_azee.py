"""Programs for Hypothesis: correct AZee text in all its notations, with comments."""

from __future__ import annotations

from hypothesis import strategies as st

_NAMES = ("a", "info-about", "mois sgn1", "âge", "e\u0301te\u0301", "nb-5", "2nd", "aujourd'hui")
_WORDS = ("key", "sync", "azop", "list", "morph", "let", "apply", "tree", "x" * 30)
_SYMBOLS = ("'topic", "'SIG", "'A:start:-.25", "'start/end", "'with", "'nodefault", f"'{'y' * 25}")
_ATOMS = ("1", "-.4", '"a text # (with"', '""', "^sig", "^param$0", "s", "w", "L", "R")
_COMMENTS = ("", "", "", "", "", "  # note", " #", "\t# (trailing  ")

_heads = st.one_of(
    st.builds("{}{}".format, st.sampled_from((":", ".", ":#")), st.sampled_from(_NAMES)),
    st.sampled_from(_WORDS),
    st.sampled_from(("!palm", "!index", "@FH", "@I_TIP")),
)
_atoms = st.sampled_from(_ATOMS)
_symbols = st.sampled_from(_SYMBOLS)
_comments = st.sampled_from(_COMMENTS)
_gaps = st.sampled_from((" ", " ", "  ", "\t"))
_between = st.one_of(
    st.sampled_from(("", " ", "  ")),
    st.builds("{}\n{}{}".format, _comments, st.sampled_from(("", "# inside\n")), _gaps),
)


@st.composite
def _operand(draw: st.DrawFn, depth: int) -> str:
    """What may stand behind a head on its line."""
    kind = draw(st.integers(0, 3 if depth < 2 else 1))
    if kind == 0:
        return draw(st.one_of(_atoms, _symbols))
    if kind == 1:
        return draw(_heads)
    return draw(_complete(depth))


@st.composite
def _complete(draw: st.DrawFn, depth: int) -> str:
    """What takes no further operands."""
    kind = draw(st.integers(0, 2 if depth < 2 else 0))
    if kind == 0:
        return draw(_atoms)
    around = draw(_between)
    if kind == 1:
        return f"({around}{draw(_inside(depth + 1))}{draw(_between)})"
    positional = draw(st.lists(_inside(depth + 1), max_size=3))
    named = draw(st.lists(st.tuples(_symbols, _inside(depth + 1)), max_size=2))
    operands = [*positional, *(f"{name}{draw(_between)}= {value}" for name, value in named)]
    return f"{draw(_heads)}({around}{(draw(_between) + ', ').join(operands)})"


@st.composite
def _inside(draw: st.DrawFn, depth: int) -> str:
    """An expression in parentheses or between commas."""
    if draw(st.booleans()):
        return draw(st.one_of(_complete(depth), _symbols))
    parts = [draw(_heads), *draw(st.lists(_operand(depth), max_size=3))]
    return "".join(part + draw(_gaps) for part in parts)


@st.composite
def _lines(draw: st.DrawFn, depth: int, indent: str, *, row: bool) -> list[str]:
    """A line with its deeper lines; `row`: it may begin with a symbol."""
    above = draw(st.sampled_from(([], [], [], [""], [f"{indent} # above"], ["", "", "# c", ""])))
    kind = draw(st.integers(0, 3 if row else 2))
    if kind == 0:
        return [*above, indent + draw(_complete(depth)) + draw(_comments)]
    first = draw(_symbols if kind == 3 else _heads)
    parts = [first, *draw(st.lists(_operand(depth), max_size=3))]
    opens = kind != 3
    if kind == 3 and draw(st.booleans()):
        parts.append(draw(_heads))
        opens = True
    gaps = [draw(_gaps) for _ in parts]
    text = "".join(part + gap for part, gap in zip(parts, gaps, strict=True))
    lines = [*above, indent + text + draw(_comments)]
    if opens and depth < 2:
        deeper = indent + draw(st.sampled_from((" ", "    ", "\t")))
        for _ in range(draw(st.integers(0, 3))):
            lines += draw(_lines(depth + 1, deeper, row=True))
    return lines


@st.composite
def _definition(draw: st.DrawFn) -> list[str]:
    lines = [f"def {draw(st.sampled_from(_NAMES[1:]))}{draw(_comments)}"]
    if draw(st.booleans()):
        lines.append(f'  \'meaning "person"{draw(st.sampled_from(("", " # m")))}')
    if draw(st.booleans()):
        lines += ["  'source", "  # in between", '  "someone"']
    return lines + draw(_lines(0, "  ", row=False))


_items = st.one_of(
    _lines(0, "", row=False),
    _definition(),
    st.builds(lambda comment: [f"use 'lsf{comment}"], _comments),
)

programs = st.lists(_items, max_size=4).map(
    lambda items: "\n".join(line for item in items for line in item) + "\n"
)
"""Texts that parse, nearly all of them."""
