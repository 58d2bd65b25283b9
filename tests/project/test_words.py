"""Words that only this project used stay out of documents and sources.

The solver and the motion once had a language of their own; docs/glossary.md lists the field's words
that replaced it, and keeps the old ones in its section on history. `WORDS` must not occur in any
text: pages, docstrings, comments or names. `NAMES` are ordinary words that must not name things.
"""

from __future__ import annotations

import io
import re
import subprocess
import tokenize
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

WORDS: Mapping[str, str] = {
    "ghost ghosts": "relaxed problem",
    "ease": "weight, given up, posture cost, joint-limit cost",
    "give-way gives-way giving-way given-way gave-way": "order of priorities, given up",
    "settle settles settled settling": "priorities",
    "hopeless": "infeasible",
    "in-vain": "failed descents, stalled",
    "leap leaps leapt leaping": "jump",
    "dodge dodges dodged dodging": "avoid",
    "swerve swerves swerved swerving": "avoid",
    "detour detours": "via point",
    "demand demands demanded demanding": "task",
    "poser posers": "posture solver",
    "gauge gauges": "residual monitor",
    "keying": "key selection",
    "resting": "neutral, idle",
    "look-on looks-on looked-on looking-on": "keep searching",
    "yardstick yardsticks": "reference",
}
"""Words and pairs of words, by the meaning that the field's words give better."""

NAMES: Mapping[str, str] = {
    "press presses pressed pressing": "stiff descent",
    "descend descends descended": "soft descent, stiff descent",
    "lost": "unmet",
}
"""Words that are plain in a sentence but must not name a function, a class or a value."""

ALLOWED: Mapping[str, Sequence[str]] = {
    "press": ("azee/repl/prompt.py", "docs/repl_pictures.py"),  # keys of a keyboard
    "descend": ("benchmarks/ik/",),  # what the reference kernel does, not a private word
    "lost": (
        "azee/clip/own_bvh.py",  # rotation that a clip cannot keep
        "azee/clips.py",
        "rig/azee_rig/importing/",  # sites that could not be placed
    ),
    "resting": ("azee/cli/rig.py", "azee/export/pictures/still.py"),  # at bind; without movement
}
"""Where a word has another meaning."""

PAGES = ("*.md", "docs", "editors", "examples")
BUILT = ROOT / "azee" / "web" / "dist"
"""Scripts that are built hold libraries of others."""
SOURCES = ("azee", "benchmarks", "grammar", "rig", "solver", "docs", "examples")


def _listed(*where: str) -> list[Path]:
    done = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *where],
        cwd=ROOT,
        capture_output=True,
        check=False,
    )
    if done.returncode:
        pytest.skip("not a git checkout")
    return [ROOT / name for name in done.stdout.decode().split("\0") if name]


def _by_word(table: Mapping[str, str]) -> dict[str, str]:
    return {word: better for words, better in table.items() for word in words.split()}


def _excused(path: Path, word: str) -> bool:
    name = path.relative_to(ROOT).as_posix()
    return name.startswith(tuple(ALLOWED.get(word, ())))


def words(text: str) -> Iterator[tuple[int, str]]:
    """Yield the words of a text, those inside names too, and each two that follow each other.

    Every word comes with the line on which it begins.
    """
    found = [
        (number, word.lower())
        for number, line in enumerate(text.splitlines(), 1)
        for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", line)
    ]
    yield from found
    yield from ((number, f"{before}-{after}") for (number, before), (_, after) in pairwise(found))


def names(text: str) -> Iterator[tuple[int, str]]:
    """Yield the names in a Python text with their lines."""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.NAME:
            yield token.start[0], token.string


def texts() -> list[Path]:
    """Pages and sources that are read by people."""
    pages = [p for p in _listed(*PAGES) if p.suffix == ".md"]
    sources = [p for p in _listed(*SOURCES) if p.suffix in (".py", ".js", ".ts")]
    written = (path for path in dict.fromkeys((*pages, *sources)) if BUILT not in path.parents)
    return [path for path in written if path.is_file()]


def test_no_private_word_stands_in_a_text() -> None:
    banned = _by_word(WORDS)
    found = []
    for path in texts():
        text = path.read_text(encoding="utf-8")
        if path == ROOT / "docs" / "glossary.md":
            text = text.partition("\n## History")[0]
        found += [
            f"{path.relative_to(ROOT)}:{number}: `{word}`; better: {banned[word]}"
            for number, word in (*words(path.stem), *words(text))
            if word in banned and not _excused(path, word)
        ]
    assert found == []


def test_no_private_verb_names_a_thing() -> None:
    banned = _by_word(NAMES)
    found = []
    for path in texts():
        text = path.read_text(encoding="utf-8")
        present = {word for _, word in (*words(path.stem), *words(text))}
        if path.suffix != ".py" or present.isdisjoint(banned):
            continue
        found += [
            f"{path.relative_to(ROOT)}:{number}: `{name}`; better: {banned[word]}"
            for number, name in ((0, path.stem), *names(text))
            for _, word in words(name)
            if word in banned and not _excused(path, word)
        ]
    assert found == []


def test_words_are_found_inside_names_and_sentences() -> None:
    assert (1, "in-vain") in words("stop if in_vain")
    assert (1, "giving-way") in words("SHORTEST_GIVING_WAY")
    assert (2, "look-on") in words("as before\nlook\non")
    assert (1, "poser") in words("class KeyPoser")
    assert (1, "ease") not in words("release increase")
