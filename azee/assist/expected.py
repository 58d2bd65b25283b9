"""What may stand at a place: kinds of value, argument names, words, names of blocks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from azee.assist.description import Description, What, library, morph, parameter_texts, sync_rule
from azee.assist.frame import Frame
from azee.assist.knowledge import Knowledge
from azee.assist.place import Place
from azee.lang.azop import NO_DEFAULT
from azee.lang.native import Native, Operand
from azee.lang.registry import NATIVES
from azee.lang.rule import STATUSES, Rule
from azee.lang.sync_shape import RULES
from azee.lang.values import Kind
from azee.score.score import CHANNELS
from azee_grammar import vocabulary

_ENTRIES = {
    "meaning": "what the rule says",
    "source": "who described it, and where",
    "status": f"how far its form is testimony: {', '.join(STATUSES)}",
    "example": "an expression that shows it",
}


@dataclass(frozen=True, slots=True)
class Expected:
    """What fits: kinds of value (any if empty), and symbols that have a meaning here.

    `value` is False if only one of the symbols may stand here.
    """

    kinds: tuple[Kind, ...] = ()
    symbols: tuple[Description, ...] = ()
    value: bool = True

    def accepts(self, kind: Kind | None) -> bool:
        """Whether a value of that kind fits; None is an unknown kind."""
        if kind is None or not self.kinds or kind in self.kinds:
            return True
        return kind is Kind.SITE and Kind.POINT in self.kinds


def expected(where: Place, knowledge: Knowledge) -> Expected:
    """Return what may stand at a place, as far as its head determines it."""
    head = where.frame.head
    if head is None:
        outer = where.frame.parent
        return Expected((Kind.SCORE,)) if outer is None else Expected()
    match head.kind:
        case "RULE" | "REFERENCE" | "POSTURE":
            found = knowledge.rule(head.text)
            return _rule(found, where) if found else Expected()
        case "OPERATOR" if head.text in NATIVES:
            return _native(NATIVES[head.text], where)
        case "OPERATOR":
            found = knowledge.rule(head.text)
            return _rule(found, where) if found else Expected()
        case "BONE" | "SITE":
            return Expected((Kind.SIDE, Kind.NUMBER))
        case "USE":
            return Expected(symbols=tuple(map(library, knowledge.libraries())), value=False)
        case "DEF":
            symbols = [_word(What.ENTRY, n, m) for n, m in _ENTRIES.items()]
            return Expected(symbols=tuple(symbols))
        case _:
            return Expected()


def argument_number(where: Place, names: Sequence[str]) -> int | None:
    """Return which of a rule's arguments is being written, from 0; None if that is open."""
    if where.pending is not None:
        return names.index(where.pending) if where.pending in names else None
    if where.frame.called:
        return where.commas if where.commas < len(names) else None
    if where.number % 2 == 0:
        return None
    name = where.before[-1].symbol
    return names.index(name) if name in names else None


def _rule(found: Rule, where: Place) -> Expected:
    parameters = [
        _word(What.ARGUMENT, p.name, text)
        for p, text in zip(found.defaults, parameter_texts(found), strict=True)
    ]
    if where.pending is not None:
        return Expected()
    if where.frame.called:
        given = {operand.name for operand in where.frame.operands if operand.name}
        positional = sum(operand.name is None for operand in where.before)
        left = [p for i, p in enumerate(parameters) if p.title[1:] not in given and i >= positional]
        return Expected(symbols=tuple(left))
    if where.number % 2:
        return Expected()
    names = {o.symbol for o in where.frame.operands[::2]} - {where.word[1:]}
    left = [p for p in parameters if p.title[1:] not in names]
    return Expected(symbols=tuple(left), value=False)


def _native(native: Native, where: Place) -> Expected:
    match native.name:
        case "sync":
            return _sync(where)
        case "azop":
            open_ = _word(What.WORD, NO_DEFAULT, "the argument must be given")
            return Expected(symbols=(open_,) if where.number % 2 else ())
        case "if" | "and" | "or":
            return Expected((Kind.BOOLEAN,) if where.number == 0 or native.name != "if" else ())
        case "apply":
            return Expected((Kind.OPERATOR,) if where.number == 0 else ())
        case "list":
            return _list(where)
        case _:
            return _operands(native, where)


def _operands(native: Native, where: Place) -> Expected:
    options = {option.word: option for option in native.options}
    before = where.before
    given = [operand.symbol for operand in before]
    if where.pending is not None:
        option = options.get(where.pending)
        return _operand(option.operand, where) if option and option.operand else Expected()
    if given and (option := options.get(given[-1] or "")) and option.operand:
        return _operand(option.operand, where)
    left = tuple(
        _word(What.OPTION, option.word, option.meaning)
        for option in native.options
        if option.word not in given
    )
    first_option = next((i for i, word in enumerate(given) if word in options), len(given))
    if first_option < len(given):
        return Expected(symbols=left, value=False)
    operand = _declared(native, where.number)
    if operand is None:
        return Expected(symbols=left, value=False)
    found = _operand(operand, where)
    required = where.number >= sum(not (o.optional or o.rest) for o in native.operands)
    return Expected(found.kinds, (*found.symbols, *(left if required else ())), found.value)


def _declared(native: Native, number: int) -> Operand | None:
    if number < len(native.operands):
        return native.operands[number]
    if native.operands and native.operands[-1].rest:
        return native.operands[-1]
    return None


def _operand(operand: Operand, where: Place) -> Expected:
    if operand.words:
        words = tuple(_word(What.WORD, word, operand.meaning) for word in operand.words)
        return Expected((Kind.SYMBOL,), words)
    symbols: tuple[Description, ...]
    head = where.frame.head
    assert head is not None
    match head.text, operand.name:
        case "morph", _:
            found = map(morph, vocabulary.morph_names())
            symbols = tuple(description for description in found if description is not None)
        case "hold", "what":
            symbols = tuple(_blocks(where))
        case "hold", "channels":
            symbols = _channels()
        case "ref", "block":
            symbols = tuple(_blocks(where))
        case "ref", "bound":
            symbols = tuple(_word(What.WORD, word, "of that block") for word in ("start", "end"))
        case _:
            symbols = ()
    return Expected(operand.kinds, symbols)


def _list(where: Place) -> Expected:
    """Return names of channels after `'only`, and scores below `seq`."""
    frames = list(where.frame.outwards())
    around = next((frame for frame in frames[1:] if frame.head is not None), None)
    if around is None or around.head is None:
        return Expected()
    if around.head.text == "hold":
        return Expected((Kind.SYMBOL,), _channels())
    return Expected((Kind.SCORE,)) if around.head.text == "seq" else Expected()


def _channels() -> tuple[Description, ...]:
    return tuple(_word(What.WORD, name, "a channel of the body") for name in CHANNELS)


def _sync(where: Place) -> Expected:
    """Follow the blocks of a `sync` up to the place: name, score, rule, operands of the rule."""
    before = where.before
    at, first = 0, True
    while at < len(before):
        at += 1  # the name
        if at == len(before):
            return Expected((Kind.SCORE,))
        at += 1  # the score
        if first:
            first = False
            continue
        if at == len(before):
            return Expected((Kind.SYMBOL,), tuple(map(sync_rule, RULES.values())), value=False)
        rule = RULES.get(before[at].symbol or "")
        if rule is None:
            return Expected()
        roles = rule.operands
        at += 1
        if len(before) - at < len(roles):
            role = roles[len(before) - at]
            if role == "duration":
                return Expected((Kind.NUMBER,))
            symbols = _blocks(where) if role == "block" else _refs(where, role)
            return Expected((Kind.SYMBOL,), tuple(symbols))
        at += len(roles)
    return Expected((Kind.SYMBOL,))


def _refs(where: Place, role: str) -> Iterator[Description]:
    """Yield both bounds of every block; for a start, ends come first, since they are likelier."""
    blocks = list(_blocks(where))
    for bound in ("end", "start") if role == "start" else ("start", "end"):
        for block in blocks:
            yield _word(What.BLOCK, f"{block.title[1:]}:{bound}", f"the {bound} of {block.title}")


def _blocks(where: Place) -> Iterator[Description]:
    """Yield the blocks of the `sync` around a place, except the one being written."""
    for frame in where.frame.outwards():
        if frame.head is not None and frame.head.text == "sync":
            for name, start, end in blocks_of(frame):
                if not start <= where.start <= end:
                    yield _word(What.BLOCK, name, "a block of this sync")
            return


def blocks_of(frame: Frame) -> Iterator[tuple[str, int, int]]:
    """Yield the blocks of a `sync`: the name, and where the block begins and ends."""
    operands = frame.operands
    at = 0
    while at < len(operands):
        name = operands[at].symbol
        rule_at = at + 2 if at else None
        stop = at + 2
        if rule_at is not None and rule_at < len(operands):
            rule = RULES.get(operands[rule_at].symbol or "")
            stop = rule_at + 1 + (len(rule.operands) if rule else 0)
        if name is not None:
            last = operands[min(stop, len(operands)) - 1]
            yield name, operands[at].token.start, last.token.end
        at = stop


def _word(what: What, name: str, meaning: str) -> Description:
    return Description(what, f"'{name}", f"'{name}", meaning)
