"""Programs for Hypothesis: well-typed for the most part, so that much of them is evaluated."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st

from azee.lang.native import Operand
from azee.lang.registry import NATIVES
from azee.lang.sync_shape import RULES, SyncRule
from azee.lang.values import Kind

ATOMS: dict[Kind, Sequence[str]] = {
    Kind.NUMBER: ("0", "1", "-.5", ".1", "3", "^n"),
    Kind.SYMBOL: ("'A", "'A:start", "'AU12", "'none", "'end", "'hands"),
    Kind.TEXT: ('"text"',),
    Kind.SIDE: ("s", "w", "L", "R", "^s", "^side"),
    Kind.BOOLEAN: ("eq(1, 1)", "lt(2, ^n)"),
    Kind.BONE: ("!head", "!palm(s)", "!index(^side, 2)"),
    Kind.SITE: ("@FH", "@I_TIP(s)", "@PA(^side)"),
    Kind.VECTOR: ("^up", "^left"),
    Kind.POINT: ("^Mssp", "@CH", "^Rssp"),
    Kind.PATH: ("straight",),
    Kind.LIST: ("list()", "list(1, 2)", "list(:bien, :Irak)"),
    Kind.CONSTRAINTS: (":#fist", "cstr()", ":#flat-hand('side = ^side)"),
    Kind.SCORE: (":bien", "blank(.5)", ":f", ":âge", "nb-5()"),
    Kind.OPERATOR: (".nb-5", ".f", "azop('x, 1, ^x)", ".not-but(:bien)", ".g"),
}
WRONG = ("!nobody", "@NOWHERE", "^nothing", ":nobody", "!index(s, 9)", "'dist", "1", "^up", ":f")


@st.composite
def expression(draw: st.DrawFn, kind: Kind, depth: int = 0) -> str:
    """An expression that most probably evaluates to a value of that kind."""
    if draw(st.integers(0, 60)) == 0:
        return draw(st.sampled_from(WRONG))
    if depth > 3 or draw(st.integers(0, 2)) == 0:
        return draw(st.sampled_from(ATOMS[kind]))
    form = draw(st.integers(0, 9))
    inner = depth + 1
    if form == 0:
        condition = draw(expression(Kind.BOOLEAN, inner))
        branches = [draw(expression(kind, inner)) for _ in range(2)]
        return f"if({condition}, {', '.join(branches)})"
    if form == 1:
        bound = draw(expression(Kind.NUMBER, inner))
        return f"let('n, {bound}, {draw(expression(kind, inner))})"
    if form == 2:
        return f"apply(azop('side, s, {draw(expression(kind, inner))}))"
    if form == 3:
        return f"nth(list({draw(expression(kind, inner))}), {draw(expression(Kind.NUMBER, inner))})"
    if kind is Kind.SCORE and form < 7:
        return draw(_score(inner))
    if kind is Kind.LIST and form < 7:
        elements = draw(st.lists(expression(Kind.SCORE, inner), max_size=3))
        body = draw(expression(Kind.SCORE, inner))
        return f"map(azop('n, 0, {body}), range(1, {len(elements)}))"
    natives = [n for n in NATIVES.values() if n.result is kind and n.function is not None]
    if not natives:
        return draw(st.sampled_from(ATOMS[kind]))
    native = draw(st.sampled_from(natives))
    operands: list[str] = []
    for operand in native.operands:
        count = max(operand.least, draw(st.integers(0, 2))) if operand.rest else 1
        operands += [draw(_operand(operand, inner)) for _ in range(count)]
    for option in native.options:
        if draw(st.integers(0, 3)) == 0:
            operands.append(f"'{option.word}")
            operands += [draw(_operand(option.operand, inner))] if option.operand else []
    return f"{native.name}({', '.join(operands)})"


def _operand(operand: Operand, depth: int) -> st.SearchStrategy[str]:
    if operand.words:
        return st.sampled_from([f"'{word}" for word in operand.words])
    kinds = operand.kinds or (Kind.NUMBER, Kind.SCORE)
    return st.sampled_from(kinds).flatmap(lambda kind: expression(kind, depth))


@st.composite
def _score(draw: st.DrawFn, depth: int) -> str:
    kind = draw(st.integers(0, 3))
    one, other = (draw(expression(Kind.SCORE, depth)) for _ in range(2))
    if kind == 0:
        rule = draw(st.sampled_from(["not-but", "info-about", "side-info", "in-context", "g"]))
        return f"{rule}({one}, {other})"
    if kind == 1:
        return f"about-ref({one}, {draw(expression(Kind.POINT, depth))})"
    parts = ["'A", one]
    for name in ("'B", "'C")[: draw(st.integers(0, 2))]:
        placed = draw(st.sampled_from([*RULES.values()]))
        block = draw(st.sampled_from([other, "hold('A, .1)", "hold('B, .2)"]))
        parts += [name, block, f"'{placed.word}", *draw(_rule_operands(placed, depth))]
    return f"sync({', '.join(parts)})"


@st.composite
def _rule_operands(draw: st.DrawFn, rule: SyncRule, depth: int) -> list[str]:
    refs = ["'A:start", "'A:end:.5", "'A:.5:-.1", "'B:end", "'A/SIG:start", "ref('A, 'end, ^n)"]
    operands = []
    for role in rule.operands:
        if role == "duration":
            operands.append(draw(expression(Kind.NUMBER, depth)))
        else:
            operands.append(draw(st.sampled_from(["'A", "'B"] if role == "block" else refs)))
    return operands


def _program(f: str, g: str, utterances: Sequence[str]) -> str:
    text = f"def f\n    azop('n, 1, 'side, L, {f})\n"
    text += f"def g\n    azop('x, 'nodefault, 'y, :bien, 'n, 2, 'side, w, {g})\n"
    return text + "".join(f"let('n, 2, let('side, R, {u}))\n" for u in utterances)


programs = st.builds(
    _program,
    expression(Kind.SCORE),
    expression(Kind.SCORE),
    st.lists(expression(Kind.SCORE), min_size=1, max_size=2),
)
