"""Tiers of an ELAN file by content: signs by name, parts of the signer, rules.

Linguists annotate signs on a tier of glosses, and hands, head, gaze and face on tiers of their own.
A *sign* is here what a rule moves the hands with, if the text gives it no other sign to work with:
of `tens-units(.nb-5, .nb-2)` the two numbers, but a sign whose rule applies other rules as a whole.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from azee.export.formats.eaf_tiers import Note, Tier, in_lanes, note_of
from azee.score.articulators import ARTICULATORS, CHANNEL, HANDS, articulator_of
from azee.score.interval import Interval
from azee.score.score import Call, Group, Hold, Key, Recorded, Score, is_mouthing, leaves
from azee_solver.notation import constraint_text

GLOSS, ARTICULATOR, RULE = "gloss", "articulator", "rule"
"""Linguistic types: names of signs, what a part of the signer does, where a rule is applied."""
RECORDED = "recorded"
"""Linguistic type: recorded signs that are played."""
MOUTHING, SOUNDS = "mouthing", "mouthing sounds"
"""Linguistic types: what the mouth says, and its sounds in SAMPA."""
HANDS_CHANNEL = "hands"


@dataclass(frozen=True, eq=False)
class Node:
    """A score at its place in the whole: its time there, the blocks inside it.

    texts: the files whose own applications count as those of the text.
    """

    name: str
    score: Score
    interval: Interval
    around: Node | None
    texts: frozenset[str]

    @cached_property
    def inner(self) -> Sequence[Node]:
        """The blocks of a group, in order of time."""
        if not isinstance(self.score, Group):
            return ()
        start = self.interval.start
        nodes = [
            Node(b.name, b.score, b.interval_in_parent.shifted(start), self, self.texts)
            for b in self.score.blocks
        ]
        return sorted(nodes, key=lambda node: (node.interval.start, node.name))

    def all(self) -> Iterator[Node]:
        """Yield it and all inside it, outer before inner."""
        yield self
        for node in self.inner:
            yield from node.all()

    @cached_property
    def moves(self) -> frozenset[str]:
        """The parts of the signer that its constraints move; holds not counted."""
        return _moved(self.score)

    @cached_property
    def signs(self) -> Sequence[Node]:
        """The signs in it, in order; itself if it is one."""
        inside = [sign for node in self.inner for sign in node.signs]
        if not self.score.calls or any(sign.is_of_text for sign in inside):
            return inside
        return [self] if any(part.endswith("hand") for part in self.moves) else []

    @property
    def is_of_text(self) -> bool:
        """Whether the text applies its rule or hands it over, not a rule of a library."""
        return any(self.wrote(call) or call.handed_over for call in self.score.calls)

    def wrote(self, call: Call) -> bool:
        """Whether the text applies a rule itself."""
        return call.origin is None or call.origin.rule is None or call.origin.file in self.texts

    @property
    def gloss(self) -> str:
        """The rule or recording that it came from, as the text has it; else the block's name."""
        if not self.score.calls:
            return self.name
        return self.score.calls[0].recorded or self.score.calls[0].rule


def content_tiers(score: Score, lead_s: float = 0.0) -> list[Tier]:
    """Return the tiers of a score by content; `lead_s` is the time of its start."""
    start = Fraction(lead_s)
    root = Node("", score, Interval(start, start + score.duration), None, _texts(score))
    return [
        *_gloss_tiers(root),
        *_recorded_tiers(root),
        *_mouthing_tiers(root),
        *_articulator_tiers(root),
        *_rule_tiers(root),
    ]


def _gloss_tiers(root: Node) -> list[Tier]:
    return in_lanes(GLOSS, GLOSS, (_note(sign.gloss, sign) for sign in root.signs))


def _recorded_tiers(root: Node) -> list[Tier]:
    nodes = (node for node in root.all() if isinstance(node.score, Recorded))
    return in_lanes(RECORDED, RECORDED, (_note(_name(node.score), node) for node in nodes))


def _name(score: Score) -> str:
    return score.motion.name if isinstance(score, Recorded) else ""


def _mouthing_tiers(root: Node) -> list[Tier]:
    said: list[Note] = []
    sounds: list[Note] = []
    for node in root.all():
        if is_mouthing(node.score):
            text = next(c.mouthed for c in node.score.calls if c.mouthed is not None)
            said.append(_note(text, node))
            sounds += (_note(sound.name, sound) for sound in node.inner)
    return [
        *in_lanes(MOUTHING, MOUTHING, sorted(said, key=_start)),
        *in_lanes(SOUNDS, SOUNDS, sorted(sounds, key=_start)),
    ]


def _articulator_tiers(root: Node) -> list[Tier]:
    found: dict[str, list[Note]] = {}
    sign_of = {id(node): sign for sign in root.signs for node in sign.all()}
    for node in root.all():
        if node.around is not None and is_mouthing(node.around.score):
            continue
        for part, text in _actions(node, sign_of.get(id(node))):
            found.setdefault(part, []).append(_note(text, node))
    return [
        tier
        for part in ARTICULATORS
        for tier in in_lanes(part, ARTICULATOR, sorted(found.get(part, ()), key=_start))
    ]


def _actions(node: Node, sign: Node | None) -> Iterator[tuple[str, str]]:
    """Yield the parts that a leaf of a score moves or holds, with what it does to each.

    sign: the one that the leaf is of.
    """
    score = node.score
    if isinstance(score, Key):
        texts: dict[str, list[str]] = {}
        for constraint in score.constraints:
            part = articulator_of(constraint)
            texts.setdefault(part, []).append(constraint_text(constraint))
        for part, said in texts.items():
            yield part, _hand_text(node, sign) if part.endswith("hand") else "; ".join(said)
    elif isinstance(score, Hold) and node.around is not None:
        held = next((n for n in node.around.inner if n.name == score.block), None)
        for part in sorted(held.moves if held else ()):
            if not _channels(part).isdisjoint(score.channels):
                yield part, f"hold {held.gloss if held else score.block}"


def _channels(part: str) -> frozenset[str]:
    """Return the channels of which any, in a hold, keeps a part of the signer."""
    if part in CHANNEL:
        return frozenset({CHANNEL[part]})
    return frozenset({HANDS_CHANNEL, part.removesuffix(" hand")})


def _hand_text(node: Node, sign: Node | None) -> str:
    """Say which sign a leaf is of, and which of its blocks."""
    if sign is None or sign is node:
        return node.gloss
    return f"{sign.gloss} · {node.name}"


def _rule_tiers(root: Node) -> list[Tier]:
    """Return a tier for every rule that the text applies to other signs, or to no hands."""
    found: dict[str, list[Note]] = {}
    signs = set(map(id, root.signs))
    for node in root.all():
        for call in node.score.calls:
            named = call.mouthed is None and call.recorded is None
            if id(node) not in signs and named and node.wrote(call):
                said = " ".join(sign.gloss for sign in node.signs)
                found.setdefault(call.rule, []).append(_note(said or call.rule, node))
    return [tier for rule in found for tier in in_lanes(f"{RULE} {rule}", RULE, found[rule])]


def _texts(score: Score) -> frozenset[str]:
    """Return the files that apply rules outside any definition."""
    own = _own_files(score.calls)
    inner = score.blocks if isinstance(score, Group) else ()
    return own.union(*(_texts(block.score) for block in inner))


def _own_files(calls: Iterable[Call]) -> frozenset[str]:
    return frozenset(c.origin.file for c in calls if c.origin and c.origin.rule is None)


def _moved(score: Score) -> frozenset[str]:
    """Return the parts that a score moves; a recorded sign is taken for one of both hands."""
    if any(isinstance(leaf.score, Recorded) for leaf in leaves(score)):
        return frozenset(HANDS.values())
    return frozenset(
        articulator_of(constraint)
        for leaf in leaves(score)
        if isinstance(leaf.score, Key)
        for constraint in leaf.score.constraints
    )


def _note(text: str, node: Node) -> Note:
    return note_of(text, node.interval.start, node.interval.end)


def _start(note: Note) -> tuple[int, int]:
    return note.start_ms, note.end_ms
