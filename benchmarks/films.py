"""Draws a film by our rasteriser and by OpenGL in one run: frames a second, and how far apart.

`python benchmarks/run.py films [--frames N] [--size WIDTHxHEIGHT] [--rounds N]`. Frames are drawn
and not encoded, which takes both the same time. The renderers take turns, and each row is the
median of its rounds. The first frames of a round fill the line of threads and count only as the
time to the first picture, in which OpenGL makes its context and compiles its shaders.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.compilation import perform, score_of
from azee.export.pictures.opengl.context import NoOpenGLError
from azee.export.pictures.renderer import Renderer, resolved
from azee.export.pictures.scene import MOST_THREADS, Look, Scene
from azee.lang.program import load
from azee_grammar.files import read_source
from azee_rig.load import load_rig

SENTENCE = Path(__file__).parents[1] / "examples" / "person-aged-52" / "person-aged-52.azee"
SHOTS = ("front", "face", "hands")
FAR = 16
"""Pixels that differ in a colour by more, of 255, are counted."""


@dataclass(frozen=True, slots=True)
class Round:
    """One drawing of the film: seconds to the first picture, frames a second, and of processor."""

    first_s: float
    rate: float
    processor_s: float


@dataclass(frozen=True, slots=True)
class Apart:
    """How far pictures of two renderers are apart, of 255, and the share of pixels beyond FAR."""

    mean: float
    far: float


def drawn(scene: Scene, indices: Sequence[int]) -> tuple[Round, list[NDArray[np.uint8]]]:
    """Draw frames; those that threads have at hand when the first is ready are not measured."""
    begin = min(2 * min(MOST_THREADS, os.cpu_count() or 1) + 2, len(indices) - 1)
    pictures = []
    ready_s, spent_s = [], []  # by the clock and of the processor, when each picture is there
    began = time.perf_counter()
    for picture in scene.frames(indices):
        pictures.append(picture)
        ready_s.append(time.perf_counter() - began)
        spent_s.append(time.process_time())
    count = len(indices) - begin
    rate = count / (ready_s[-1] - ready_s[begin - 1])
    return Round(ready_s[0], rate, (spent_s[-1] - spent_s[begin - 1]) / count), pictures


def apart(ours: Sequence[NDArray[np.uint8]], theirs: Sequence[NDArray[np.uint8]]) -> Apart:
    """Compare pictures of the same frames."""
    errors = [np.abs(a.astype(int) - b) for a, b in zip(ours, theirs, strict=True)]
    far = [(error.max(axis=2) > FAR).mean() for error in errors]
    return Apart(float(np.mean(errors)), float(np.mean(far)))


def main(arguments: Sequence[str]) -> None:
    """Print a row for each camera and renderer, and how far their pictures are apart."""
    parser = argparse.ArgumentParser("benchmarks/run.py films", description=__doc__)
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args(arguments)
    if options.frames < 2:
        parser.error("a rate needs two frames or more")
    width, height = (int(side) for side in options.size.split("x"))

    renderers: list[Renderer] = ["software"]
    try:
        theirs, name = resolved("opengl")
        renderers.append(theirs)
        print(name)
    except NoOpenGLError as error:
        print(f"{error}; {error.remedy}")
    rig = load_rig()
    clip = perform(score_of(load(read_source(SENTENCE)), None, None), rig).clip
    indices = np.linspace(0, len(clip.times) - 1, options.frames).astype(int).tolist()
    print(f"{options.frames} frames of {SENTENCE.stem}, {width} × {height}, {os.cpu_count()} cores")
    print(f"{'camera':<8}{'renderer':<12}{'first':>10}{'frames/s':>12}{'processor':>12}")
    for shot in SHOTS:
        look = Look((width, height), (shot,), captions=False)
        rounds: dict[Renderer, list[Round]] = {renderer: [] for renderer in renderers}
        pictures = {}
        for _ in range(options.rounds):
            for renderer in renderers:
                scene = Scene(clip, rig, replace(look, renderer=renderer))
                found, pictures[renderer] = drawn(scene, indices)
                rounds[renderer].append(found)
        for renderer, done in rounds.items():
            first, rate, processor = (
                statistics.median(getattr(one, name) for one in done)
                for name in ("first_s", "rate", "processor_s")
            )
            times = f"{first:>8.2f} s{rate:>12.1f}{1000 * processor:>9.0f} ms"
            print(f"{shot:<8}{renderer:<12}{times}")
        if len(renderers) == 2:
            found_apart = apart(pictures["software"], pictures["opengl"])
            print(
                f"{shot:<8}apart by {found_apart.mean:.4f} of 255 in the mean; "
                f"{100 * found_apart.far:.4f} % of the pixels by more than {FAR}"
            )
