"""Takes a body in: from a skinned glTF or VRM file to a rig's folder."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.anatomy import Anatomy
from azee_rig.build.capsules import fit_capsules
from azee_rig.build.chain_builder import BuiltChain, build_chain
from azee_rig.build.coordinates import coordinate_names, read_coordinates
from azee_rig.build.influences import sample_postures, with_four_influences
from azee_rig.build.landmarks import landmarks_of, signing_space, trunk_front
from azee_rig.build.morphs import read_lids, read_skeletal_morphs
from azee_rig.build.riding import riding
from azee_rig.build.sites import SitePlacer, read_rules
from azee_rig.coordinates import Coordinates
from azee_rig.importing.body_anatomy import Model, body_anatomy
from azee_rig.importing.bone_map import BONES, DIGITS, SIDES, BoneMap, check_bone_map, read_bone_map
from azee_rig.importing.container import GltfFile, read_gltf
from azee_rig.importing.eyes import Ball, find_balls, usual_place
from azee_rig.importing.face import FaceMap, map_face, pack_units
from azee_rig.importing.face_shape import face_shape
from azee_rig.importing.fault import BodyError, unreadable
from azee_rig.importing.limbs import Limbs, build_limbs
from azee_rig.importing.propose import propose
from azee_rig.importing.reduced import Reduced, reduce_joints
from azee_rig.importing.report import SIDE_NAMES, ImportReport
from azee_rig.importing.scene import SceneBody, read_scene
from azee_rig.importing.skeleton_tree import Tree
from azee_rig.importing.skin_of import ForeignSurface
from azee_rig.importing.upright import Stand, checks, stand_up
from azee_rig.importing.vrm import expressions, humanoid
from azee_rig.load import load_rig
from azee_rig.mesh import BodyMesh
from azee_rig.rig import Capsules, Rig, RigSite
from azee_rig.skin import skin

Floats = NDArray[np.float64]

DATA = Path(__file__).parents[1] / "data"
MOST_JOINTS = 1024
"""Joints that a rig keeps; a body has some sixty."""
SHORTEST_M = 1e-3
"""A limb, and a last phalanx, that is shorter has no direction."""
WILD_M = 10.0
"""No morph target of a body, once it is as tall as a person, moves anything further."""
ALIKE = 8.0
"""How many times larger a skeleton may be than its mesh, or smaller."""


@dataclass(frozen=True, eq=False)
class Imported:
    """A body taken in: its rig, its mesh, the bones-map that was used, and what to tell of it."""

    rig: Rig
    mesh: BodyMesh
    bones: BoneMap
    report: ImportReport


def propose_bones(path: Path) -> BoneMap:
    """Propose the bones-map of a body's file; it may lack bones. Raises: BodyError."""
    file = read_gltf(path)
    return _proposal(file, read_scene(file))


def import_body(path: Path, name: str, bone_map: Path | None = None) -> Imported:
    """Take a body in.

    Args: path: a .glb, .gltf or .vrm file. name: of the rig. bone_map: the user's own.
    Raises: BodyError: the file is damaged or not supported, or the body lacks what no signing
        body can lack.
    """
    given = read_bone_map(bone_map) if bone_map else None
    file = read_gltf(path)
    scene = read_scene(file)
    tree = Tree(scene.joints, scene.parents, scene.places)
    if given:
        check_bone_map(given, tree)
    bones = _whole(given or _proposal(file, scene), tree)
    stand = stand_up(tree, bones, scene.vertices, exactly=scene.posed)
    return _Import(file, scene, tree, bones, stand, name).done()


def _proposal(file: GltfFile, scene: SceneBody) -> BoneMap:
    index = {node: j for j, node in enumerate(scene.nodes)}
    told = {bone: index[node] for bone, node in humanoid(file).items() if node in index}
    carried = np.zeros(len(scene.joints))
    np.add.at(carried, scene.influences, scene.weights)
    return propose(Tree(scene.joints, scene.parents, scene.places), told, carried)


def _whole(bones: BoneMap, tree: Tree) -> BoneMap:
    """Return the map with what it may leave open: a root, and a back.

    Raises: BodyError: it lacks bones without which no body signs.
    """
    if bones.lacking:
        raise BodyError(
            "body-incomplete",
            f"no joints were found for {', '.join(f'`{b}`' for b in bones.lacking)}",
            "a signing body needs a head, and upper arms, forearms and hands on both sides",
            help_="`azee rig import BODY.glb --propose MAP.json` writes what was found: fill in "
            "the joints and give it back with --map MAP.json",
        )
    chains = dict(bones.bones)
    root = bones.root or tree.names[0]
    if "back_2" not in chains:
        chains["back_2"] = chains.pop("back_1", (root,))
    return replace(bones, bones=chains, root=root)


class _Import:
    """One body on its way into a rig."""

    def __init__(
        self,
        file: GltfFile,
        scene: SceneBody,
        tree: Tree,
        bones: BoneMap,
        stand: Stand,
        name: str,
    ) -> None:
        self.file, self.scene, self.tree, self.bones = file, scene, tree, bones
        self.stand, self.name = stand, name
        self.vertices = stand.points(scene.vertices)
        self.places = stand.points(scene.places)
        self.signer = load_rig("signer")
        self.triangles = scene.triangles

    def _check(self, reduced: Reduced) -> None:
        """Raise BodyError where a body's mesh and skeleton cannot belong together."""
        used = np.unique(self.triangles)
        flesh = float(np.ptp(self.vertices[used], axis=0).max())
        bones = float(np.ptp(reduced.places, axis=0).max())
        if not bones / ALIKE <= flesh <= bones * ALIKE:
            raise BodyError(
                "body-incomplete",
                f"its mesh is {flesh / max(bones, 1e-9):.3g} times the size of its skeleton",
                "they were probably saved in different units",
                help_="apply the scale of both, and save it again",
            )
        wild = [
            t.name
            for t in self.scene.targets
            if np.abs(self.stand.vectors(t.deltas)).max(initial=0.0) > WILD_M
        ]
        if wild:
            raise unreadable(f"its morph target `{wild[0]}` moves the face by more than {WILD_M} m")
        at = {bone: reduced.place(chain[0]) for bone, chain in self.bones.bones.items()}
        for side in SIDES:
            for bone, end in ((f"arm_{side}", f"f_arm_{side}"), (f"f_arm_{side}", f"palm_{side}")):
                if np.linalg.norm(at[end] - at[bone]) < SHORTEST_M:
                    raise BodyError(
                        "body-incomplete",
                        f"`{bone}` has no length: its joint lies where that of `{end}` does",
                    )
            limb = [
                joint
                for bone, chain in self.bones.bones.items()
                for joint in chain
                if f"{bone}_".find(f"_{side}_") > 0 and not bone.startswith(("clav", "eye"))
            ]
            if not reduced.held(limb).any():
                raise BodyError(
                    "body-incomplete",
                    f"no skin hangs on the {SIDE_NAMES[side]} arm",
                    "skin that is bound to a single joint does not move with the others",
                )

    def done(self) -> Imported:
        reduced = reduce_joints(
            self.tree, self.bones, self.places, self.scene.influences, self.scene.weights
        )
        if len(reduced.names) > MOST_JOINTS:
            raise BodyError(
                "body-unsupported",
                f"its bones-map keeps {len(reduced.names)} joints; {MOST_JOINTS} are supported",
            )
        self._check(reduced)
        reduced, eyes, found = self._eyes(reduced)
        anatomy = self._anatomy(reduced, eyes, found)
        names = coordinate_names(DATA / "coordinates.csv")
        built = build_chain(anatomy, names)
        coordinates = read_coordinates(DATA / "coordinates.csv", built.bind)
        limbs = build_limbs(reduced, self.bones, eyes, anatomy, built, coordinates, self.vertices)
        face = self._face()
        mesh = self._mesh(reduced, limbs, face, coordinates, built)
        rig, lost = self._rig(reduced, mesh, limbs, anatomy, built, coordinates, eyes, face)
        report = ImportReport(
            name=self.name,
            family=self.bones.family,
            joints=len(self.scene.joints),
            kept=len(reduced.names),
            vertices=len(self.vertices),
            notes=(*self.scene.notes, *self.stand.notes),
            doubts=tuple(checks(self.tree, self.bones, self.places)),
            without=tuple(b for b in BONES if b not in self.bones.bones),
            eyes="joints" if self._eye_joints() else "balls" if found else "",
            morphs=len(face.expressed),
            unexpressed=dict(face.unexpressed),
            partly=face.partly,
            lost_sites=tuple(lost),
        )
        return Imported(rig, mesh, self.bones, report)

    def _eye_joints(self) -> dict[str, str]:
        found = {s: self.bones.bones.get(f"eye_{s}", ()) for s in SIDES}
        return {s: chain[0] for s, chain in found.items()} if all(found.values()) else {}

    def _eyes(self, reduced: Reduced) -> tuple[Reduced, dict[str, str], dict[str, Ball]]:
        """Find the eyes; eyeballs that hang on the head get joints of their own."""
        named = self._eye_joints()
        if named:
            return reduced, named, {}
        head = self.bones.bones["head"][0]
        height = float(np.ptp(self.vertices[:, 1]))
        balls = find_balls(self.vertices, self.triangles, reduced.held([head], 0.9), height)
        joints = {}
        for side, ball in balls.items():
            joint = f"eye_{side}"
            while joint in reduced.names:
                joint = f"_{joint}"
            reduced = reduced.with_joint(joint, head, ball.middle, ball.taken)
            joints[side] = joint
        return reduced, joints, balls

    def _anatomy(
        self, reduced: Reduced, eyes: Mapping[str, str], found: Mapping[str, Ball]
    ) -> Anatomy:
        head = self.bones.bones["head"][0]
        middles = {
            s: reduced.place(eyes[s]) if s in eyes else usual_place(reduced, head, self.vertices, s)
            for s in SIDES
        }
        index = {name: j for j, name in enumerate(self.tree.names)}
        tips = {}
        for digit, joint in self.bones.tips.items():
            last = next(
                (b[0] for k in (3, 2, 1) if (b := self.bones.bones.get(f"{digit}_{k}"))), None
            )
            place = self.places[index[joint]]
            if last and np.linalg.norm(place - self.places[index[last]]) > SHORTEST_M:
                tips[digit] = place
        model = Model.of(self.signer)
        return body_anatomy(reduced, self.bones, tips, middles, self.vertices, model)

    def _face(self) -> FaceMap:
        targets = self.scene.targets
        names = list(dict.fromkeys(t.name for t in targets if len(t.rows)))
        table = json.loads((DATA / "face_morphs.json").read_text(encoding="utf-8"))
        lids = read_lids(DATA / "lids.json", self.signer.units)
        return map_face(names, expressions(self.file, targets), DATA, table, lids)

    def _mesh(
        self,
        reduced: Reduced,
        limbs: Limbs,
        face: FaceMap,
        coordinates: Coordinates,
        built: BuiltChain,
    ) -> BodyMesh:
        order = np.argsort(-reduced.weights, axis=1, kind="stable")[:, :8]
        weights = np.take_along_axis(reduced.weights, order, axis=1)
        units = pack_units(self.scene.targets, face.targets)
        mesh = BodyMesh(
            vertices=self.vertices,
            triangles=self.triangles,
            parts=self.scene.parts,
            colours=self.scene.colours,
            joints=np.where(weights > 0.0, order, 0),
            weights=weights / weights.sum(axis=1, keepdims=True),
            units=units.names,
            unit_start=units.start,
            unit_rows=units.rows,
            unit_deltas=self.stand.vectors(units.deltas),
            joint_count=len(reduced.names),
        )
        postures = sample_postures(coordinates)
        poses = limbs.drive.pose(postures, coordinates.bind, built.chain, limbs.skeleton)
        return with_four_influences(mesh, limbs.skeleton, poses)

    def _rig(
        self,
        reduced: Reduced,
        mesh: BodyMesh,
        limbs: Limbs,
        anatomy: Anatomy,
        built: BuiltChain,
        coordinates: Coordinates,
        eyes: Mapping[str, str],
        face: FaceMap,
    ) -> tuple[Rig, list[str]]:
        frames = built.chain.frames(coordinates.bind)
        seeing = reduced.held(list(eyes.values())) if eyes else np.zeros(len(self.vertices), bool)
        surface = ForeignSurface(mesh, limbs.skeleton, eyes=seeing)
        nodes = built.chain.names
        shape = face_shape(surface, anatomy, self.bones.bones["head"][0])
        placer = SitePlacer(surface, anatomy, frames, nodes, built.bones, limbs.flesh, shape)
        absent = self._absent()
        sites: dict[str, RigSite] = {}
        lost = []
        for rule in read_rules(DATA / "site_rules.csv"):
            site = None if rule.bone in absent else placer.place_or_near(rule)
            if site is None:
                lost.append(rule.name)
            else:
                sites[site.name] = site
        marks = landmarks_of(built, coordinates, self.signer.landmarks.reference_arm_m)
        size = marks.arm_m / marks.reference_arm_m
        lowered = self._arms_let_down(mesh, limbs, coordinates, built)
        capsules = fit_capsules(
            surface, anatomy, frames, nodes, built.bones, limbs.flesh, size, lowered
        )
        morphs = read_skeletal_morphs(DATA / "skeletal_morphs.json", coordinates.names)
        rig = Rig(
            name=self.name,
            skeleton=limbs.skeleton,
            coordinates=coordinates,
            chain=built.chain,
            drive=limbs.drive,
            bones={b: n for b, n in built.bones.items() if b not in absent},
            sites=sites,
            capsules=_without(capsules, absent),
            landmarks=marks,
            signing_space=signing_space(marks, trunk_front(built, coordinates, capsules)),
            skeletal_morphs={
                m: moves
                for m, moves in morphs.items()
                if not any(c.partition(".")[0] in absent for c in moves)
            },
            face_morphs=face.expressed,
            unexpressed_morphs=face.unexpressed,
            units=mesh.units,
            lids=face.lids,
            folder=Path(self.name),
        )
        return replace(rig, sites=riding(rig, mesh)), lost

    def _arms_let_down(
        self, mesh: BodyMesh, limbs: Limbs, coordinates: Coordinates, built: BuiltChain
    ) -> Floats:
        """Return the vertices with the upper arms as the signer's mesh has them, (N, 3)."""
        q, signer = np.array(coordinates.bind), self.signer.coordinates
        for name, v in coordinates.index.items():
            if name.startswith("arm_"):
                q[v] = signer.bind[signer.index[name]]
        pose = limbs.drive.pose(q, coordinates.bind, built.chain, limbs.skeleton)
        return skin(mesh, limbs.skeleton, pose)

    def _absent(self) -> set[str]:
        """Bones of digits that have no joints at all."""
        return {
            f"{digit}_{side}_{k}"
            for side in SIDES
            for digit in DIGITS
            if digit not in self.bones.digits(side)
            for k in (1, 2, 3)
        }


def _without(capsules: Capsules, absent: set[str]) -> Capsules:
    """Return the capsules without those of bones that are not there."""
    kept = [k for k, name in enumerate(capsules.names) if name not in absent]
    number = {k: i for i, k in enumerate(kept)}

    def among(pairs: NDArray[np.int64]) -> NDArray[np.int64]:
        rows = [[number[a], number[b]] for a, b in pairs.tolist() if a in number and b in number]
        return np.array(rows, dtype=np.int64).reshape(-1, 2)

    return Capsules(
        tuple(capsules.names[k] for k in kept),
        capsules.node[kept],
        capsules.a[kept],
        capsules.b[kept],
        capsules.radius[kept],
        among(capsules.pairs),
        among(capsules.finger_pairs),
    )
