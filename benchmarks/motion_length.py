"""Measures how the time of motion grows with the length of a text.

`python benchmarks/motion_length.py` plays 1, 10 and 100 signs in sequence, each with a path, a palm
that holds its direction, a head shake and a facial block. It prints seconds per sign, with the
solver's share.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Sequence
from fractions import Fraction

from azee.animation import animate
from azee.score.interval import Interval
from azee.score.score import Arrangement, Block, Group, Key, Score
from azee_rig.load import load_rig
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
)
from azee_solver.geometry import (
    Bone,
    NamedPoint,
    Opp,
    Out,
    Side,
    SigningSpace,
    Site,
    Straight,
    Vec,
    VTranslate,
)

TIP = Site("I_TIP", Side.STRONG)


def block(name: str, start: str, length: str, *constraints: Constraint) -> Block:
    span = Interval(Fraction(start), Fraction(start) + Fraction(length))
    return Block(name, span, Key(span.duration, constraints=constraints))


def sign(n: int) -> Group:
    """Return a sign of one second; each sign has slightly different places."""
    across = -0.12 + 0.02 * (n % 7)

    def place(height: float) -> Place:
        return Place(TIP, VTranslate(NamedPoint(SigningSpace.MSSP), Vec(across, height, 0.0)))

    palm = Orient(BoneAxis.NRM, Bone("palm", Side.STRONG), Relation.ALONG, Opp(Out(Side.STRONG)))
    shake = Rotate(Bone("head"), Vec(0, 1, 0), math.radians(12))
    return Group(
        Fraction(1),
        blocks=(
            block("START", "0", ".2", place(0.1)),
            block("MOVE", ".2", ".6", Transpath(TIP, Straight())),
            block("END", ".8", ".2", place(-0.05)),
            block("PALM", "0", "1", palm),
            block("SHAKE", ".4", ".2", shake),
            block("FACE", "0", "1", Morph("AU1", None, 0.6)),
        ),
    )


def text(signs: int) -> Score:
    """Return signs in sequence, .3 s apart."""
    blocks, start = [], Fraction(0)
    for n in range(signs):
        blocks.append(Block(str(n + 1), Interval(start, start + 1), sign(n)))
        start += Fraction(13, 10)
    return Group(start - Fraction(3, 10), arrangement=Arrangement.SEQ, blocks=tuple(blocks))


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("signs", nargs="*", type=int, default=[1, 10, 100])
    rig = load_rig()
    animate(text(1), rig)
    print("signs  clip s  keys  solves  solving ms/sign  motion ms/sign  unmet")
    for signs in parser.parse_args(arguments).signs:
        began = time.perf_counter()
        animation = animate(text(signs), rig)
        whole, solving = time.perf_counter() - began, animation.report.solve_s
        postures = animation.report.postures
        print(
            f"{signs:5d} {animation.clip.times[-1]:7.1f} {len(postures):5d} "
            f"{sum(not p.reused for p in postures):7d} {1e3 * solving / signs:16.1f} "
            f"{1e3 * (whole - solving) / signs:15.1f} "
            f"{sum(not c.met for c in animation.report.constraints):6d}"
        )


if __name__ == "__main__":
    main()
