"""Which letters the bodies that ship miss something of: `benchmarks/run.py letters`.

Every letter of the three manual alphabets is performed by every body. Told are constraints that are
missed, and fingers that are inside each other where no touch is asked for.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

from azee.compilation import perform, score_of
from azee.lang.library import shipped_library
from azee.lang.program import load
from azee.spelling.text import LANGUAGES
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig

BODIES = ("signer", "child", "heavy", "game")
HOLD_S = 0.4


def letters() -> Iterator[tuple[str, str]]:
    """Yield the letters of all alphabets, each with its language."""
    for language in LANGUAGES:
        for name in shipped_library(language).namespace.rules:
            if name.startswith("letter-"):
                yield language, name


def missed(language: str, letter: str, rig: Rig) -> list[str]:
    """Perform a letter, such as `letter-A`; return what is missed, in words."""
    text = f"use '{language}\n:{letter} 'hold {HOLD_S}"
    made = perform(score_of(load(Source(letter, text)), None, None), rig, life=False)
    inside = [p for p in made.report.self_contact if not p.intended]
    return [
        *(f"{c.text}: {c.reason}" for c in made.report.constraints if c.missed),
        *(f"{' in '.join(p.pair)}: {1000 * p.depth_m:.1f} mm" for p in inside),
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    """Print what is missed, and how many letters miss something on each body."""
    parser = argparse.ArgumentParser(prog="letters", description=__doc__)
    parser.add_argument("bodies", nargs="*", default=BODIES, help="by default all that ship")
    options = parser.parse_args(arguments)
    for body in options.bodies:
        rig, count, total = load_rig(body), 0, 0
        for language, letter in letters():
            found = missed(language, letter, rig)
            count, total = count + bool(found), total + 1
            for line in found:
                print(f"{body} {language} {letter}: {line}")
        print(f"{body}: {count} of {total} letters miss something")


if __name__ == "__main__":
    main()
