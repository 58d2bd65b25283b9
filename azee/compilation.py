"""The whole way from a text to files: `azee.compile`, and what it gives back."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from azee.formats import WRITERS, write_elan, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.animation import Animation
    from azee.clip.clip import Clip
    from azee.lang.program import Program
    from azee.motion.tasks.key_selection import Mode
    from azee.quality.motion_report import MotionReport
    from azee.score.score import Score
    from azee_grammar.source import Source
    from azee_rig.rig import Rig
    from azee_solver.binding import BindingError
    from azee_solver.geometry import Side

Hand = Literal["right", "left"]
Method = Literal["grouped", "two-level"]


@dataclass(frozen=True, eq=False)
class Compilation:
    """A score, the body that plays it, the motion, and what the motion is worth."""

    score: Score
    rig: Rig
    animation: Animation

    @property
    def clip(self) -> Clip:
        """The motion: coordinates and face weights over time."""
        return self.animation.clip

    @property
    def report(self) -> MotionReport:
        """Every constraint with its residual, limits and penetration."""
        return self.animation.report

    def save_report(self, path: str | Path) -> None:
        """Write the report as JSON, as docs/formats.md describes it.

        Raises: AZeeError: cannot-write.
        """
        from azee.export.files import replace_file

        data = json.dumps(self.report.as_json(), indent=2, ensure_ascii=False, allow_nan=False)
        with writing(path), replace_file(path) as file:
            file.write(f"{data}\n".encode())

    def save(self, path: str | Path, *, media: str | Path | None = None) -> None:
        """Write a file whose suffix names the format: one of `SUFFIXES` or `FILM_SUFFIXES`.

        Args: media: the film that an ELAN file (.eaf) is to show beside the score.
        Raises: ValueError: no format has that suffix. AZeeError: cannot-write, not-installed.
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
    text_or_path: str | Path,
    rig: str | Path = "signer",
    *,
    expression: str | None = None,
    utterance: int | None = None,
    libraries: Sequence[str | Path] = (),
    dominant: Hand = "right",
    fps: float = 30.0,
    mode: Mode = "tracks",
    seed: int = 0,
    life: bool = True,
    solver: Method = "grouped",
) -> Compilation:
    """Compile AZee to a signing body.

    Args: text_or_path: a `Path`, or a text; a string of one line that ends in .azee or .az is
        taken for a path. rig: name of a rig that ships, or a rig's folder. expression: one to
        compile instead of the text's own utterances. utterance: number from 1 of the only one to
        compile; all play one after the other by default. libraries: folders that `use` looks in.
        dominant: the signer's strong hand. fps: frames per second. seed, life: of breathing and
        blinking, and whether there is any. solver: how postures are found; two-level is the method
        of Nunnari et al. 2018, for comparison.
    Raises: AZeeError: the text is at fault, as its diagnostics tell.
        RigError: there is no such rig.
    """
    from azee.lang.program import load
    from azee_rig.load import load_rig

    program = load(_source(text_or_path), [Path(folder) for folder in libraries])
    score = score_of(program, expression, utterance, dominant)
    return perform(
        score,
        load_rig(rig),
        dominant=dominant,
        fps=fps,
        mode=mode,
        seed=seed,
        life=life,
        solver=solver,
    )


def score_of(
    program: Program, expression: str | None, utterance: int | None, dominant: Hand = "right"
) -> Score:
    """Return the score of an expression, else of one utterance, else of all in sequence.

    Raises: AZeeError: all that is wrong with the text.
    """
    if expression is not None:
        return program.evaluate(expression).score
    return program.score(utterance, _side(dominant))


def perform(
    score: Score,
    rig: Rig,
    *,
    dominant: Hand = "right",
    fps: float = 30.0,
    mode: Mode = "tracks",
    seed: int = 0,
    life: bool = True,
    solver: Method = "grouped",
) -> Compilation:
    """Make a body play a score.

    Raises: AZeeError: the rig lacks what the score names, or `clip-times`: too many frames.
    """
    from azee.animation import animate
    from azee.clip.resample import TooManyFramesError, frame_count

    if missing := lacks(score, rig, dominant):
        raise AZeeError(*missing)
    if math.isfinite(fps) and fps > 0:
        try:
            frame_count(float(score.duration), fps)
        except TooManyFramesError as error:
            hint = "give fewer --fps, or compile one --utterance at a time"
            raise AZeeError(Diagnostic("clip-times", str(error), None, help=hint)) from error
    side = _side(dominant)
    postures = None
    if solver == "two-level":
        from azee.motion.keys.two_level import two_level_solver

        postures = two_level_solver(rig, side)
    animation = animate(
        score, rig, fps=fps, dominant=side, mode=mode, seed=seed, life=life, solver=postures
    )
    return Compilation(score, rig, animation)


def lacks(score: Score, rig: Rig, dominant: Hand = "right") -> tuple[Diagnostic, ...]:
    """Return what a score names and a rig has not, each name once."""
    from azee.score.score import Key, leaves
    from azee_solver.binding import Binding, BindingError

    binding = Binding(rig, _side(dominant))
    found: dict[str, Diagnostic] = {}
    for leaf in leaves(score):
        for constraint in leaf.score.constraints if isinstance(leaf.score, Key) else ():
            try:
                binding.check(constraint)
            except BindingError as error:
                found.setdefault(error.name, _lacking(error, rig))
    return tuple(found.values())


def _lacking(error: BindingError, rig: Rig) -> Diagnostic:
    kind = error.code.removeprefix("rig-lacks-")
    place = error.origin
    written = (f"written at {place.file}:{place.line}:{place.column}",) if place else ()
    message = f"the rig `{rig.name}` has no {kind} `{error.name}`"
    return Diagnostic(error.code, message, None, notes=written)


def _source(text_or_path: str | Path) -> Source:
    from azee_grammar.files import TEXT_SUFFIXES, read_source
    from azee_grammar.source import Source

    if isinstance(text_or_path, str):
        one_line = "\n" not in text_or_path.strip()
        if not (one_line and text_or_path.strip().endswith(TEXT_SUFFIXES)):
            return Source("<text>", text_or_path)
    return read_source(text_or_path)


def _side(hand: Hand) -> Side:
    from azee_solver.geometry import Side

    return {"right": Side.RIGHT, "left": Side.LEFT}[hand]
