"""Hands from few markers: errors, speed, bad markers, and letters that stay readable.

`python benchmarks/run.py capture --markers FILE [--people FILE.npz] [--evaluate FOLDER]`

FILE: a recording of a hand with all its markers, such as the optical set of hand_embodiment (BSD,
three clauses), of which tests/capture has a fifth; by default that fifth. --people: landmarks of
people's letters, as of `benchmarks.tracker.letters`. Letters are spelled by our signer, markers are
simulated at sites of its hand, and the joints of the hands that are made from them are named by a
classifier that has learnt from people alone, seen from three sides. It sees projected joints, not
pictures: no tracker is needed, and no picture can fool one.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np

from azee.capture.evaluation import evaluate
from azee.capture.evaluation_report import write_report
from azee.capture.hand import Hand, HandShape
from azee.capture.markers import Floats, Markers
from azee.capture.model import CaptureModel
from azee.capture.places import digit_markers, root_markers
from azee.capture.reading import read_markers
from azee.capture.reconstruction import Reconstruction, reconstruct
from azee.capture.root_frame import into_root
from azee.capture.training import choose, poses_of, train
from azee.clip.clip import Clip
from azee.compilation import perform, score_of
from azee.lang.program import load
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver import kinematics

ROOT = Path(__file__).parents[1]
SHIPPED = ROOT / "tests" / "capture" / "optical_markers.npz"
LEARNT = 0.7
NOISE_M, GAP_S, SWAPPED = 0.001, 0.5, 3
LEARNT_WORDS = ("AHOVCJQXELSZGNUBIPWDKRYFMT", "TYGBSKOWAENIVHQUMRXCLFDPZJ")
TESTED_WORD = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
MOVING = "JZ"
SIDES = ((-0.45, 0.1, 1.0), (0.0, 0.1, 1.0), (0.55, 0.1, 1.0))
"""Directions from the hand to the viewer, as of `benchmarks.tracker.letters`."""


def off(made: Reconstruction, truth: Floats, model: CaptureModel, *, fitted: bool) -> Floats:
    """How far markers on digits are off, (T, m) metres."""
    columns = model.columns(model.digits)
    at = made.fitted if fitted else made.foretold[:, columns]
    return np.asarray(np.linalg.norm(at - truth[:, columns], axis=-1))


def spoilt(markers: Markers, names: Sequence[str], how: str) -> Markers:
    """Return a recording with faults: gaps and swaps every two seconds, or noise."""
    at, rate = np.array(markers.positions), markers.rate_hz
    starts = range(round(rate), len(at) - round(rate), round(2 * rate))
    for n, start in enumerate(starts):
        a, b = (markers.names.index(names[(n + k) % len(names)]) for k in (0, 1))
        if how == "dropped":
            at[start : start + round(GAP_S * rate), a] = np.nan
        elif how == "root dropped":
            root = markers.names.index(root_markers(markers.names)[n % 3])
            at[start : start + round(GAP_S * rate), root] = np.nan
        elif how == "swapped":
            at[start : start + SWAPPED, [a, b]] = at[start : start + SWAPPED, [b, a]]
    if how == "noisy":
        spread = NOISE_M / np.sqrt(3.0)
        at += np.random.default_rng(1).normal(scale=spread, size=at.shape)
    return replace(markers, positions=at)


def report_of(markers: Markers, rig: Rig) -> None:
    """Print errors and speed on the last part, and what bad markers do."""
    border = round(LEARNT * len(markers.positions))
    first, last = markers.frames(slice(0, border)), markers.frames(slice(border, None))
    began = time.process_time()
    poses = poses_of([first], root_markers(markers.names))
    chosen = {count: choose(poses, count) for count in (6, 3)}
    model = train(poses, chosen[6], Hand(rig, "R"))
    print(f"chosen and trained in {time.process_time() - began:.1f} s of one core")
    truth = into_root(last.only(model.names), model.root).positions
    limits = rig.coordinates
    print("markers  unseen mm  fitted hand mm  unseen mm  recorded off mm  frames/s  beyond limits")
    for names in (chosen[6], chosen[3], model.digits):
        began = time.process_time()
        made = reconstruct(last, model, sparse=names)
        spent = time.process_time() - began
        hidden = [n not in names for n in model.digits]
        told, fit = (1000 * off(made, truth, model, fitted=f) for f in (False, True))
        beyond = int(((made.postures < limits.lower) | (made.postures > limits.upper)).sum())
        unseen = [np.nanmean(x[:, hidden]) if any(hidden) else np.nan for x in (told, fit)]
        print(
            f"{len(names):7}  {unseen[0]:9.2f}  {np.nanmean(fit):14.2f}  {unseen[1]:9.2f}  "
            f"{1000 * np.nanmean(made.off_m):15.2f}  {len(last.positions) / spent:8.0f}  {beyond:13}"
        )
    clean = reconstruct(last, model)
    print("bad markers       mean mm  change mm  largest jump of the change mm: foretold  fitted")
    for how in ("clean", "dropped", "root dropped", "swapped", "noisy"):
        found = reconstruct(spoilt(last, chosen[6], how), model)
        error = 1000 * np.nanmean(off(found, truth, model, fitted=True))
        changes = [found.foretold - clean.foretold, found.fitted - clean.fitted]
        jumps = [1000 * np.linalg.norm(np.diff(c, axis=0), axis=-1).max() for c in changes]
        change = 1000 * np.linalg.norm(changes[0], axis=-1).mean()
        print(f"{how:16}  {error:7.2f}  {change:9.2f}  {jumps[0]:37.2f}  {jumps[1]:6.2f}")


# Letters ------------------------------------------------------------------------------------------


def spelled(word: str, rig: Rig) -> Clip:
    """Return our signer's spelling of a word, 60 frames a second."""
    text = f"use 'asl\n:fingerspelling('text = \"{word}\", 'language = 'asl)"
    score = score_of(load(Source(word, text)), None, None)
    return perform(score, rig, life=False, fps=60.0).clip


def simulated(clip: Clip, hand: Hand, noise: int | None = None) -> Markers:
    """Return 13 markers on the hand of a clip: at sites of digits, and three on the palm's back."""
    shape = own_shape(hand)
    digits = hand.marker_positions(shape, clip.coordinates)
    palm = np.array([[0.03, 0.03, -0.015], [-0.03, 0.03, -0.015], [0.0, 0.08, -0.015]])
    frames = kinematics.frames(hand.body.chain, clip.coordinates)
    P, p = frames.rotations[:, hand.palm], frames.positions[:, hand.palm]
    local = np.concatenate([digits, np.tile(palm, (len(digits), 1, 1))], axis=1)
    at = np.einsum("tab,tmb->tma", P, local) + p[:, None]
    if noise is not None:
        at += np.random.default_rng(noise).normal(scale=NOISE_M / np.sqrt(3.0), size=at.shape)
    names = (*shape.markers, "hand_left", "hand_right", "hand_top")
    return Markers(names, at, 60.0, "simulated")


def own_shape(hand: Hand) -> HandShape:
    """The body's own hand with markers on tips and middles of all digits."""
    digits = ("thumb", "index", "middle", "ring", "little")
    names = [f"{digit}_{place}" for digit in digits for place in ("tip", "middle")]
    markers = {name: (place, hand.site(place)) for name, place in digit_markers(names).items()}
    return HandShape(hand.own_offsets, markers, np.eye(3), np.zeros(3))


def landmarks(rig: Rig, q: Floats, side: tuple[float, float, float]) -> Floats:
    """Project wrist, joints and tips of the right hand as seen from a side, (T, 21, 2), y down."""
    frames = kinematics.frames(rig.chain, q)
    points = [frames.positions[:, rig.bones["palm_R"].origin_node]]
    for digit in ("thumb", "index", "middle", "ring", "little"):
        points += [frames.positions[:, rig.bones[f"{digit}_R_{k}"].node] for k in (1, 2, 3)]
        points.append(rig.sites[f"{digit[0].upper()}_TIP_R"].point(frames))
    towards = np.array(side) / np.linalg.norm(side)
    across = np.cross([0.0, 1.0, 0.0], towards)
    across /= np.linalg.norm(across)
    up = np.cross(towards, across)
    at = np.stack(points, axis=1)
    return np.stack([-(at @ across), -(at @ up)], axis=-1)


def letters_report(people: Path, rig: Rig) -> None:
    """Print how many letters are read in two views of three, from the hand and from its markers."""
    from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

    with np.load(people) as data:
        letters = data["letter"]
        still = ~np.isin(letters, tuple(MOVING))
        seen, letters = data["landmarks"][still, :, :2].astype(float), letters[still]
    reader = LinearDiscriminantAnalysis(solver="lsqr", shrinkage="auto")
    reader.fit(features(seen * [4.0 / 3.0, 1.0]), letters)
    hand = Hand(rig, "R")
    known = [simulated(spelled(word, rig), hand) for word in LEARNT_WORDS]
    clip = spelled(TESTED_WORD, rig)
    tested = simulated(clip, hand, noise=2)
    poses = poses_of(known, root_markers(known[0].names))
    holds = {
        label.text[-1]: (label.start_s + label.end_s) / 2.0
        for label in clip.labels
        if label.text.startswith("letter-")
    }
    rows = {x: int(np.abs(clip.times - at).argmin()) for x, at in holds.items()}
    print("letters          read  of the signer's own  angle off °  not read")
    own: set[str] = set()
    for count in (None, 6, 3):
        q, name = clip.coordinates, "the signer's hand"
        if count is not None:
            model = train(poses, choose(poses, count), hand)
            q, name = np.array(q), f"{count} of 10 markers"
            q[:, hand.columns] = reconstruct(tested, model).postures[:, hand.columns]
        held = q[[rows[x] for x in sorted(rows) if x not in MOVING]]
        names = [x for x in sorted(rows) if x not in MOVING]
        views = [reader.predict(features(landmarks(rig, held, side))) for side in SIDES]
        read = {x for x, *v in zip(names, *views, strict=True) if v.count(x) >= 2}
        own = own or read
        wrong = np.degrees(np.abs(q - clip.coordinates)[:, hand.columns].mean())
        lost = "".join(sorted(set(names) - read))
        print(
            f"{name:17} {len(read):3}  {len(read & own):6} of {len(own):3}  {wrong:16.1f}  {lost}"
        )


def features(hands: Floats) -> Floats:
    """Landmarks in lengths of the palm, and distances: as `benchmarks.tracker.read_letters`."""
    hands = hands - hands[:, :1]
    size = np.linalg.norm(hands[:, 9], axis=-1) + np.linalg.norm(
        hands[:, 5] - hands[:, 17], axis=-1
    )
    hands = hands / size[:, None, None]
    pairs = [*((4, k) for k in (5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20))]
    pairs += combinations((4, 8, 12, 16, 20), 2)
    apart = [np.linalg.norm(hands[:, i] - hands[:, j], axis=-1) for i, j in pairs]
    return np.concatenate([hands[:, 1:].reshape(len(hands), -1), np.stack(apart, -1)], -1)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print everything that was asked for."""
    parser = argparse.ArgumentParser(prog="capture", description=__doc__)
    parser.add_argument("--markers", type=Path, default=SHIPPED, metavar="FILE")
    parser.add_argument("--people", type=Path, metavar="FILE.npz")
    parser.add_argument("--evaluate", type=Path, metavar="FOLDER")
    options = parser.parse_args(arguments)
    rig = load_rig("signer")
    markers = read_markers(options.markers)
    if options.people is None or options.markers != SHIPPED:
        report_of(markers, rig)
    if options.evaluate is not None:
        options.evaluate.mkdir(exist_ok=True)
        found = evaluate(poses_of([markers], root_markers(markers.names)))
        print(*write_report(found, options.evaluate), sep="\n")
    if options.people is not None:
        letters_report(options.people, rig)


if __name__ == "__main__":
    main()
