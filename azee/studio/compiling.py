"""A text on its way to a moving body, in steps that a page shows as they come.

First mistakes and score, then key postures as they are found, then the movement, then the report.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from azee.studio.framing import Header
from azee.studio.job import Job
from azee.studio.marks import marks
from azee.studio.postures import Postures
from azee.studio.score_rows import score_rows
from azee_grammar.diagnostic import AZeeError, Diagnostic, Severity
from azee_grammar.render import to_json
from azee_grammar.source import Source
from azee_solver.geometry import Side

if TYPE_CHECKING:
    from azee.compilation import Compilation
    from azee.lang.program import Program
    from azee.posing.text import PosedText
    from azee.score.score import Score

LONGEST_S = 300
"""Of signing in one movement; longer texts are compiled an utterance at a time."""

Answer = tuple[Header, bytes]


class SupersededError(Exception):
    """A newer text has come: this one is of no use any more."""


@dataclass(slots=True)
class Watch:
    """How long the steps took, milliseconds."""

    _since: float = field(default_factory=time.perf_counter)
    _spent: float = field(default_factory=time.process_time)
    laps: dict[str, float] = field(default_factory=dict)

    def lap(self, name: str) -> None:
        """Note the time since the last lap."""
        now = time.perf_counter()
        self.laps[name] = round(1e3 * (now - self._since), 1)
        self._since = now

    @property
    def processor(self) -> float:
        """Processor time of all steps so far: other programs change it little."""
        return round(1e3 * (time.process_time() - self._spent), 1)


def compiled(
    job: Job,
    root: Path,
    libraries: Sequence[Path],
    check: Callable[[], None],
    postures: Postures,
) -> Iterator[Answer]:
    """Yield the answers to a job, each as soon as it is known.

    `score`: `diagnostics`, `blocks`; if there are mistakes it is the last. `clip`: a web clip, with
    `blocks` as performed, `lead_s` and times. `report`: what became of each constraint.

    Args: root: the folder that the text is in. check: raises `SupersededError` if nobody wants the
        answers any more; called between steps, and before every posture that is solved. postures:
        the solvers, which remember what they solved for the text before.
    """
    watch = Watch()
    name = str(root / job.file)
    found, score, program = evaluated(job, root, libraries)
    watch.lap("evaluate")
    yield (
        {
            "kind": "score",
            "number": job.number,
            "diagnostics": [to_json(d) for d in found],
            "blocks": [] if score is None else score_rows(score, name),
            "ms": watch.laps["evaluate"],
        },
        b"",
    )
    if score is None:
        return
    check()
    made = performed(job, score, program, check, postures)
    watch.lap("perform")
    yield _clip(job, made, name, watch)
    check()
    yield _report(job, made), b""


def evaluated(
    job: Job, root: Path, libraries: Sequence[Path]
) -> tuple[tuple[Diagnostic, ...], Score | None, Program]:
    """Return mistakes and warnings, and the score where there is no mistake."""
    from azee.compilation import score_of
    from azee.lang.program import load

    path = root / job.file
    program = load(Source(str(path), job.text), libraries, place=path)
    try:
        score = score_of(program, job.expression, None, job.dominant)
        warnings = program.check() if job.expression is None else ()
        if score.duration > LONGEST_S * job.tempo:
            message = f"the text is longer than {LONGEST_S} s of signing"
            hint = "compile it in parts, or with `azee compile`"
            raise AZeeError(Diagnostic("clip-times", message, None, help=hint))
    except AZeeError as error:
        return error.diagnostics, None, program
    return tuple(d for d in warnings if d.severity is Severity.WARNING), score, program


def performed(
    job: Job,
    score: Score,
    program: Program,
    check: Callable[[], None],
    postures: Postures,
) -> Compilation:
    """Return the movement of a score. Raises: what `check` raises. AZeeError."""
    from azee.compilation import perform
    from azee.lang.provenance import provenance_of, written
    from azee_rig.load import load_rig

    rig = load_rig(job.rig)
    return perform(
        score,
        rig,
        dominant=job.dominant,
        fps=job.fps,
        life=job.life,
        rest=job.rest,
        precise=job.precise,
        tempo=job.tempo,
        provenance=provenance_of(written(program, job.expression, None)),
        postures=postures.solver(rig, side_of(job), job.precise, check),
    )


def posed(
    job: Job, root: Path, libraries: Sequence[Path], postures: Postures
) -> tuple[PosedText, Compilation]:
    """Return a text to be posed, and its movement. Raises: AZeeError: the text has mistakes."""
    from azee.blocks.document import Document
    from azee.posing.text import PosedText

    found, score, program = evaluated(job, root, libraries)
    if score is None:
        raise AZeeError(*found)
    path = root / job.file
    document = Document.of(job.text, str(path))
    text = PosedText(document, tuple(libraries), None, job.dominant, path)
    return text, performed(job, score, program, lambda: None, postures)


def side_of(job: Job) -> Side:
    """Return the side of the signer's strong hand."""
    return Side.RIGHT if job.dominant == "right" else Side.LEFT


def _clip(job: Job, made: Compilation, name: str, watch: Watch) -> Answer:
    from azee.export.formats.web_clip import web_clip

    head: dict[str, Any] = {
        "kind": "clip",
        "number": job.number,
        "blocks": score_rows(made.score, name),
        "lead_s": made.animation.lead_s,
        "key_times": [round(t, 4) for t in made.animation.key_times],
        "diagnostics": [to_json(d) for d in (*made.left_out, *made.unshown)],
    }
    payload = web_clip(made.clip, made.rig)
    watch.lap("encode")
    head |= {"ms": watch.laps, "processor_ms": watch.processor}
    return head, payload


def _report(job: Job, made: Compilation) -> Header:
    report = made.report
    fields = (
        *("path", "kind", "subject", "target", "start_s", "end_s", "residual", "unit"),
        *("tolerance", "outcome", "reason", "price"),
    )
    rows = [
        {name: row[name] for name in fields} for row in (c.as_json() for c in report.constraints)
    ]
    clip, lead_s = made.clip, made.animation.lead_s
    return {
        "kind": "report",
        "number": job.number,
        "constraints": rows,
        "marks": marks(made.score, clip, made.rig, side_of(job), lead_s),
        "stretched": [s.as_json() for s in report.stretched],
        "limits": {"max_excess_rad": report.max_excess_rad, "joint": report.excess_joint},
        "provenance": made.provenance.as_json() if made.provenance else None,
    }


def still(
    job: Job,
    root: Path,
    libraries: Sequence[Path],
    size: tuple[int, int],
    check: Callable[[], None],
    postures: Postures,
) -> bytes:
    """Return a picture (PNG) of a posture in the middle of a job.

    Raises: AZeeError: the text has mistakes. And what `check` raises.
    """
    import io

    from azee.export.pictures.picture import picture

    found, score, program = evaluated(job, root, libraries)
    if score is None:
        raise AZeeError(*found)
    made = performed(job, score, program, check, postures)
    check()
    clip = made.clip
    blocks = made.animation.key_times
    inside = [t for t in blocks if t >= made.animation.lead_s] or [clip.duration_s / 2]
    frame = int(np.abs(clip.times - inside[len(inside) // 2]).argmin())
    weights = dict(zip(clip.units, clip.unit_weights[frame], strict=True))
    data = io.BytesIO()
    image = picture(made.rig, clip.coordinates[frame], "front", weights, size)
    image.save(data, "PNG", optimize=True)
    return data.getvalue()
