"""The whole way from a text to files: `azee.compile`, and what it gives back."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.lang.program import Program
    from azee.motion.animate import Animation, Mode
    from azee.motion.clip import Clip
    from azee.motion.report import MotionReport
    from azee.score.score import Score
    from azee_grammar.source import Source
    from azee_rig.rig import Rig
    from azee_solver.binding import BindingError
    from azee_solver.geometry import Side

Hand = Literal["right", "left"]

TEXT_SUFFIXES = (".azee", ".az")


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
        with _writing(path), replace_file(path) as file:
            file.write(f"{data}\n".encode())

    def save(self, path: str | Path) -> None:
        """Write a file whose suffix names the format: one of `SUFFIXES`.

        Raises: ValueError: no format has that suffix. AZeeError: cannot-write.
        """
        write = _WRITERS.get(Path(path).suffix.lower())
        if write is None:
            raise ValueError(f"no format has the suffix of {path}; known are {' '.join(SUFFIXES)}")
        with _writing(path):
            write(self, Path(path))


def compile(  # noqa: A001 - azee.compile, as re.compile
    text_or_path: str | Path,
    rig: str | Path = "signer",
    *,
    expression: str | None = None,
    utterance: int | None = None,
    libraries: Sequence[str | Path] = (),
    dominant: Hand = "right",
    fps: float = 30.0,
    mode: Mode = "flat",
    seed: int = 0,
    life: bool = True,
) -> Compilation:
    """Compile AZee to a signing body.

    Args: text_or_path: a `Path`, or a text; a string of one line that ends in .azee or .az is
        taken for a path. rig: name of a rig that ships, or a rig's folder. expression: one to
        compile instead of the text's own utterances. utterance: number from 1 of the only one to
        compile; all play one after the other by default. libraries: folders that `use` looks in.
        dominant: the signer's strong hand. fps: frames per second. seed, life: of breathing and
        blinking, and whether there is any.
    Raises: AZeeError: the text is at fault, as its diagnostics tell.
        RigError: there is no such rig.
    """
    from azee.lang.program import load
    from azee_rig.load import load_rig

    program = load(_source(text_or_path), [Path(folder) for folder in libraries])
    score = score_of(program, expression, utterance, dominant)
    return perform(
        score, load_rig(rig), dominant=dominant, fps=fps, mode=mode, seed=seed, life=life
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
    mode: Mode = "flat",
    seed: int = 0,
    life: bool = True,
) -> Compilation:
    """Make a body play a score.

    Raises: AZeeError: the rig lacks what the score names.
    """
    from azee.motion.animate import animate

    if missing := lacks(score, rig, dominant):
        raise AZeeError(*missing)
    animation = animate(
        score, rig, fps=fps, dominant=_side(dominant), mode=mode, seed=seed, life=life
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


def save_score(score: Score, path: str | Path) -> None:
    """Draw a score as SVG. Raises: AZeeError: cannot-write."""
    from azee.export.score_svg import write_svg

    with _writing(path):
        write_svg(score, path)


def _source(text_or_path: str | Path) -> Source:
    from azee_grammar.files import read_source
    from azee_grammar.source import Source

    if isinstance(text_or_path, str):
        one_line = "\n" not in text_or_path.strip()
        if not (one_line and text_or_path.strip().endswith(TEXT_SUFFIXES)):
            return Source("<text>", text_or_path)
    return read_source(text_or_path)


def _side(hand: Hand) -> Side:
    from azee_solver.geometry import Side

    return {"right": Side.RIGHT, "left": Side.LEFT}[hand]


@contextmanager
def _writing(path: str | Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise AZeeError(cannot_write(path, error)) from error


def cannot_write(path: str | Path, error: OSError) -> Diagnostic:
    """Tell in the user's words why a file cannot be written."""
    folder = Path(path).parent
    if isinstance(error, FileNotFoundError):
        return Diagnostic("cannot-write", f"there is no folder `{folder}` for `{path}`", None)
    if isinstance(error, IsADirectoryError):
        return Diagnostic("cannot-write", f"`{path}` is a directory", None)
    if isinstance(error, NotADirectoryError):
        return Diagnostic(
            "cannot-write", f"cannot write `{path}`: `{folder}` is not a directory", None
        )
    if isinstance(error, PermissionError):
        return Diagnostic("cannot-write", f"no permission to write `{path}`", None)
    reason = error.strerror or type(error).__name__
    return Diagnostic("cannot-write", f"cannot write `{path}`: {reason.lower()}", None)


def _glb(made: Compilation, path: Path) -> None:
    from azee.export.glb import write_glb

    write_glb(made.clip, made.rig, path)


def _bvh(made: Compilation, path: Path) -> None:
    from azee.export.bvh import write_bvh

    write_bvh(made.clip, made.rig, path)


def _json(made: Compilation, path: Path) -> None:
    from azee.export.clip_json import write_json

    write_json(made.clip, made.rig, path)


def _svg(made: Compilation, path: Path) -> None:
    from azee.export.score_svg import write_svg

    write_svg(made.score, path)


def _png(made: Compilation, path: Path) -> None:
    from azee.export.storyboard import write_png

    write_png(made.clip, made.rig, path, made.animation.key_times)


_WRITERS: dict[str, Callable[[Compilation, Path], None]] = {
    ".glb": _glb,
    ".bvh": _bvh,
    ".json": _json,
    ".svg": _svg,
    ".png": _png,
}
SUFFIXES = tuple(_WRITERS)
"""Suffixes of the formats that a compilation can be saved in."""
