"""The whole way from a text to files: `azee.compile`, and what it gives back."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

from azee.arguments import (
    folders,
    rate,
    require_one_of,
    require_seed,
    require_switch,
    require_tempo,
    require_text,
)
from azee.formats import WRITERS, write_elan, writing
from azee.wording import counted
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity

if TYPE_CHECKING:
    from azee.animation import Animation
    from azee.clip.clip import Clip
    from azee.lang.program import Program
    from azee.lang.recordings import Recordings
    from azee.lang.shortcuts import Taken
    from azee.motion.keys.rest import Rest
    from azee.motion.tasks.key_posture import PostureSolver
    from azee.motion.tasks.key_selection import Mode
    from azee.motion.timing.performed import Timing
    from azee.quality.motion_report import MotionReport
    from azee.score.provenance import Provenance
    from azee.score.score import Score
    from azee_grammar.source import Source
    from azee_rig.rig import Rig
    from azee_solver.binding import BindingError
    from azee_solver.geometry import Side

Hand = Literal["right", "left"]
Method = Literal["grouped", "two-level"]


@dataclass(frozen=True, eq=False)
class Compilation:
    """A score, the body that plays it, the motion, and the report on it.

    It can be pickled and copied. A pickle leaves out the body's surface, which is read from the
    body's folder when a file or a picture needs it.

    score: nested blocks of constraints; times in seconds, as performed. rig: the body. animation:
    the clip and the report, and the times of the keys of every part of the body. left_out: a
    warning for each name of a bone, site or morph that the body lacks; constraints with that name
    were left out.
    unshown: a warning for each movement that is too fast for the clip's frames. shortcuts: the
    expressions of the text for which recorded signs are played.
    """

    score: Score
    rig: Rig
    animation: Animation
    left_out: tuple[Diagnostic, ...] = ()
    unshown: tuple[Diagnostic, ...] = ()
    shortcuts: tuple[Taken, ...] = ()

    @property
    def clip(self) -> Clip:
        """The motion over T frames, read-only.

        times: (T,) seconds. coordinates: (T, V) radians, in the order of
        `rig.coordinates.names`. unit_weights: (T, M) of the face units that move.
        """
        return self.animation.clip

    @property
    def report(self) -> MotionReport:
        """Every constraint with its residual, metres or radians; limits and penetration.

        `report.met` says whether all constraints are within tolerance, `report.missed` whether one
        is neither that nor eased for comfort. `report.as_json()` is what `save_report` writes.
        Penetration in the clip is measured when it is first read.
        """
        return self.animation.report

    @property
    def provenance(self) -> Provenance | None:
        """How far the forms of the rules in the text are known; none where there was no text."""
        return self.animation.provenance

    def report_json(self) -> dict[str, object]:
        """Return the report as JSON, with its provenance and messages about what the body lacks."""
        left_out = [{"code": d.code, "message": d.message} for d in self.left_out]
        provenance = self.provenance.as_json() if self.provenance else None
        return {
            **self.report.as_json(),
            "provenance": provenance,
            "left_out": left_out,
            "shortcuts": [taken.as_json() for taken in self.shortcuts],
        }

    def save_report(self, path: str | Path) -> None:
        """Write the report as JSON, as docs/formats.md describes it.

        Raises: AZeeError: cannot-write.
        """
        from azee.export.files import replace_file

        data = json.dumps(self.report_json(), indent=2, ensure_ascii=False, allow_nan=False)
        with writing(path), replace_file(path) as file:
            file.write(f"{data}\n".encode())

    def save(self, path: str | Path, *, media: str | Path | None = None) -> None:
        """Write a file whose suffix names the format: one of `SUFFIXES` or `FILM_SUFFIXES`.

        Args: path: may exist, its folder must. media: the film that an ELAN file (.eaf) shows
            beside the score; other formats ignore it.
        Raises: ValueError: no format has that suffix. AZeeError: cannot-write; not-installed: a
            film needs the extra `film`; clip-times: a film would have too many frames.
        """
        write = WRITERS.get(Path(path).suffix.lower())
        if write is None:
            raise ValueError(f"no format has the suffix of {path}; known are {' '.join(WRITERS)}")
        with writing(path):
            if media is not None and Path(path).suffix.lower() == ".eaf":
                write_elan(self.score, self.animation, Path(path), Path(media))
            else:
                write(self.score, self.rig, self.animation, Path(path))


def compile(  # noqa: A001 - azee.compile, as re.compile
    text_or_path: str | Path | None = None,
    rig: str | Path | Rig = "signer",
    *,
    expression: str | None = None,
    utterance: int | None = None,
    libraries: Sequence[str | Path] = (),
    dominant: Hand = "right",
    fps: float = 30.0,
    mode: Mode = "tracks",
    seed: int | None = None,
    life: bool = True,
    rest: Rest = "hanging",
    solver: Method = "grouped",
    precise: bool = False,
    strict_body: bool = False,
    timing: Timing | None = None,
    tempo: float = 1.0,
    recordings: Recordings | None = None,
) -> Compilation:
    """Compile AZee to a signing body.

    The same arguments give the same clip. A process reads each body once, and again when a file
    in the body's folder changes.

    Args: text_or_path: the text, or the path of a file. A string of one line that ends in .azee
            or .az is a path. Optional if there is an expression.
        rig: the name of a rig that ships (`azee_rig.load.shipped_rigs()`), a rig's folder, or a
            loaded rig.
        expression: is compiled instead of the text's utterances. It sees the rules of the text.
        utterance: the number, from 1, of the one utterance to compile. By default all are
            compiled, one after the other, with a pause of one second.
        libraries: folders in which `use` looks for libraries, after the folder of the text.
        dominant: the signer's strong hand, right or left.
        fps: frames per second, at least 1.
        mode: how blocks become movement. tracks: each block keys the limbs that it needs. flat:
            every key is a key of the whole body, as in Nunnari et al. 2018.
        seed: of the random numbers for breathing, blinking and sway, a whole number from 0 on; by
            default one that follows from the score.
        life: whether the signer breathes, blinks and sways.
        rest: where arms are before and after, and while nothing is asked of them. hanging: at the
            sides. folded: one hand lies on the other before the belly. ready: before the body,
            bent.
        solver: how postures are found. grouped: problems that share coordinates are solved
            together. two-level: the iteration of Nunnari et al. 2018, for comparison.
        precise: whether to meet every constraint as exactly as can be. By default the posture
            stops inside 1 cm and 5° where the rest would cost more than 5° of trunk or drive a
            joint to its limit; the report tells which constraints were eased and the price.
        strict_body: whether to refuse a text that names a bone, site or morph that the body lacks.
            By default such constraints are left out, with a warning for each name in `left_out`.
        timing: performed: where an arm has too far to go for its time, the score gets longer, and
            the report tells where. exact: all times are the text's. By default performed; exact in
            flat mode.
        tempo: how many times faster all is that is not `fixed`, such as 1.2.
        recordings: where `recorded` finds signs: `azee.signs.recordings.SignRecordings("signs.db")`
            is a database.
    Raises: AZeeError: the text has mistakes, or has no such utterance; cannot-read: there is no
            such file; bad-manifest: that of a library cannot be read; rig-lacks-bone,
            rig-lacks-site, rig-lacks-morph: the rig lacks something that the text names, and
            `strict_body` is set; clip-times: the clip would have more than 500,000 frames.
        RigError: the rig does not exist or cannot be read. It is a ValueError.
        ValueError: an argument has a wrong value or type; the message says what is allowed.
    """
    from azee.lang.program import load
    from azee.lang.provenance import provenance_of, written
    from azee_rig.load import load_rig
    from azee_rig.rig import Rig

    require_text(text_or_path, expression, utterance)
    _require_options(dominant, fps, mode, seed, life, rest, solver, timing, tempo)
    require_switch(precise, "precise")
    found = folders(libraries)
    body = rig if isinstance(rig, Rig) else load_rig(rig)
    program = load(source_of(text_or_path), found, recordings=recordings)
    score = score_of(program, expression, utterance, dominant)
    return perform(
        score,
        body,
        dominant=dominant,
        fps=fps,
        mode=mode,
        seed=seed,
        life=life,
        rest=rest,
        solver=solver,
        precise=precise,
        strict_body=strict_body,
        timing=timing,
        tempo=tempo,
        provenance=provenance_of(written(program, expression, utterance)),
    )


def score_of(
    program: Program, expression: str | None, utterance: int | None, dominant: Hand = "right"
) -> Score:
    """Return the score of an expression, else of one utterance, else of all in sequence.

    Raises: AZeeError: all mistakes in the text, also where an expression is given.
    """
    if expression is None:
        return program.score(utterance, _side(dominant))
    found = program.check(_side(dominant))
    if any(d.severity is Severity.ERROR for d in found):
        raise AZeeError(*found)
    return program.evaluate(expression).score


def perform(
    score: Score,
    rig: Rig,
    *,
    dominant: Hand = "right",
    fps: float = 30.0,
    mode: Mode = "tracks",
    seed: int | None = None,
    life: bool = True,
    rest: Rest = "hanging",
    solver: Method = "grouped",
    precise: bool = False,
    strict_body: bool = False,
    timing: Timing | None = None,
    tempo: float = 1.0,
    provenance: Provenance | None = None,
    postures: PostureSolver | None = None,
) -> Compilation:
    """Make a body play a score. The options are those of `compile`.

    Args: provenance: of the text that the score is of; it is stamped into files and the report.
        postures: what solves key postures instead of `solver`, such as one that remembers.

    Raises: AZeeError: the rig lacks what the score names, and `strict_body` is set; `clip-times`:
        too many frames.
        ValueError: an option has a wrong value or type.
    """
    from azee.animation import animate
    from azee.clip.resample import TooManyFramesError, frame_count
    from azee.lang.unshowable import beyond_frames
    from azee.score.recorded_motion import RecordingError

    _require_options(dominant, fps, mode, seed, life, rest, solver, timing, tempo)
    require_switch(precise, "precise")
    require_switch(strict_body, "strict_body")
    missing = lacks(score, rig, dominant, strict=strict_body)
    if missing and strict_body:
        raise AZeeError(*missing)
    try:
        frame_count(float(score.duration) / tempo, fps)
    except TooManyFramesError as error:
        hint = "give fewer --fps, or compile one --utterance at a time"
        raise AZeeError(Diagnostic("clip-times", str(error), None, help=hint)) from error
    side = _side(dominant)
    if postures is None and solver == "two-level":
        from azee.motion.keys.two_level import two_level_solver

        postures = two_level_solver(rig, side)
    try:
        animation = animate(
            score,
            rig,
            fps=rate(fps),
            dominant=side,
            mode=mode,
            seed=seed,
            life=life,
            rest=rest,
            precise=precise,
            solver=postures,
            timing=timing,
            tempo=float(tempo),
        )
    except RecordingError as error:
        raise AZeeError(Diagnostic(error.code, error.message, None, help=error.remedy)) from error
    animation = replace(animation, provenance=provenance)
    unshown = tuple(beyond_frames(animation.score, float(fps)))
    return Compilation(animation.score, rig, animation, missing, unshown)


def _require_options(
    dominant: object,
    fps: object,
    mode: object,
    seed: object,
    life: object,
    rest: object,
    solver: object,
    timing: object,
    tempo: object,
) -> None:
    """Raise ValueError for the first option with a wrong value or type."""
    from azee.motion.keys.rest import RESTS
    from azee.motion.tasks.key_selection import MODES
    from azee.motion.timing.performed import TIMINGS

    require_one_of(dominant, get_args(Hand), "dominant hand", "hands")
    require_one_of(mode, MODES, "mode", "modes")
    require_one_of(rest, RESTS, "rest", "rests")
    require_one_of(solver, get_args(Method), "solver", "solvers")
    if timing is not None:
        require_one_of(timing, TIMINGS, "timing", "timings")
    rate(fps)
    require_tempo(tempo)
    require_seed(seed)
    require_switch(life, "life")


def lacks(
    score: Score, rig: Rig, dominant: Hand = "right", *, strict: bool = False
) -> tuple[Diagnostic, ...]:
    """Return what a score names and a rig has not, each name once.

    Args: strict: as errors; else as warnings that tell how many constraints are left out.
    """
    from azee.score.score import Key, leaves
    from azee_solver.binding import BindingError
    from azee_solver.evaluate import evaluator

    binding = evaluator(rig, _side(dominant)).binding
    found: dict[str, list[BindingError]] = {}
    for leaf in leaves(score):
        for constraint in leaf.score.constraints if isinstance(leaf.score, Key) else ():
            try:
                binding.check(constraint)
            except BindingError as error:
                found.setdefault(error.name, []).append(error)
    return tuple(_lacking(errors, rig, strict=strict) for errors in found.values())


def _lacking(errors: Sequence[BindingError], rig: Rig, *, strict: bool) -> Diagnostic:
    first = errors[0]
    kind = first.code.removeprefix("rig-lacks-")
    place = first.origin
    written = (f"written at {place.file}:{place.line}:{place.column}",) if place else ()
    message = f"the rig `{rig.name}` has no {kind} `{first.text}`"
    if strict:
        return Diagnostic(first.code, message, None, notes=written)
    many = counted(len(errors), "constraint")
    message += f"; {many} with it left out"
    return Diagnostic(first.code, message, None, notes=written, severity=Severity.WARNING)


def source_of(text_or_path: str | Path | None) -> Source:
    """Return the text that `compile` is given, under the name by which it is reported.

    Raises: AZeeError: there is no such file.
    """
    from azee_grammar.files import TEXT_SUFFIXES, read_source
    from azee_grammar.source import Source

    if text_or_path is None:
        return Source("<none>", "")
    if isinstance(text_or_path, str):
        one_line = "\n" not in text_or_path.strip()
        if not (one_line and text_or_path.strip().endswith(TEXT_SUFFIXES)):
            return Source("<text>", text_or_path)
    return read_source(text_or_path)


def _side(hand: Hand) -> Side:
    from azee_solver.geometry import Side

    return {"right": Side.RIGHT, "left": Side.LEFT}[hand]
