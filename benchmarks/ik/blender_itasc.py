"""Blender's iTaSC in the paper's two-level iteration; runs in an environment that has `bpy`.

`python blender_itasc.py problems.json answers.json`; `elsewhere` describes the exchange. Each node
of the chain is a bone whose rest matrix is its frame at the zero pose. So the Euler angles of its
pose, in the right order, are the coordinates. Sites are leaf bones without freedom. As in Nunnari,
Filhol and Heloir (2018, listing 1), one IK constraint at a time is switched on, the dependency
graph updated, and the result put into the bones' own angles.
"""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import bpy  # type: ignore[import-not-found]
import numpy as np
from mathutils import Euler, Matrix, Vector  # type: ignore[import-not-found]

MAX_ITERATIONS = 35
THRESHOLDS = {"point": 0.01, "along": math.radians(5), "across": math.radians(5)}
AXES = "xyz"


class Armature:
    """The chain as an armature with iTaSC switched on."""

    def __init__(self, chain: dict[str, Any], sites: list[tuple[int, tuple[float, ...]]]) -> None:
        self.chain, self.updates = chain, 0
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        self.layer = bpy.context.view_layer
        data = bpy.data.armatures.new("armature")
        self.object = bpy.data.objects.new("armature", data)
        scene.collection.objects.link(self.object)
        self.layer.objects.active = self.object
        bpy.ops.object.mode_set(mode="EDIT")
        self.rest = rest_frames(chain)
        for n, name in enumerate(chain["names"]):
            self._bone(data, n, name)
        self.sites = {}
        for node, local in sites:
            self.sites[node, local] = self._site(data, node, local)
        bpy.ops.object.mode_set(mode="POSE")
        self.object.pose.ik_solver = "ITASC"
        parameters = self.object.pose.ik_param
        parameters.mode, parameters.solver = "ANIMATION", "SDLS"
        parameters.iterations, parameters.precision = 100, 0.005
        self.bones = [self.object.pose.bones[name] for name in chain["names"]]
        self.dofs = [self._joint(n) for n in range(len(self.bones))]
        for name in self.sites.values():
            leaf = self.object.pose.bones[name]
            leaf.lock_ik_x = leaf.lock_ik_y = leaf.lock_ik_z = True
        self.target = bpy.data.objects.new("target", None)
        scene.collection.objects.link(self.target)
        self.target.rotation_mode = "QUATERNION"
        self.constraints: dict[tuple[str, str, int], Any] = {}

    def _bone(self, data: Any, n: int, name: str) -> None:
        position, rotation = self.rest[n]
        bone = data.edit_bones.new(name)
        children = [c for c, p in enumerate(self.chain["parents"]) if p == n]
        lengths = [float(np.linalg.norm(self.rest[c][0] - position)) for c in children]
        length = max([0.03, *lengths])
        bone.head, bone.tail = position, position + rotation[:, 1] * length
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = rotation, position
        bone.matrix = Matrix(matrix.tolist())
        bone.length = length
        parent = self.chain["parents"][n]
        if parent >= 0:
            bone.parent = data.edit_bones[self.chain["names"][parent]]

    def _site(self, data: Any, node: int, local: tuple[float, ...]) -> str:
        position, rotation = self.rest[node]
        bone = data.edit_bones.new(f"site {len(self.sites)}")
        bone.head, bone.tail = position, position + rotation @ np.array(local)
        bone.parent = data.edit_bones[self.chain["names"][node]]
        return str(bone.name)

    def _joint(self, n: int) -> list[tuple[int, float, int]]:
        """Limits of a bone; returns its (axis, sign, coordinate), in the chain's order."""
        chain, bone = self.chain, self.bones[n]
        run = range(chain["dof_start"][n], chain["dof_start"][n + 1])
        dofs = [
            (chain["dof_axis"][d], chain["dof_scale"][d], chain["dof_coordinate"][d]) for d in run
        ]
        order = [axis for axis, _, _ in dofs]
        order += [axis for axis in range(3) if axis not in order]
        bone.rotation_mode = "".join(AXES[axis].upper() for axis in reversed(order))
        for axis in range(3):
            setattr(bone, f"lock_ik_{AXES[axis]}", axis not in [a for a, _, _ in dofs])
        for axis, sign, v in dofs:
            low, high = sorted((sign * chain["lower"][v], sign * chain["upper"][v]))
            setattr(bone, f"use_ik_limit_{AXES[axis]}", True)
            setattr(bone, f"ik_min_{AXES[axis]}", min(0.0, low))
            setattr(bone, f"ik_max_{AXES[axis]}", max(0.0, high))
        return dofs

    def update(self) -> None:
        self.updates += 1
        self.layer.update()

    def pose(self, q: list[float]) -> None:
        for bone, dofs in zip(self.bones, self.dofs, strict=True):
            angles = [0.0, 0.0, 0.0]
            for axis, sign, v in dofs:
                angles[axis] = sign * q[v]
            bone.rotation_euler = Euler(angles, bone.rotation_mode)
        self.update()

    def coordinates(self) -> list[float]:
        q = [0.0] * len(self.chain["lower"])
        for bone, dofs in zip(self.bones, self.dofs, strict=True):
            for axis, sign, v in dofs:
                q[v] = sign * bone.rotation_euler[axis]
        return q

    def value(self, kind: str, node: int, local: list[float]) -> Any:
        """Return the point or direction of a node in the world, or a constant."""
        if node < 0:
            return Vector(local)
        matrix = self.bones[node].matrix
        return matrix @ Vector(local) if kind == "point" else matrix.to_3x3() @ Vector(local)

    def offset(self, constraint: dict[str, Any]) -> float:
        """Return the distance of a constraint from its goal, metres or radians."""
        kind = constraint["kind"]
        own = self.value(kind, constraint["node"], constraint["local"])
        goal = self.value(kind, constraint["other"], constraint["other_local"])
        if kind == "point":
            return float((own - goal).length)
        between = float(own.angle(goal))
        return abs(between - math.pi / 2) if kind == "across" else between

    def apply(self, constraint: dict[str, Any], free: set[int]) -> None:
        """Let the inner solver meet one constraint, and keep its pose."""
        kind, node = constraint["kind"], constraint["node"]
        own = self.value(kind, node, constraint["local"])
        goal = self.value(kind, constraint["other"], constraint["other_local"])
        chain = self._chain(node, free)
        if not chain:
            return
        if kind == "point":
            end = self.sites[node, tuple(constraint["local"])]
            self.target.location = goal
            length = len(chain) + 1 + self._between(node, chain[-1])
        else:
            end = self.chain["names"][node]
            if kind == "across":
                goal = own - goal * own.dot(goal)
            turn = own.rotation_difference(goal)
            matrix = self.bones[node].matrix
            self.target.rotation_quaternion = turn @ matrix.to_quaternion()
            self.target.location = self.bones[node].tail
            length = len(chain) + self._between(node, chain[-1])
        found = self._constraint(end, kind, length)
        found.mute = False
        self.update()
        matrices = {n: self.bones[n].matrix.copy() for n in chain}
        before = {n: self._above(n) for n in chain}
        for n in chain:
            bone, parent = self.bones[n], self.chain["parents"][n]
            own_rest = bone.bone.matrix_local
            if parent >= 0:
                above = matrices.get(parent, before[n])
                rest = self.bones[parent].bone.matrix_local.inverted() @ own_rest
                local = rest.inverted() @ (above.inverted() @ matrices[n])
            else:
                local = own_rest.inverted() @ matrices[n]
            bone.rotation_euler = local.to_euler(bone.rotation_mode, bone.rotation_euler)
        found.mute = True
        self.update()

    def _above(self, n: int) -> Any:
        parent = self.chain["parents"][n]
        return self.bones[parent].matrix.copy() if parent >= 0 else Matrix()

    def _chain(self, node: int, free: set[int]) -> list[int]:
        """Nodes from the first free one to the last above `node`, root first."""
        path = []
        while node >= 0:
            path.append(node)
            node = self.chain["parents"][node]
        path.reverse()
        moving = [i for i, n in enumerate(path) if any(v in free for _, _, v in self.dofs[n])]
        return path[moving[0] : moving[-1] + 1] if moving else []

    def _between(self, node: int, last: int) -> int:
        count = 0
        while node != last:
            count, node = count + 1, self.chain["parents"][node]
        return count

    def _constraint(self, end: str, kind: str, length: int) -> Any:
        key = (end, "point" if kind == "point" else "turn", length)
        if key not in self.constraints:
            made = self.object.pose.bones[end].constraints.new("IK")
            made.target = self.target
            made.use_location, made.use_rotation = kind == "point", kind != "point"
            made.chain_count, made.use_tail, made.iterations = length, True, 500
            made.use_stretch, made.mute = False, True
            self.constraints[key] = made
        return self.constraints[key]

    def solve(self, problem: dict[str, Any]) -> list[int]:
        """Run listing 1 for each IK problem in turn. Returns: the number of rounds of each."""
        rounds = []
        for step in problem["steps"]:
            free = set(step["free"])
            iteration = 0
            while iteration < MAX_ITERATIONS:
                iteration += 1
                for constraint in step["constraints"]:
                    self.apply(constraint, free)
                if all(self.offset(c) < THRESHOLDS[c["kind"]] for c in step["constraints"]):
                    break
            rounds.append(iteration)
        return rounds


def rest_frames(chain: dict[str, Any]) -> list[tuple[Any, Any]]:
    """World frames at the zero pose: positions (3,) and rotations (3, 3)."""
    frames: list[tuple[Any, Any]] = []
    for n, parent in enumerate(chain["parents"]):
        offset, zero = np.array(chain["offsets"][n]), np.array(chain["zero"][n])
        if parent < 0:
            frames.append((offset, zero))
        else:
            position, rotation = frames[parent]
            frames.append((position + rotation @ offset, rotation @ zero))
    return frames


def main() -> None:
    task = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    sites = sorted(
        {
            (c["node"], tuple(c["local"]))
            for problem in task["problems"]
            for step in problem["steps"]
            for c in step["constraints"]
            if c["kind"] == "point"
        }
    )
    armature = Armature(task["chain"], sites)
    answers = []
    for problem in [task["problems"][0], *task["problems"]]:
        armature.pose(task["chain"]["idle"])
        before = armature.updates
        began, spent = time.perf_counter(), time.process_time()
        rounds = armature.solve(problem)
        answers.append(
            {
                "seconds": min(time.perf_counter() - began, time.process_time() - spent),
                "evaluations": armature.updates - before,
                "rounds": rounds,
                "q": armature.coordinates(),
            }
        )
    # The first problem warmed up.
    done = {"version": f"Blender {bpy.app.version_string}", "answers": answers[1:]}
    Path(sys.argv[2]).write_text(json.dumps(done), encoding="utf-8")


if __name__ == "__main__":
    main()
