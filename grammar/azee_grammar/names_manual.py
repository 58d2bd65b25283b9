"""The manual's page of names, generated from the tables of the vocabulary.

`python -m azee_grammar.names_manual` prints docs/language/names.md; a test compares the two.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator

from azee_grammar.vocabulary import BONES, MORPHS, SITES, WITHOUT_MORPH

_HEAD = """# All names of the body

This page lists every bone, place on the body and morph, as a text writes it. The tables write
sides as `L` and `R`. A text may also write `s` and `w`, the strong and the weak hand, and may
put the side of a morph after its name: `'index_bend s .5`. The names are published (P); the
descriptions are ours (O). [vocabulary.md](vocabulary.md) explains the names of sites and lists
corrections.
"""

_KINDS = {
    "facial": ("Movements of the face", "Action units; weight 1 is the full movement."),
    "facial-alternative": (
        "Further movements of the face",
        "Alternatives for the same movements or for parts of them.",
    ),
    "skeletal": ("Movements of fingers, hands and trunk", "Weight 0 is the neutral posture."),
    "own-skeletal": (
        "Further movements of fingers",
        "These names are ours (O). Negative weights of the single fingers go the other way.",
    ),
    "legacy-facial": ("Older names of movements of the face", "Published expressions use them."),
    "legacy-skeletal": (
        "Older names of movements of the hand",
        "Published expressions use them; without a side they mean both hands.",
    ),
}

_FULL = re.compile(r"(?P<name>.+?)_(?P<side>[LR])(?:_(?P<phalanx>[123]))?", re.ASCII)


def names() -> str:
    """Return docs/language/names.md."""
    bones = ((_written("!", name), _written("!", parent)) for name, parent in BONES.items())
    sites = (
        (_written("@", name), entry.description, _written("!", entry.bone))
        for name, entry in SITES.items()
    )
    parts = [
        _HEAD,
        f"## Bones\n\n{len(BONES)} bones.\n\n{_table(('bone', 'parent'), bones)}",
        f"## Sites\n\n{len(SITES)} places on the body.\n\n"
        + _table(("site", "where", "carried by"), sites),
        *_morphs(),
        "## Action units without a morph\n\n"
        + _table(("unit", "instead"), ((f"`{n}`", text) for n, text in WITHOUT_MORPH.items())),
    ]
    return "\n".join(parts)


def _morphs() -> Iterator[str]:
    for kind, (title, remark) in _KINDS.items():
        found = {name: entry for name, entry in MORPHS.items() if entry.kind == kind}
        rows = ((f"`'{name}`", entry.description) for name, entry in found.items())
        table = _table(("morph", "movement"), rows)
        yield f"## {title}\n\n{len(found)} morphs. {remark}\n\n{table}"


def _written(sigil: str, name: str | None) -> str:
    """Return a full name as a text writes it: `index_R_2` is `!index(R, 2)`."""
    if name is None:
        return "none: the root"
    if (match := _FULL.fullmatch(name)) is None:
        return f"`{sigil}{name}`"
    operands = ", ".join(part for part in (match["side"], match["phalanx"]) if part)
    return f"`{sigil}{match['name']}({operands})`"


def _table(heads: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [heads, ("---",) * len(heads), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


if __name__ == "__main__":
    sys.stdout.write(names())
