"""A body of sticks with AZee's bones, round lengths and round limits: enough for the solver."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates
from azee_rig.rig import BoneNodes, Capsules, Landmarks, Rig, RigSite, SiteShare

Array = NDArray[np.float64]
LEFT = np.array([1.0, 0.0, 0.0])
UP = np.array([0.0, 1.0, 0.0])
FORWARD = np.array([0.0, 0.0, 1.0])
DOWN = -UP


def frame(direction: Array, normal: Array) -> Array:
    return np.stack([np.cross(direction, normal), direction, normal], axis=1)


@dataclass
class _Builder:
    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    world: list[Array] = field(default_factory=list)
    origin: list[Array] = field(default_factory=list)
    dofs: list[list[tuple[str, int, float]]] = field(default_factory=list)
    limits: dict[str, tuple[float, float, float, float]] = field(default_factory=dict)

    def node(self, name: str, parent: str, origin: Array, rotation: Array) -> None:
        self.names.append(name)
        self.parents.append(self.names.index(parent) if parent else -1)
        self.origin.append(np.asarray(origin, dtype=np.float64))
        self.world.append(rotation)
        self.dofs.append([])

    def turn(self, coordinate: str, axis: int, scale: float) -> None:
        self.dofs[-1].append((coordinate, axis, scale))

    def limit(self, name: str, low: float, high: float, idle: float, stiff: float) -> None:
        self.limits[name] = (low, high, idle, stiff)

    def chain(self) -> tuple[Chain, Coordinates]:
        order = list(self.limits)
        offsets, zero, start, axis, scale, coordinate = [], [], [0], [], [], []
        for b, p in enumerate(self.parents):
            base = np.eye(3) if p < 0 else self.world[p]
            behind = np.zeros(3) if p < 0 else self.origin[p]
            offsets.append(base.T @ (self.origin[b] - behind))
            zero.append(base.T @ self.world[b])
            for name, column, share in self.dofs[b]:
                axis.append(column)
                scale.append(share)
                coordinate.append(order.index(name))
            start.append(len(axis))
        table = np.radians([self.limits[name][:3] for name in order])
        stiffness = np.array([self.limits[name][3] for name in order])
        chain = Chain(
            tuple(self.names),
            np.array(self.parents),
            np.array(offsets),
            np.array(zero),
            np.array(start),
            np.array(axis),
            np.array(scale),
            np.array(coordinate),
        )
        lower, upper, idle = table.T
        return chain, Coordinates(tuple(order), lower, upper, idle, idle, stiffness)


FINGERS = {"index": 0.03, "middle": 0.01, "ring": -0.01, "little": -0.03}


@lru_cache(maxsize=1)
def stick_body() -> Rig:
    b = _Builder()
    upright = frame(UP, FORWARD)
    spread = {"back_1": ("spine_1", "spine_2"), "back_2": ("spine_3",), "neck": ("neck",)}
    parent, height = "", 1.0
    for bone, nodes in spread.items():
        if bone == "neck":
            height = 1.5
        for name in nodes:
            b.node(name, parent, height * UP, upright)
            for axis, column, sign in (("flexion", 0, 1), ("lateral", 2, -1), ("axial", 1, 1)):
                b.turn(f"{bone}.{axis}", column, sign / len(nodes))
            parent, height = name, height + 0.14
        for axis, reach in (("flexion", (-10, 30)), ("lateral", (-15, 15)), ("axial", (-20, 20))):
            b.limit(f"{bone}.{axis}", *reach, 0, 6 if bone != "neck" else 1)
    b.node("head", "neck", 1.6 * UP, upright)
    for axis, column, sign in (("axial", 1, 1), ("flexion", 0, 1), ("lateral", 2, -1)):
        b.turn(f"head.{axis}", column, sign)
        b.limit(f"head.{axis}", -30, 30, 0, 1)
    for side, s in (("L", 1.0), ("R", -1.0)):
        eye = np.array([0.03 * s, 1.68, 0.08])
        b.node(f"eye_{side}", "head", eye, frame(FORWARD, UP))
        b.turn(f"eye_{side}.yaw", 2, 1)
        b.turn(f"eye_{side}.pitch", 0, 1)
        b.limit(f"eye_{side}.yaw", -35, 35, 0, 1)
        b.limit(f"eye_{side}.pitch", -25, 25, 0, 1)
        _arm(b, side, s)
    chain, coordinates = b.chain()
    bones = {}
    for bone, nodes in spread.items():
        bones[bone] = BoneNodes(chain.names.index(nodes[-1]), chain.names.index(nodes[0]))
    for i, name in enumerate(chain.names):
        if not name.startswith(("spine", "neck")):
            bones[name] = BoneNodes(i, i)
    places = {
        "Mssp": np.array([0.0, 1.2, 0.35]),
        "Rssp": np.array([-0.25, 1.2, 0.3]),
        "Lssp": np.array([0.25, 1.2, 0.3]),
        "addressee": np.array([0.0, 1.6, 2.0]),
    }
    given: Any = {
        "name": "sticks",
        "chain": chain,
        "coordinates": coordinates,
        "bones": bones,
        "sites": _sites(chain),
        "capsules": _capsules(chain),
        "landmarks": Landmarks(np.array([0.0, 1.45, 0.0]), 0.3, 0.25, 0.55, 0.5),
        "signing_space": places,
        "skeletal_morphs": {
            f"{f}_{kind}_{side}": {f"{f}_{side}_{k}.flexion": np.pi / 2}
            for f in FINGERS
            for kind, k in (("bend", 1), ("hook", 2))
            for side in "LR"
        },
        "face_morphs": {"smile": {"mouthSmile": 1.0}},
    }
    # What only skin needs is not there.
    everything: dict[str, Any] = {f.name: given.get(f.name) for f in fields(Rig)}
    return Rig(**everything)


def _arm(b: _Builder, side: str, s: float) -> None:
    shoulder, elbow, wrist = (np.array([0.18 * s, y, 0.0]) for y in (1.45, 1.15, 0.9))
    hanging, hand = frame(DOWN, FORWARD), frame(DOWN, -s * LEFT)
    b.node(f"clav_{side}", "spine_3", np.array([0.02 * s, 1.45, 0.0]), frame(s * LEFT, FORWARD))
    b.turn(f"clav_{side}.elevation", 2, s)
    b.turn(f"clav_{side}.protraction", 0, 1)
    b.limit(f"clav_{side}.elevation", -5, 30, 0, 3)
    b.limit(f"clav_{side}.protraction", -15, 20, 0, 3)
    b.node(f"arm_{side}", f"clav_{side}", shoulder, hanging)
    for name, column, sign, low, high, idle in (
        ("flexion", 0, 1.0, -50, 170, 12),
        ("abduction", 2, s, -30, 150, 12),
        ("rotation", 1, s, -70, 90, 25),
    ):
        b.turn(f"arm_{side}.{name}", column, sign)
        b.limit(f"arm_{side}.{name}", low, high, idle, 1)
    b.node(f"f_arm_{side}", f"arm_{side}", elbow, hanging)
    b.turn(f"f_arm_{side}.flexion", 0, 1)
    b.turn(f"f_arm_{side}.pronation", 1, s)
    b.limit(f"f_arm_{side}.flexion", 0, 145, 70, 1)
    b.limit(f"f_arm_{side}.pronation", -90, 85, 30, 1)
    b.node(f"palm_{side}", f"f_arm_{side}", wrist, hand)
    b.turn(f"palm_{side}.flexion", 0, 1)
    b.turn(f"palm_{side}.deviation", 2, s)
    b.limit(f"palm_{side}.flexion", -70, 75, -5, 1.5)
    b.limit(f"palm_{side}.deviation", -30, 20, 0, 1.5)
    for finger, aside in FINGERS.items():
        knuckle = np.array([0.18 * s, 0.81, aside])
        for k in (1, 2, 3):
            up = f"palm_{side}" if k == 1 else f"{finger}_{side}_{k - 1}"
            b.node(f"{finger}_{side}_{k}", up, knuckle + (k - 1) * 0.03 * DOWN, hand)
            if k == 1:
                b.turn(f"{finger}_{side}_1.deviation", 2, s)
                b.limit(f"{finger}_{side}_1.deviation", -25, 25, 0, 1)
            b.turn(f"{finger}_{side}_{k}.flexion", 0, 1)
            b.limit(f"{finger}_{side}_{k}.flexion", -45 if k == 1 else 0, 90, 20, 1)
    for k in (1, 2, 3):
        up = f"palm_{side}" if k == 1 else f"thumb_{side}_{k - 1}"
        joint = np.array([0.17 * s, 0.88, 0.03]) + (k - 1) * 0.035 * DOWN
        b.node(f"thumb_{side}_{k}", up, joint, frame(DOWN, -FORWARD))
        b.turn(f"thumb_{side}_{k}.flexion", 0, 1)
        b.limit(f"thumb_{side}_{k}.flexion", -65 if k == 1 else -15, 60, -20 if k == 1 else 5, 1)
        if k == 1:
            for axis, column, low, high in (("abduction", 2, -5, 50), ("roll", 1, -35, 35)):
                b.turn(f"thumb_{side}_1.{axis}", column, s)
                b.limit(f"thumb_{side}_1.{axis}", low, high, 20 if axis == "abduction" else 0, 1)


def _sites(chain: Chain) -> dict[str, RigSite]:
    sites = {}

    def add(name: str, node: str, position: list[float], normal: list[float]) -> None:
        place, out = np.array(position), np.array(normal)
        bone = "back_2" if node == "spine_3" else node
        sites[name] = RigSite(name, bone, chain.names.index(node), place, out)

    add("CH", "head", [0.0, 0.0, 0.1], [0.0, 0.0, 1.0])
    add("FH", "head", [0.0, 0.14, 0.1], [0.0, 0.0, 1.0])
    add("ST", "spine_3", [0.0, 0.1, 0.11], [0.0, 0.0, 1.0])
    for side in "LR":
        add(f"PA_{side}", f"palm_{side}", [0.0, 0.05, 0.02], [0.0, 0.0, 1.0])
        add(f"H_BACK_{side}", f"palm_{side}", [0.0, 0.05, -0.02], [0.0, 0.0, -1.0])
        add(f"EL_{side}", f"arm_{side}", [0.0, 0.3, -0.04], [0.0, 0.0, -1.0])
        add(f"SH_{side}", f"arm_{side}", [0.0, 0.0, 0.05], [0.0, 0.0, 1.0])
        # Rides on two limbs, as skin in the crease of an elbow does.
        add(f"ELi_{side}", f"arm_{side}", [0.0, 0.29, 0.02], [0.0, 0.1, 0.7])
        fore = chain.names.index(f"f_arm_{side}")
        share = SiteShare(fore, np.array([0.01, 0.02, 0.02]), np.array([0.1, -0.1, 0.6]))
        sites[f"ELi_{side}"] = replace(sites[f"ELi_{side}"], shares=(share,))
        for finger in FINGERS:
            node = f"{finger}_{side}_3"
            add(f"{finger[0].upper()}_TIP_{side}", node, [0.0, 0.03, 0.0], [0.0, 1.0, 0.0])
        add(f"T_TIP_{side}", f"thumb_{side}_3", [0.0, 0.03, 0.0], [0.0, 1.0, 0.0])
    return sites


def _capsules(chain: Chain) -> Capsules:
    names: list[str] = []
    nodes: list[int] = []
    ends: list[list[float]] = []
    radii: list[float] = []

    def add(name: str, node: str, a: list[float], b: list[float], radius: float) -> None:
        names.append(name)
        nodes.append(chain.names.index(node))
        ends.append([*a, *b])
        radii.append(radius)

    for i, node in enumerate(("spine_1", "spine_2", "spine_3")):
        add(f"trunk_{i + 1}", node, [-0.05, 0.07, 0.0], [0.05, 0.07, 0.0], 0.1)
    add("head", "head", [0.0, 0.06, 0.02], [0.0, 0.1, 0.02], 0.08)
    for side in "LR":
        add(f"upper_{side}", f"arm_{side}", [0.0, 0.15, 0.0], [0.0, 0.3, 0.0], 0.04)
        add(f"fore_{side}", f"f_arm_{side}", [0.0, 0.03, 0.0], [0.0, 0.25, 0.0], 0.035)
        add(f"hand_{side}", f"palm_{side}", [0.0, 0.02, 0.0], [0.0, 0.08, 0.0], 0.03)
    body = range(4)
    limbs = {side: [names.index(f"{p}_{side}") for p in ("upper", "fore", "hand")] for side in "LR"}
    pairs = [(i, j) for side in "LR" for i in limbs[side] for j in body if names[i][0] != "u"]
    pairs += [(i, j) for i in limbs["L"] for j in limbs["R"]]
    table = np.array(ends)
    return Capsules(
        tuple(names),
        np.array(nodes),
        table[:, :3],
        table[:, 3:],
        np.array(radii),
        np.array(pairs),
        np.empty((0, 2), dtype=np.int64),
    )
