"""Plays a text with the signs of a database: `azee play`.

Each sign is what the database has. In the mode `words` a word that it lacks is signed by a rule of
the libraries in use, else spelled. A signer stands idle before and after.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING

from azee.compilation import Compilation, perform
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity

if TYPE_CHECKING:
    from azee.clip.blend import Blend
    from azee.lang.program import Program
    from azee.motion.keys.rest import Rest
    from azee.quality.constraint_results import ConstraintResult
    from azee.score.score import Score
    from azee.signs.database import SignDatabase
    from azee.signs.sequence import Played, PlayedSign
    from azee.signs.sign import Sign
    from azee.signs.wanted import TextMode, Wanted
    from azee.spelling.text import Language
    from azee_rig.rig import Rig

SPELLED_IN: Language = "asl"
"""The manual alphabet of languages that have none here."""


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A sign to play, with its score, and the compilation of it if it is no recording."""

    sign: PlayedSign
    score: Score
    made: Compilation | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Player:
    """Plays texts on one body.

    database: where signs are looked for first. language: only signs of it, and its rules and
    letters; any if none. variant: only signs with it. program: an empty text whose rules sign words
    that the database lacks. idle_s: how long the signer stands idle before and after.
    """

    database: SignDatabase
    place: str
    rig: Rig
    program: Program
    language: str | None = None
    variant: str | None = None
    fps: float = 30.0
    rest: Rest = "hanging"
    life: bool = True
    blend: Blend = "direct"
    transition_s: float | None = None
    idle_s: float = 0.5

    def play(self, text: str, mode: TextMode) -> tuple[Compilation, tuple[Diagnostic, ...]]:
        """Play a text; return the movement, and what is to be told of it.

        Raises: AZeeError: no sign is left to play, or one cannot be played on this body.
            SignsError: the database cannot be read. RecordingError: a movement cannot.
        """
        from azee.signs.wanted import wanted

        told: list[Diagnostic] = []
        pieces = [piece for one in wanted(text, mode) for piece in self._pieces(one, mode, told)]
        if not pieces:
            nothing = Diagnostic("unknown-sign", "there is no sign of the text to play", None)
            raise AZeeError(*told, nothing)
        return self._joined(pieces), tuple(told)

    def _pieces(self, one: Wanted, mode: TextMode, told: list[Diagnostic]) -> Iterator[Piece]:
        sign = self._sign(one)
        if sign is not None:
            yield self._recorded(sign)
            return
        if mode != "words":
            told.append(_warning(f"`{self.database.store.name}` has no sign for `{one.text}`; "
                                 "it is left out"))  # fmt: skip
            return
        rule = self._rule(one)
        if rule is not None:
            yield self._compiled(f":{rule}", one.text)
            return
        expression = self._spelled(one.text)
        if expression is None:
            told.append(_warning(f"there is no sign for `{one.text}`, and nothing of it can be "
                                 "spelled; it is left out"))  # fmt: skip
            return
        told.append(_warning(f"there is no sign for `{one.text}`: it is spelled"))
        yield self._compiled(expression, one.text)

    def _sign(self, one: Wanted) -> Sign | None:
        """Return the sign of the first name that the database has."""
        from azee.signs.query import Query

        for name in one.names:
            query = Query(name=name, language=self.language, variant=self.variant)
            for sign in self.database.find(query):
                return sign
        return None

    def _recorded(self, sign: Sign) -> Piece:
        from azee.signs.recordings import recorded
        from azee.signs.sequence import PlayedSign

        score = recorded(sign, self.place)
        clip = score.motion.clip(self.rig)
        name, timing = sign.identity.name, sign.facts.timing
        return Piece(PlayedSign(name, clip, timing.attack_s, timing.decay_s), score)

    def _rule(self, one: Wanted) -> str | None:
        """Return the first rule that is called like a word and needs no arguments."""
        for name in one.names:
            rule = self.program.scope.find(name)
            if rule is not None and not any(needed for _, needed in rule.parameters):
                return name
        return None

    def _spelled(self, word: str) -> str | None:
        from azee.spelling.text import LANGUAGES, spelled

        language = next((known for known in LANGUAGES if known == self.language), SPELLED_IN)
        found = spelled(word, language)
        letters = "".join(c for w in found.words for c in w.characters)
        if not letters:
            return None
        return f":fingerspelling('text = \"{letters}\", 'language = '{language})"

    def _compiled(self, expression: str, name: str) -> Piece:
        from azee.signs.sequence import PlayedSign

        made = self._performed(self.program.evaluate(expression).score)
        lead_s = made.report.lead_s
        decay_s = made.clip.duration_s - lead_s - made.report.score_s
        return Piece(PlayedSign(name, made.clip, lead_s, decay_s), made.score, made)

    def _performed(self, score: Score) -> Compilation:
        return perform(score, self.rig, fps=self.fps, rest=self.rest, life=self.life)

    def _idle(self, seconds: float) -> PlayedSign:
        """Return the signer doing nothing for so long, with life."""
        from azee.clip.edit import cut
        from azee.score.score import Blank
        from azee.signs.sequence import PlayedSign

        still = self._performed(Blank(Fraction(seconds).limit_denominator(1000)))
        start = float(still.clip.times[0])
        seconds = min(seconds, still.clip.duration_s)
        return PlayedSign(
            None, cut(still.clip, start, start + seconds, self.rig.coordinates), 0.0, 0.0
        )

    def _joined(self, pieces: Sequence[Piece]) -> Compilation:
        from azee.clip.resample import TooManyFramesError
        from azee.signs.sequence import played

        first, last = pieces[0].sign.attack_s, pieces[-1].sign.decay_s
        before = replace(self._idle(self.idle_s + first), decay_s=first)
        after = replace(self._idle(last + self.idle_s), attack_s=last)
        signs = [before, *(piece.sign for piece in pieces), after]
        try:
            whole = played(
                signs, self.rig.coordinates,
                blend=self.blend, fps=self.fps, transition_s=self.transition_s,
            )  # fmt: skip
        except TooManyFramesError as error:
            raise AZeeError(Diagnostic("clip-times", str(error), None)) from error
        return self._compilation(pieces, whole)

    def _compilation(self, pieces: Sequence[Piece], whole: Played) -> Compilation:
        """Return a sequence with its score, as a text would be compiled to it."""
        from azee.animation import Animation
        from azee.motion.tasks.flatten import flatten
        from azee.motion.tasks.key_selection import KeySelection
        from azee.motion.tasks.limbs import Limbs
        from azee.motion.tasks.schedule import bind
        from azee.motion.tasks.tracks import tracks
        from azee.quality.likeness import likeness
        from azee.quality.measures import PenetrationSearch, peaks
        from azee.quality.motion_report import MotionReport, limit_excess
        from azee.quality.recordings import as_played
        from azee.quality.task_spans import task_spans
        from azee_solver.evaluate import evaluator
        from azee_solver.geometry import Side

        score, lead_s = _score(pieces, whole)
        clip, rig, side = whole.clip, self.rig, Side.RIGHT
        limbs = Limbs.of(rig.coordinates)
        schedule = bind(flatten(score), rig, evaluator(rig, side).binding, limbs)
        excess, joint = limit_excess(clip.coordinates, rig.coordinates)
        names = rig.coordinates.names
        spans = task_spans(schedule.all, {}, schedule.recorded)
        report = MotionReport(
            rig=rig.name,
            fps=self.fps,
            mode="tracks",
            duration_s=clip.duration_s,
            lead_s=lead_s,
            score_s=float(score.duration),
            measure_constraints=partial(_constraints, pieces, whole, lead_s),
            max_excess_rad=excess,
            excess_joint=joint,
            postures=(),
            blocks=(),
            measure_peaks=partial(peaks, clip.coordinates, self.fps, names, lead_s),
            measure_penetration=PenetrationSearch(
                rig, side, schedule, clip.coordinates, clip.times
            ),
            measure_likeness=partial(likeness, clip, rig, score, spans, zero_s=lead_s),
            recordings=tuple(map(as_played, schedule.recorded)),
        )
        moments = tuple(t for body in whole.bodies_s for t in (body[0], sum(body) / 2, body[1]))
        missing = tuple(d for piece in pieces if piece.made for d in piece.made.left_out)
        rows = tracks(schedule, (), KeySelection(limbs), rig.coordinates)
        animation = Animation(score, clip, report, moments, lead_s, rows)
        return Compilation(score, rig, animation, missing)


def _score(pieces: Sequence[Piece], whole: Played) -> tuple[Score, float]:
    """Return the signs as blocks of one score, each as long as it plays, and when they start."""
    from azee.score.interval import Interval
    from azee.score.score import Arrangement, Block, Call, Group, Recorded

    lead_s = whole.starts_s[0]
    blocks = []
    for n, (piece, name) in enumerate(zip(pieces, whole.names, strict=True)):
        body, zero = whole.bodies_s[n], whole.starts_s[n]
        start, end = _exact(zero - lead_s), _exact(whole.ends_s[n] - lead_s)
        score: Score = piece.score
        if isinstance(score, Recorded):
            score = replace(
                score,
                duration=end - start,
                attack_s=_exact(body[0] - lead_s) - start,
                decay_s=end - _exact(body[1] - lead_s),
                calls=(Call("recorded", recorded=name),),
            )
        else:
            start = _exact(body[0] - lead_s)
            end = start + score.duration
        blocks.append(Block(str(n + 1), Interval(start, end), score))
    duration = max(block.interval_in_parent.end for block in blocks)
    return Group(duration, arrangement=Arrangement.SEQ, blocks=tuple(blocks)), lead_s


def _exact(seconds: float) -> Fraction:
    return Fraction(seconds).limit_denominator(10**6)


def _constraints(
    pieces: Sequence[Piece], whole: Played, lead_s: float
) -> tuple[ConstraintResult, ...]:
    """Return the constraints of signs that were compiled, measured in these, at their new times."""
    out = []
    for n, piece in enumerate(pieces):
        by_s = whole.bodies_s[n][0] - lead_s
        for found in piece.made.report.constraints if piece.made else ():
            path = (str(n + 1), *found.path)
            out.append(
                replace(found, path=path, start_s=found.start_s + by_s, end_s=found.end_s + by_s)
            )
    return tuple(out)


def _warning(message: str) -> Diagnostic:
    return Diagnostic("unknown-sign", message, None, severity=Severity.WARNING)
