"""Doing a task: solving once, then writing all variations. This is what a worker runs."""

from __future__ import annotations

import gc
import itertools
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from azee.animation import default_solver
from azee.batch.record import Record, failure, keep_record, kept_record, passing, record_path
from azee.batch.task import Task, body_of
from azee.batch.variation import Variation, varied
from azee.batch.version import installed_version
from azee.compilation import Compilation, perform
from azee.export.files import remove_parts
from azee.formats import CAMERA_WRITERS, Seen, films_drawn_by, writing
from azee.lang.program import Program, load
from azee.lang.provenance import provenance_of, written
from azee.motion.overlay.seed import seed_of
from azee.motion.timing.remembering import RememberingSolver
from azee.score.score import Score
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.render import to_json
from azee_rig.load import RigError, load_rig
from azee_solver.geometry import Side


def work(task: Task, out: Path) -> Record:
    """Do a task, unless it is done; return its record, which is also kept beside its files.

    What is wrong with the text is in the record, under `error`. What is wrong with the machine
    (a full disk, another version) is too, with `passing`, but such a record is not kept: the next
    run tries again. Nothing is raised.
    """
    try:
        return kept_record(out, task) or _done(task, out)
    except AZeeError as error:
        return passing(task, [to_json(d) for d in error.diagnostics])
    except (OSError, RigError) as error:
        return passing(task, [failure(str(error))])
    except Exception as error:
        # A fault of ours: one text never stops the others. The manifest has what is to be reported.
        told = f"azee failed: {type(error).__name__}: {error}"
        return passing(task, [failure(told, traceback.format_exc().splitlines())])


def _done(task: Task, out: Path) -> Record:
    began = time.perf_counter()
    _require_same(task)
    folder = out / task.text.name
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        for path in (record_path(out, task), *(out / name for name in _file_names(task))):
            remove_parts(path)
    try:
        record = _compiled(task, out)
    except _FaultyTextError as fault:
        record = {"key": task.key, "error": [to_json(d) for d in fault.diagnostics]}
    for row in record.get("rows", ()):
        row["seconds"]["task"] = round(time.perf_counter() - began, 4)
    with writing(folder):
        keep_record(out, task, record)
    return record


class _FaultyTextError(Exception):
    """The text is at fault, on every machine and in every run."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__(*diagnostics)
        self.diagnostics = diagnostics


def _compiled(task: Task, out: Path) -> Record:
    """Solve a text, and write its variations. Raises: _FaultyTextError. AZeeError. OSError."""
    rig, options = load_rig(task.body.place), task.options
    score, program = _evaluated(task)
    solver = RememberingSolver(default_solver(rig, Side.RIGHT, options.precise))
    provenance = provenance_of(written(program, None, task.text.utterance))
    rows: list[dict[str, Any]] = []
    outcome: dict[str, Any] = {}
    for seed in options.seeds:
        began = time.perf_counter()
        number = seed_of(score) if seed is None else seed  # which is that of `perform`, too
        try:
            made = perform(
                score,
                rig,
                fps=options.fps,
                seed=number,
                life=options.life,
                rest=options.rest,
                precise=options.precise,
                timing=options.timing,
                tempo=options.tempo,
                provenance=provenance,
                postures=solver,
            )
        except AZeeError as error:
            raise _FaultyTextError(*error.diagnostics) from error
        outcome = outcome or _outcome(made)
        took_s = time.perf_counter() - began
        for hand, speed in itertools.product(options.hands, options.speeds):
            variation = Variation(hand, seed, speed)
            for row in _written(task, out, varied(made, variation), variation):
                row |= {"seed": number}
                row["seconds"]["solve"] = round(took_s, 4)
                rows.append(row)
    return {"key": task.key, "outcome": outcome, "rows": rows}


def _evaluated(task: Task) -> tuple[Score, Program]:
    """Return a score, and its program. Raises: _FaultyTextError: all that is wrong with it."""
    text = task.text
    if text.fault is not None:
        raise _FaultyTextError(text.fault)
    place = None if text.folder is None else text.folder / Path(text.source.name).name
    try:
        program = load(text.source, task.libraries, place=place)
        if text.utterance is None:
            return program.score(), program
        return program.score_alone(text.utterance), program
    except AZeeError as error:
        raise _FaultyTextError(*error.diagnostics) from error


def _outcome(made: Compilation) -> dict[str, Any]:
    """Return what the manifest says of a text on a body, whichever variation it is."""
    report = made.report
    counts = Counter(result.outcome.value for result in report.constraints)
    return {
        "met": counts["met"],
        "eased": counts["eased"],
        "missed": counts["missed"],
        "self_contact": len({found.pair for found in report.self_contact}),
        "warnings": [to_json(d) for d in (*made.left_out, *made.unshown)],
    }


def _written(
    task: Task, out: Path, made: Compilation, variation: Variation
) -> Iterator[dict[str, Any]]:
    """Write the files of one variation; yield a row a camera.

    Raises: AZeeError: cannot-write, not-installed.
    """
    options = task.options
    drawn_by = films_drawn_by(options.formats, options.renderer)
    began = time.perf_counter()
    files = {}
    for suffix in options.formats:
        if suffix not in CAMERA_WRITERS:
            files[suffix[1:]] = name = _file_name(task, variation, "", suffix)
            made.save(out / name)
    shared_s = time.perf_counter() - began
    for camera in options.cameras or (None,):
        began = time.perf_counter()
        seen = {}
        for suffix in options.formats:
            if camera is not None and suffix in CAMERA_WRITERS:
                seen[suffix[1:]] = name = _file_name(task, variation, camera, suffix)
                with writing(out / name):
                    view = Seen(camera, options.fps, drawn_by or "software")
                    CAMERA_WRITERS[suffix](made.clip, made.rig, out / name, view)
        yield {
            "hand": variation.hand,
            "speed": variation.speed,
            "camera": camera,
            "renderer": drawn_by,
            "fps": options.fps,
            "frames": len(made.clip.times),
            "duration_s": round(made.clip.duration_s, 6),
            "labels": [
                {"path": [*x.path], "start_s": round(x.start_s, 6), "end_s": round(x.end_s, 6)}
                for x in made.clip.labels
            ],
            "files": {**files, **seen},
            "seconds": {"write": round(shared_s + time.perf_counter() - began, 4)},
        }


def _file_names(task: Task) -> Iterator[str]:
    """Yield the names of all files that a task writes."""
    options = task.options
    for hand, seed, speed in itertools.product(options.hands, options.seeds, options.speeds):
        for suffix in options.formats:
            for camera in options.cameras if suffix in CAMERA_WRITERS else ("",):
                yield _file_name(task, Variation(hand, seed, speed), camera, suffix)


def _file_name(task: Task, variation: Variation, camera: str, suffix: str) -> str:
    """Return the name of a file, from the folder of outputs: what may vary is in it."""
    options = task.options
    parts = [task.body.name]
    if options.hands != ("right",):
        parts.append(variation.hand)
    if options.seeds != (None,):
        parts.append("score" if variation.seed is None else f"seed{variation.seed}")
    if options.speeds != (1.0,):
        parts.append(f"x{variation.speed:g}")
    if camera:
        parts.append(camera.replace(" ", "_"))
    return f"{task.text.name}/{'-'.join(parts)}{suffix}"


def _require_same(task: Task) -> None:
    """Refuse a task that this process would do otherwise. Raises: AZeeError: cannot-read."""
    if (mine := installed_version()) != task.version:
        message = f"a worker has azee {mine}, and the batch is of {task.version}"
        raise AZeeError(
            Diagnostic("cannot-read", message, None, help="install the same everywhere")
        )
    if body_of(task.body.place).digest != task.body.digest:
        message = f"the body `{task.body.place}` of a worker is not that of the batch"
        raise AZeeError(Diagnostic("cannot-read", message, None))


def prepare() -> None:
    """Let a process that does nothing but tasks look for garbage less often."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
