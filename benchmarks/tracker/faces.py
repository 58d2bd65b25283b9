"""Whether a tracker trained on people tells our facial rules apart, as a part of `bench-tracker`.

Every facial rule at its apex, and a face at rest, are drawn at five angles of the head. MediaPipe
finds 468 landmarks of the face in noisy pictures. Place, attitude and size of the head are taken
out of them, and what the face at rest shows at the same angle. More noise is added to these, and
the face is taken for the rule with the nearest landmarks, among all rules as found without noise
at all five angles; then, which is harder, at the four other angles.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.load import load_rig
from azee_rig.rig import Rig
from benchmarks.ik.elsewhere import NotThere
from benchmarks.likeness import PAGE, rewrite
from benchmarks.tracker.apexes import ANGLES_DEG, Pictures, apex, facial_rules, seen_at_angles
from benchmarks.tracker.environment import OUT, interpreter, look_for_faces

Floats = NDArray[np.float64]

COPIES = 5
"""Noisy pictures of every face at every angle."""
FITS = 3
"""So often the mean face is found anew."""
PICTURE_NOISE = 6.0
"""Deviation of every channel of every pixel, of 255: that of a camera indoors."""
MARK_NOISE = 0.0256
"""Deviation of landmarks of queries, of the distance of the eyes: two people who mark the same
face differ by 2.56 % (Kartynnik et al. 2019, table 1)."""
OUTER_CORNERS = (33, 263)
"""Of the eyes, among the landmarks."""
BEGIN, END = "<!-- faces: written by `benchmarks.tracker.faces --page` -->", "<!-- end of faces -->"


@dataclass(frozen=True, eq=False)
class Confusion:
    """How often each rule (row) was taken for each (column), (N, N), by `names`."""

    names: tuple[str, ...]
    taken: NDArray[np.int64]

    @property
    def right(self) -> float:
        """Share of all faces that were taken for what they are."""
        return float(np.trace(self.taken) / self.taken.sum())

    def lines(self) -> Iterator[str]:
        """Yield the lines of the table."""
        yield f"{'':<26}" + "".join(f"{n + 1:>3}" for n in range(len(self.names)))
        for n, (name, row) in enumerate(zip(self.names, self.taken, strict=True)):
            yield f"{n + 1:>3} {name:<22}" + "".join(f"{k or '·':>3}" for k in row)
        yield f"{100 * self.right:.1f} % of {self.taken.sum()} faces are taken for what they are"


def pictures(rig: Rig, names: Sequence[str], rng: np.random.Generator) -> Pictures:
    """Return noisy pictures of no face and of rules, ((1 + N) × angles × copies, H, W, 3)."""
    faces = [{}, *(apex(rig, name) for name in names)]
    drawn = np.concatenate([seen_at_angles(rig, face) for face in faces])
    copies = np.repeat(drawn, COPIES, axis=0)
    noisy = np.empty_like(copies)
    for n, picture in enumerate(copies):
        noisy[n] = np.clip(picture + rng.normal(0.0, PICTURE_NOISE, picture.shape), 0, 255)
    return noisy


def without_pose(marks: Floats, model: Floats) -> Floats:
    """Move, turn and scale faces (N, L, 3) onto a model (L, 3) by least squares.

    Umeyama 1991, equations 40 to 42. Mirror images are not considered.
    """
    centred = marks - marks.mean(axis=1, keepdims=True)
    goal = model - model.mean(axis=0)
    u, s, vt = np.linalg.svd(np.einsum("nli,lj->nij", centred, goal))
    sense = np.ones_like(s)
    sense[:, 2] = np.sign(np.linalg.det(u @ vt))
    turned = centred @ ((u * sense[:, None, :]) @ vt)
    scale = (s * sense).sum(axis=1) / (centred**2).sum(axis=(1, 2))
    return np.asarray(turned * scale[:, None, None])


def confusion(
    names: Sequence[str], marks: Floats, rng: np.random.Generator, *, other_angles: bool
) -> Confusion:
    """Take every face for the nearest that is known.

    Args: marks: of no face and of rules, (1 + N, angles, copies, L, 3); the first copies are
    known. other_angles: whether a face is compared with what is known at other angles only.
    """
    flat = marks.reshape(-1, *marks.shape[3:])
    model = flat[0]
    for _ in range(FITS):
        fitted = without_pose(flat, model)
        model = fitted.mean(axis=0)
    eyes = np.linalg.norm(np.subtract(*model[list(OUTER_CORNERS)]))
    noise = rng.normal(0.0, MARK_NOISE * eyes, fitted.shape)
    known = fitted.reshape(marks.shape)[:, :, 0]
    asked = without_pose(fitted + noise, model).reshape(marks.shape)[:, :, 1:] - known[:1, :, None]
    known = known - known[:1]
    taken = np.zeros((len(names), len(names)), dtype=np.int64)
    for rule, angle, copy in np.ndindex(asked[1:].shape[:3]):
        apart = ((known[1:] - asked[1 + rule, angle, copy]) ** 2).sum(axis=(2, 3))
        if other_angles:
            apart[:, angle] = np.inf
        taken[rule, np.unravel_index(apart.argmin(), apart.shape)[0]] += 1
    return Confusion(tuple(names), taken)


def landmarks(names: Sequence[str], rng: np.random.Generator) -> Floats:
    """Draw and track no face and rules, (1 + N, angles, copies, L, 3) in pixels.

    Raises: NotThere: there is no tracker, or it finds no face in a picture.
    """
    python, folder = interpreter(), OUT / "tracker"
    folder.mkdir(parents=True, exist_ok=True)
    seen, found = folder / "faces.npz", folder / "faces.npy"
    np.savez(seen, pictures=pictures(load_rig(), names, rng))
    look_for_faces(python, seen, found)
    marks: Floats = np.load(found)
    if unseen := int(np.isnan(marks[:, 0, 0]).sum()):
        raise NotThere(f"no face is found in {unseen} of {len(marks)} pictures")
    return marks.reshape(1 + len(names), len(ANGLES_DEG), COPIES, *marks.shape[1:])


def faces_told_apart() -> Iterator[str]:
    """Yield the lines of what is printed of faces.

    Raises: NotThere: there is no tracker.
    """
    rng, names = np.random.default_rng(0), [*facial_rules()]
    marks = landmarks(names, rng)
    yield "Compared with all angles"
    yield from confusion(names, marks, rng, other_angles=False).lines()
    yield ""
    yield "Compared with other angles only"
    yield from confusion(names, marks, rng, other_angles=True).lines()


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables; 1 if there is no tracker."""
    parser = argparse.ArgumentParser(prog="bench-tracker-faces", description=__doc__)
    parser.add_argument("--page", action="store_true", help=f"write the tables into {PAGE.name}")
    options = parser.parse_args(arguments)
    try:
        told = "\n".join(faces_told_apart())
    except NotThere as error:
        print(f"no tracker: {error}", file=sys.stderr)
        return 1
    print(told)
    if options.page:
        rewrite(PAGE, BEGIN, END, f"```\n{told}\n```")
    return 0


if __name__ == "__main__":
    sys.exit(main())
