"""The manual's page of values, written from the kinds and the declarations of operators.

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
    """What the manual says of a kind: in words, and an expression that has a value of it."""

    meaning: str
    example: str
    published: bool


ENTRIES: Mapping[Kind, KindEntry] = {
    Kind.NUMBER: KindEntry(
        "A number without a unit: seconds, metres or degrees, by where it stands. Times are kept "
        "exactly, `.1` as one tenth; all else with the fifteen digits of double precision.",
        "-.4",
        published=True,
    ),
    Kind.SYMBOL: KindEntry(
        "A word that stands for itself: the name of an argument or of a block, a keyword, a "
        "moment such as `'SIG:end`.",
        "'SIG:start:-.25",
        published=True,
    ),
    Kind.TEXT: KindEntry(
        "Words for people, as in the `'meaning` of a rule. Nothing is done with them.",
        '"tree, as a plant"',
        published=False,
    ),
    Kind.SIDE: KindEntry(
        "Strong, weak, left or right. Strong and weak stay open until it is known which hand of "
        "the signer is the dominant one.",
        "opposite s",
        published=True,
    ),
    Kind.BOOLEAN: KindEntry(
        "Yes or no, the answer to a comparison. There is no word for either: `eq 1 1` is yes.",
        "lt 1 2",
        published=False,
    ),
    Kind.BONE: KindEntry(
        "A bone of the body, for which it has a side and, on fingers, a phalanx.",
        "!index(s, 2)",
        published=True,
    ),
    Kind.SITE: KindEntry(
        "A place on the skin. Wherever a point is asked for, it is the point where that place is.",
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
        "A place in space. It may depend on the posture, as a place on the body does, or move.",
        "midpoint @CK(L) @CK(R)",
        published=True,
    ),
    Kind.PATH: KindEntry(
        "The shape of a way, without its ends: they are where a site comes from and goes to.",
        "arc vec(0, .05, 0)",
        published=True,
    ),
    Kind.LIST: KindEntry(
        "Values in order, which need not be of one kind.",
        "list :arbre :bien",
        published=False,
    ),
    Kind.CONSTRAINTS: KindEntry(
        "What must hold of the body at a time: one constraint, or a set of them. Posture rules "
        "give constraints.",
        "cstr (place @I_TIP(s) @CH) :#index-hand",
        published=True,
    ),
    Kind.SCORE: KindEntry(
        "Who does what, and when: constraints in named blocks on a time line. Signs, and what "
        "production rules make of them, are scores; so is every utterance.",
        "key .5 (look ^fwd)",
        published=True,
    ),
    Kind.OPERATOR: KindEntry(
        "A rule that is handed over without being applied, perhaps with some of its arguments.",
        ".nb-5",
        published=True,
    ),
}

_HEAD = """# Kinds of value

What an expression can be, from the declarations that also check operands. **(P)** marks kinds that
appear in publications, **(O)** those that are this project's own; the English names are ours
throughout. How values come about is told in [evaluation.md](evaluation.md), each operator in
[operators.md](operators.md).

Where another kind is wanted, the answer is [`wrong-type`](errors.md#wrong-type), with three
exceptions: a site stands for a point, a single constraint for a set, a number for an exact time.

Left out below are operators that take values of every kind, and those with a notation of their own:
{special}.
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
    lines += _fact("Wanted by", wanted)
    return "\n".join(lines).rstrip("\n") + "\n"


def _operands(native: Native) -> Iterator[Operand]:
    yield from native.operands
    yield from (option.operand for option in native.options if option.operand is not None)


def _fact(what: str, names: Iterable[str], sigil: str = "") -> list[str]:
    listed = ", ".join(f"`{sigil}{name}`" for name in names)
    return [f"- {what}: {listed}"] if listed else []


if __name__ == "__main__":
    sys.stdout.write(values())
