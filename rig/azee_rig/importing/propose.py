"""Proposes a bones-map: from the names of the joints, else from the shape of the skeleton."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.bone_map import DIGITS, LEGS, SIDES, BoneMap
from azee_rig.importing.names import Reading, read_name, read_names
from azee_rig.importing.shape import read_shape
from azee_rig.importing.skeleton_tree import Tree

Floats = NDArray[np.float64]
Finds = dict[str, list[int]]
"""Joints by AZee bone, proximal first."""

BACK_2_AT = 0.38
"""Part of the way from the lowest joint of the spine to the neck from which it is back_2."""
METACARPAL_AT = 0.45
"""A joint that is nearer to the wrist than this share of its child's distance lies in the palm."""
ONE_PLACE = 1e-3
"""Joints that are nearer, as a share of their distance from the wrist, are in one place."""
FINGERS = DIGITS[1:]
ABOVE_SHOULDERS = ("head", "neck", "spine", "eye", "")
"""What the head of a figure may be called. One that is called a finger is part of a hand, which
has the shape of a figure too."""


def propose(
    tree: Tree, told: Mapping[str, int] | None = None, carried: Floats | None = None
) -> BoneMap:
    """Propose the bones-map of a skeleton; it may lack bones.

    Args: told: joints that the file itself names, by the words of VRM, such as `leftUpperArm`.
        carried: skin on each joint, (J,), if there is any.
    """
    bare = set() if carried is None else set(np.flatnonzero(carried <= 0.0).tolist())
    readings = _readings(tree, told)
    by_name = _from_landmarks(tree, readings, _landmarks(tree, readings), bare)
    if not by_name.lacking:
        return _as(by_name, "VRM" if told else "names")

    seen = read_shape(tree, carried)
    if seen is None or readings[seen.head].kind not in ABOVE_SHOULDERS:
        return _as(by_name, "names")
    by_shape = _from_landmarks(tree, seen.readings(readings), seen.landmarks(), bare)
    better = len(by_shape.lacking) < len(by_name.lacking)
    return _as(by_shape, "shape") if better else _as(by_name, "names")


def _as(found: BoneMap, family: str) -> BoneMap:
    return BoneMap(found.bones, found.root, found.twists, found.tips, found.kept, family)


def _readings(tree: Tree, told: Mapping[str, int] | None) -> list[Reading]:
    """Read all names; where hands begin with `DEF-` only such count, the rest being controls."""
    readings = read_names(tree.names)
    deforming = [name.startswith("DEF-") for name in tree.names]
    if any(d and r.kind == "palm" for d, r in zip(deforming, readings, strict=True)):
        readings = [r if d else Reading() for d, r in zip(deforming, readings, strict=True)]
    if told:
        readings = [Reading() for _ in tree.names]
        for word, joint in told.items():
            readings[joint] = read_name(word)
    return _with_numbered_fingers(readings)


def _with_numbered_fingers(readings: list[Reading]) -> list[Reading]:
    """Turn fingers that have numbers into digits: counted from 0 or from 1, the thumb first."""
    numbers = sorted({r.digit for r in readings if r.kind == "finger"})
    if len(numbers) < 4:
        return [Reading() if r.kind == "finger" else r for r in readings]
    first = int(numbers[0])
    return [
        Reading("digit", r.side, DIGITS[int(r.digit) - first], r.end, r.twist, r.metacarpal)
        if r.kind == "finger" and 0 <= int(r.digit) - first < len(DIGITS)
        else r
        for r in readings
    ]


def _landmarks(tree: Tree, readings: Sequence[Reading]) -> dict[str, int]:
    """Head and hands, the nearest to the trunk of those that bear such a name."""
    found: dict[str, int] = {}
    for joint in sorted(range(len(readings)), key=lambda j: int(tree.depth[j])):
        r = readings[joint]
        if r.end or r.twist:
            continue
        if r.kind == "head":
            found.setdefault("head", joint)
        elif r.kind == "palm" and r.side:
            found.setdefault(f"palm_{r.side}", joint)
    if "head" not in found and {"palm_L", "palm_R"} <= found.keys():
        top = _end_of_spine(tree, readings, tree.common(found["palm_L"], found["palm_R"]))
        if top is not None:
            found["head"] = top
    return found


def _end_of_spine(tree: Tree, readings: Sequence[Reading], chest: int) -> int | None:
    """Last of the joints beyond the chest that are called spine, as a head is in some families."""
    beyond = [
        j
        for j in (tree.below(chest) if chest >= 0 else ())
        if j != chest and readings[j].kind in ("spine", "neck") and not readings[j].end
    ]
    return max(beyond, key=lambda j: int(tree.depth[j]), default=None)


def _from_landmarks(
    tree: Tree, readings: Sequence[Reading], marks: Mapping[str, int], bare: set[int]
) -> BoneMap:
    bones: Finds = {}
    chest = _chest(tree, marks)
    root = _trunk(tree, readings, marks, chest, bones)
    for side in SIDES:
        if f"palm_{side}" in marks:
            _arm(tree, readings, marks[f"palm_{side}"], chest, side, bones)
    tips: dict[str, str] = {}
    for side in SIDES:
        if f"palm_{side}" in bones:
            _digits(tree, readings, side, bones, tips, bare)
        eye = [j for j, r in enumerate(readings) if r.kind == "eye" and r.side == side]
        if eye:
            bones[f"eye_{side}"] = [min(eye, key=lambda j: int(tree.depth[j]))]
    used = {j for chain in bones.values() for j in chain}
    twists = _twists(tree, readings, bones, used)
    used |= {j for chain in twists.values() for j in chain}
    kept = [j for j, r in enumerate(readings) if r.kind in LEGS and not r.end and j not in used]
    return BoneMap(
        {bone: tree.named(chain) for bone, chain in bones.items() if chain},
        tree.names[root],
        {bone: tree.named(chain) for bone, chain in twists.items()},
        tips,
        tree.named([j for j in kept if not readings[j].twist]),
    )


def _chest(tree: Tree, marks: Mapping[str, int]) -> int:
    """Joint where both arms leave the trunk; −1 if that is unknown."""
    left, right = marks.get("palm_L"), marks.get("palm_R")
    if left is not None and right is not None:
        return tree.common(left, right)
    if "head" in marks:
        hand = left if left is not None else right
        return tree.common(hand, marks["head"]) if hand is not None else -1
    return -1


def _trunk(
    tree: Tree, readings: Sequence[Reading], marks: Mapping[str, int], chest: int, bones: Finds
) -> int:
    """Find back, neck and head; return the pelvis."""
    if "head" not in marks:
        return 0
    path = tree.path(marks["head"])[:-1]
    bones["head"] = [marks["head"]]
    if not path:
        return marks["head"]
    kinds = [readings[j].kind for j in path]
    top = path.index(chest) if chest in path else None
    neck = next((i for i, kind in enumerate(kinds) if kind == "neck"), None)
    if neck is None:
        neck = len(path) if top is None else top + 1
    spine = [i for i in range(neck) if kinds[i] == "spine"]
    pelvis = max((i for i in range(neck) if kinds[i] == "pelvis"), default=None)
    if pelvis is None:
        legs = [i for i in range(neck) if _carries_legs(tree, readings, path[i])]
        pelvis = legs[-1] if legs else max(0, (spine[0] if spine else 1) - 1)
    if pelvis in spine and len(spine) > 1:
        spine.remove(pelvis)
    last = top if top is not None and top < neck else neck - 1
    back = [path[i] for i in range(pelvis + 1, last + 1)] or [path[i] for i in spine]
    bones["neck"] = [path[i] for i in range(last + 1, len(path)) if path[i] not in back]
    end = bones["neck"][0] if bones["neck"] else marks["head"]
    low, high = _split_back(tree, back, end)
    bones["back_1"], bones["back_2"] = low, high
    return path[pelvis]


def _carries_legs(tree: Tree, readings: Sequence[Reading], joint: int) -> bool:
    return any(
        readings[child].kind in LEGS or (readings[child].kind == "pelvis" and readings[child].side)
        for child in tree.children[joint]
    )


def _split_back(tree: Tree, back: list[int], end: int) -> tuple[list[int], list[int]]:
    """Lower and upper back; a back of one joint is all upper, which carries the arms."""
    if len(back) < 2:
        return [], back
    start = tree.places[back[0]]
    way = tree.places[end] - start
    square = float(way @ way) or 1.0
    at = [float((tree.places[j] - start) @ way) / square for j in back]
    low = min(max(1, sum(a < BACK_2_AT for a in at)), len(back) - 1)
    return back[:low], back[low:]


def _arm(
    tree: Tree, readings: Sequence[Reading], hand: int, chest: int, side: str, bones: Finds
) -> None:
    """Sort the joints between trunk and hand into clavicle, upper arm and forearm."""
    path = tree.path(hand)
    start = path.index(chest) + 1 if chest in path else 0
    way = [
        j
        for j in path[start:-1]
        if readings[j].kind not in ("spine", "pelvis", "neck") or chest in path
    ]
    bones[f"palm_{side}"] = [hand]
    kinds = [readings[j].kind for j in way]
    fore = next((i for i, kind in enumerate(kinds) if kind == "f_arm"), None)
    upper = next((i for i, kind in enumerate(kinds) if kind == "arm"), None)
    if upper is None and "shoulder" in kinds:
        upper = len(kinds) - 1 - kinds[::-1].index("shoulder")
    if fore is None or upper is None or upper >= fore:
        upper, fore = _elbow(tree, way, hand, upper)
    if upper is None or fore is None:
        return
    bones[f"clav_{side}"] = way[:upper]
    bones[f"arm_{side}"] = way[upper:fore]
    bones[f"f_arm_{side}"] = way[fore:]


def _elbow(
    tree: Tree, way: Sequence[int], hand: int, upper: int | None
) -> tuple[int | None, int | None]:
    """Shoulder and elbow among the joints before a hand, by the lengths between them.

    The shoulder is told by its name, else it is the second of many or the first of two; the elbow
    halves the rest of the way best.
    """
    if len(way) < 2:
        return None, None
    first = upper if upper is not None and upper < len(way) - 1 else (1 if len(way) > 2 else 0)
    gaps = [
        abs(tree.apart(way[first], way[i]) - tree.apart(way[i], hand))
        for i in range(first + 1, len(way))
    ]
    return first, first + 1 + int(np.argmin(gaps))


def _digits(
    tree: Tree,
    readings: Sequence[Reading],
    side: str,
    bones: Finds,
    tips: dict[str, str],
    bare: set[int],
) -> None:
    hand = bones[f"palm_{side}"][0]
    inside = tree.below(hand)
    for digit in DIGITS:
        chain = [
            j
            for j in inside
            if readings[j].kind == "digit" and readings[j].digit == digit and not readings[j].twist
        ]
        if not chain:
            continue
        chain = [j for j in tree.path(max(chain, key=lambda j: int(tree.depth[j]))) if j in chain]
        ends = [j for j in chain if readings[j].end]
        chain = [j for j in chain if not readings[j].end]
        while len(chain) > 3 and _connects(tree, readings, inside, chain[0]):
            chain = chain[1:]
        if digit in FINGERS:
            chain = _without_metacarpal(tree, readings, hand, chain)
        if len(chain) > 3 and (chain[-1] in bare or len(chain) == 4):
            ends.insert(0, chain[3])
        chain = chain[:3]
        if not chain:
            continue
        for k, joint in zip(_phalanges(digit, len(chain)), chain, strict=True):
            bones[f"{digit}_{side}_{k}"] = [joint]
        end = ends or [c for c in tree.children[chain[-1]] if not tree.children[c]]
        if end:
            tips[f"{digit}_{side}"] = tree.names[end[0]]


def _connects(tree: Tree, readings: Sequence[Reading], inside: Sequence[int], joint: int) -> bool:
    """Whether a joint only hands a digit on: two other digits have a joint in the same place."""
    near = ONE_PLACE * tree.apart(inside[0], joint)
    there = {readings[j].digit for j in inside if tree.apart(j, joint) <= near}
    return len(there - {"", readings[joint].digit}) >= 2


def _phalanges(digit: str, count: int) -> tuple[int, ...]:
    """Return which bones a digit's joints are: one that is not there bends with the next."""
    if count == 2:
        return (2, 3) if digit == "thumb" else (1, 3)
    return (1, 2, 3) if count == 3 else (3,)


def _without_metacarpal(
    tree: Tree, readings: Sequence[Reading], hand: int, chain: list[int]
) -> list[int]:
    if len(chain) < 2:
        return chain
    if readings[chain[0]].metacarpal:
        return [j for j in chain if not readings[j].metacarpal]
    near, far = (tree.apart(hand, j) for j in chain[:2])
    return chain[1:] if len(chain) > 3 and near < METACARPAL_AT * far else chain


def _twists(tree: Tree, readings: Sequence[Reading], bones: Finds, used: set[int]) -> Finds:
    """Joints that hang on an arm or a forearm and share its turn."""
    found: Finds = {}
    for side in SIDES:
        for bone in (f"arm_{side}", f"f_arm_{side}"):
            kind = bone[:-2]
            chain = [
                c
                for j in bones.get(bone, ())
                for c in tree.children[j]
                if c not in used
                and (readings[c].twist or readings[c].kind == kind)
                and not readings[c].end
            ]
            if chain:
                found[bone] = chain
    return found
