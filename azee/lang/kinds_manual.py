"""The manual's page of values, generated from the kinds and the declarations of operators.

`python -m azee.lang.kinds_manual` prints docs/language/values.md; a test compares the two.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from azee.lang.constants import CONSTANTS
from azee.lang.native import Native, Operand
from azee.lang.registry import NATIVES
from azee.lang.values import Kind


@dataclass(frozen=True, slots=True)
class KindEntry:
    """What the manual says of a kind, and an expression whose value is of this kind."""

    meaning: str
    example: str
    published: bool


ENTRIES: Mapping[Kind, KindEntry] = {
    Kind.NUMBER: KindEntry(
        "A number without a unit. It means seconds, metres or degrees, depending on the operand. "
        "Times are exact: `.1` is one tenth. Other numbers have double precision, fifteen digits.",
        "-.4",
        published=True,
    ),
    Kind.SYMBOL: KindEntry(
        "A word that stands for itself: the name of an argument or of a block, a keyword, or a "
        "moment such as `'SIG:end`.",
        "'SIG:start:-.25",
        published=True,
    ),
    Kind.TEXT: KindEntry(
        "Words, as in the `'meaning` of a rule, or letters to be spelt. `rule` finds the rule "
        "whose name is a text.",
        'concat "nb-" 5',
        published=False,
    ),
    Kind.SIDE: KindEntry(
        "Strong, weak, left or right. Strong and weak become right or left when the signer's "
        "dominant hand is known.",
        "opposite s",
        published=True,
    ),
    Kind.BOOLEAN: KindEntry(
        "Yes or no, the result of a comparison. AZee has no words for these values: `eq 1 1` is "
        "yes.",
        "lt 1 2",
        published=False,
    ),
    Kind.BONE: KindEntry(
        "A bone of the body, with its side and, on fingers, its phalanx.",
        "!index(s, 2)",
        published=True,
    ),
    Kind.SITE: KindEntry(
        "A place on the skin. Where a point is expected, a site stands for its point.",
        "@I_TIP(s)",
        published=True,
    ),
    Kind.VECTOR: KindEntry(
        "A direction with a length, in the signer's frame. It may depend on the posture, as the "
        "direction of a bone does.",
        "oppvect (nrm !palm(s))",
        published=True,
    ),
    Kind.POINT: KindEntry(
        "A place in space. It may depend on the posture, as a place on the body does, or it may "
        "move.",
        "midpoint @CK(L) @CK(R)",
        published=True,
    ),
    Kind.PATH: KindEntry(
        "The shape of a movement, without its ends. The ends are the places before and after it.",
        "arc vec(0, .05, 0)",
        published=True,
    ),
    Kind.LIST: KindEntry(
        "Values in order. They may be of different kinds.",
        "list :arbre :bien",
        published=False,
    ),
    Kind.CONSTRAINTS: KindEntry(
        "What must hold for the body at a time: one constraint or a set of them. Posture rules "
        "give constraints.",
        "cstr (place @I_TIP(s) @CH) :#index-hand",
        published=True,
    ),
    Kind.SCORE: KindEntry(
        "What the body does, and when: constraints in named blocks on a time line. Signs, the "
        "results of production rules and all utterances are scores.",
        "key .5 (look ^fwd)",
        published=True,
    ),
    Kind.OPERATOR: KindEntry(
        "A rule as a value, not applied. It may include some of its arguments.",
        ".nb-5",
        published=True,
    ),
}

_HEAD = """# Kinds of value

This page lists the kinds of value. It is generated from the declarations that also check
operands. **(P)** marks kinds that appear in publications, **(O)** kinds that are this project's
own. All English names are ours. [evaluation.md](evaluation.md) explains evaluation, and
[operators.md](operators.md) describes each operator.

A value of a wrong kind is the mistake [`wrong-type`](errors.md#wrong-type). There are three
exceptions: a site can stand for a point, a single constraint for a set, and a number for an
exact time.

The lists below leave out operators that take values of every kind. They also leave out
operators with a notation of their own: {special}.
"""


def values() -> str:
    """Return docs/language/values.md."""
    special = ", ".join(f"`{native.name}`" for native in NATIVES.values() if native.pattern)
    head = _HEAD.format(special=special)
    return "\n".join([head, *(_kind(kind, entry) for kind, entry in ENTRIES.items())])


def _kind(kind: Kind, entry: KindEntry) -> str:
    title = kind.value.removeprefix("a ").removeprefix("an ").capitalize()
    lines = [f"## {title} ({'P' if entry.published else 'O'})\n", f"{entry.meaning}\n"]
    lines.append(f"```azee kind={kind.name.lower()}\n{entry.example}\n```\n")
    made = [n.name for n in NATIVES.values() if n.result is kind]
    constants = [c.name for c in CONSTANTS.values() if c.value.kind is kind]
    wanted = [n.name for n in NATIVES.values() if any(kind in o.kinds for o in _operands(n))]
    lines += _fact("Made by", made) + _fact("Constants", constants, "^")
    lines += _fact("Taken by", wanted)
    return "\n".join(lines).rstrip("\n") + "\n"


def _operands(native: Native) -> Iterator[Operand]:
    yield from native.operands
    yield from (option.operand for option in native.options if option.operand is not None)


def _fact(what: str, names: Iterable[str], sigil: str = "") -> list[str]:
    listed = ", ".join(f"`{sigil}{name}`" for name in names)
    return [f"- {what}: {listed}"] if listed else []


if __name__ == "__main__":
    sys.stdout.write(values())
