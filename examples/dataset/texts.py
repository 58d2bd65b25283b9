"""The texts of the data set: made by us of rules that ship, with glosses and an English meaning.

Nothing is from a corpus. Whoever wants other texts changes the tables.
"""

from __future__ import annotations

from itertools import product

COUNT = 200

SIGNS = {
    "arbre": "a tree",
    "chat": "a cat",
    "armoire": "a wardrobe",
    "cinéma": "the cinema",
    "cuisine": "the kitchen",
    "pays": "the country",
    "personne": "a person",
    "lieu": "the place",
}
QUALITIES = {
    "bien": "good", "mignon": "cute", "chaud": "hot", "libre": "free", "finir": "finished",
}  # fmt: skip
TIMES = {"hier": "yesterday", "maintenant": "now", "mercredi": "on Wednesday", "août": "in August"}
MONTHS = ("janvier", "mars", "mai", "juillet", "septembre", "décembre")
NUMBERS = (3, 7, 12, 21, 52, 80, 101, 250, 999, 2024)


def texts() -> list[dict[str, str]]:
    """Return 200 texts, in an order that never changes: `name`, `text`, `gloss`, `meaning`."""
    found = [*_lexical(), *_numbers(), *_statements(), *_negated(), *_asked(), *_set(), *_pairs()]
    return [
        {"name": f"{number:03}", "text": text, "gloss": gloss, "meaning": meaning}
        for number, (text, gloss, meaning) in enumerate(found[:COUNT], 1)
    ]


_Row = tuple[str, str, str]


def _lexical() -> list[_Row]:
    words = {**SIGNS, **QUALITIES, **TIMES, "bonjour": "hello"}
    return [(f":{sign}", sign.upper(), meaning) for sign, meaning in words.items()] + [
        (f":{month}", month.upper(), f"the month {month}") for month in MONTHS
    ]


def _numbers() -> list[_Row]:
    return [(f":number({n})", str(n), f"the number {n}") for n in NUMBERS]


def _about() -> list[_Row]:
    return [
        (f":info-about(:{sign}, :{quality})", f"{sign} {quality}".upper(), f"{noun} is {what}")
        for (sign, noun), (quality, what) in product(SIGNS.items(), QUALITIES.items())
    ]


def _statements() -> list[_Row]:
    return _about()


def _negated() -> list[_Row]:
    return [
        (
            f":info-about(:{sign}, :negation(:{quality}))",
            f"{sign} {quality} not".upper(),
            f"{noun} is not {what}",
        )
        for (sign, noun), (quality, what) in product(SIGNS.items(), QUALITIES.items())
    ]


def _asked() -> list[_Row]:
    return [
        (f":yes-no-question({text})", f"{gloss} ?", f"is it so that {meaning}?")
        for text, gloss, meaning in _about()
    ]


def _set() -> list[_Row]:
    return [
        (
            f":in-context(:{time}, :info-about(:{sign}, :{quality}))",
            f"{time} {sign} {quality}".upper(),
            f"{when}, {noun} is {what}",
        )
        for (time, when), (sign, noun), (quality, what) in product(
            TIMES.items(), list(SIGNS.items())[:4], list(QUALITIES.items())[:2]
        )
    ]


def _pairs() -> list[_Row]:
    return [
        (f":not-but(:{one}, :{other})", f"not {one} but {other}".upper(), f"not {a} but {b}")
        for (one, a), (other, b) in product(SIGNS.items(), SIGNS.items())
        if one != other
    ]
