"""Mouthing: the mouth says a word of a spoken language, as a score of its own."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction

from azee.lang.native import Group as Heading
from azee.lang.native import Native, Occurrence, Operand, Option
from azee.lang.values import Kind, SymbolValue, TextValue, Value
from azee.score.interval import Interval
from azee.score.score import Arrangement, Block, Call, Group, Key, Score
from azee_grammar.sounds import LANGUAGES, Sound, UnknownSoundError, sounds_of, spelled, visemes
from azee_solver.constraint import Morph, Origin

VOWEL_S = Fraction(12, 100)
CONSONANT_S = Fraction(8, 100)
LONG = Fraction(3, 2)
"""How much longer a sound is after which `:` stands."""
NAME = "mouthing"
REMEDY = "write it in letters, or give its sounds in SAMPA after `'sampa`"


def _mouthing(at: Occurrence, text: str, *, language: Value | None, sampa: Value | None) -> Score:
    if sampa is not None:
        assert isinstance(sampa, TextValue | SymbolValue)
        sounds = _read(at, sampa.content)
    else:
        spelling = language.content if isinstance(language, SymbolValue) else LANGUAGES[0]
        sounds = _read_aloud(at, text, spelling)
    if not sounds:
        raise at.fault("unknown-sound", "there is nothing to mouth", "text", help=REMEDY)
    return mouthed(sounds, Call(NAME, at.origin, mouthed=text))


def _read(at: Occurrence, sampa: str) -> Sequence[Sound]:
    try:
        return sounds_of(sampa)
    except UnknownSoundError as error:
        known = " ".join(visemes())
        message = f"`{error.sign}` is no sound of SAMPA that `mouthing` knows"
        raise at.fault("unknown-sound", message, "sampa", help=f"it knows {known}") from None


def _read_aloud(at: Occurrence, text: str, language: str) -> Sequence[Sound]:
    try:
        return sounds_of(spelled(text, language))
    except UnknownSoundError as error:
        message = f"`mouthing` does not know how `{error.sign}` sounds"
        raise at.fault("unknown-sound", message, "text", help=REMEDY) from None


def mouthed(sounds: Sequence[Sound], call: Call) -> Group:
    """Return the score of some sounds: a block for each, one right after the other.

    Blocks are called as SAMPA writes the sound, with a number where it comes again.
    """
    blocks: list[Block] = []
    time = Fraction(0)
    for name, sound in zip(_names(sounds), sounds, strict=True):
        duration = VOWEL_S if sound.viseme.is_vowel else CONSONANT_S
        duration *= LONG if sound.is_long else 1
        blocks.append(
            Block(name, Interval(time, time + duration), _shape(sound, duration, call.origin))
        )
        time += duration
    return Group(time, calls=(call,), arrangement=Arrangement.SYNC, blocks=tuple(blocks))


def _shape(sound: Sound, duration: Fraction, origin: Origin | None) -> Key:
    weights = sound.viseme.weights
    morphs = (Morph(name, None, weight, origin=origin) for name, weight in weights.items())
    return Key(duration, constraints=tuple(morphs))


def _names(sounds: Sequence[Sound]) -> Iterator[str]:
    seen: Counter[str] = Counter()
    for sound in sounds:
        seen[sound.sampa] += 1
        yield sound.sampa if seen[sound.sampa] == 1 else f"{sound.sampa}{seen[sound.sampa]}"


OPERATORS = (
    Native(
        NAME,
        Heading.SCORES,
        "The mouth says a text without voice: a block for each sound, "
        f"{float(CONSONANT_S):g} s for a consonant and {float(VOWEL_S):g} s for a vowel. In a "
        "`sync` it is stretched like any score. [Mouthing](mouthing.md) lists the sounds.",
        (Operand("text", "what is said; a single word may be a symbol", (Kind.TEXT, Kind.SYMBOL)),),
        (
            Option(
                "language",
                "whose spelling it is; by default `'fr`",
                Operand("language", "a language", (Kind.SYMBOL,), LANGUAGES, raw=True),
            ),
            Option(
                "sampa",
                "its sounds, which are then not guessed from the spelling",
                Operand("sampa", "sounds in SAMPA", (Kind.TEXT, Kind.SYMBOL), raw=True),
            ),
        ),
        result=Kind.SCORE,
        example='mouthing "bonjour" \'sampa "bo~ZuR"',
        function=_mouthing,
    ),
)
