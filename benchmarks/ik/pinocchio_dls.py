"""Damped least squares on pinocchio's kinematics; runs in an environment that has `pin`.

`python pinocchio_dls.py problems.json answers.json`; `elsewhere` describes the exchange. Users of a
robotics library commonly write inverse kinematics like this: stacked task errors, pinocchio's
Jacobians, a damped Gauss-Newton step of limited length, clipped to the limits; four starts.
"""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin  # type: ignore[import-not-found]

MAX_STEPS, STARTS = 200, 4
DAMPING = 1e-4
LONGEST_RAD = 0.5
TOLERANCE = {"point": 0.5e-3, "along": math.radians(0.25), "across": math.radians(0.25)}


class Model:
    """The chain as one revolute joint per degree of freedom."""

    def __init__(self, chain: dict[str, Any]) -> None:
        model = pin.Model()
        kinds = (pin.JointModelRX, pin.JointModelRY, pin.JointModelRZ)
        joints: list[int] = []
        self.column: list[tuple[int, float]] = []
        """Coordinate and sign of each of the model's velocities."""
        for n, parent in enumerate(chain["parents"]):
            above = joints[parent] if parent >= 0 else 0
            place = pin.SE3(np.array(chain["zero"][n]), np.array(chain["offsets"][n]))
            for d in range(chain["dof_start"][n], chain["dof_start"][n + 1]):
                above = model.addJoint(above, kinds[chain["dof_axis"][d]](), place, f"{n}.{d}")
                self.column.append((chain["dof_coordinate"][d], chain["dof_scale"][d]))
                place = pin.SE3.Identity()
            joints.append(above)
        self.model, self.data, self.joints = model, model.createData(), joints
        self.coordinate = np.array([v for v, _ in self.column])
        self.sign = np.array([s for _, s in self.column])

    def errors(self, q: Any, constraints: list[dict[str, Any]]) -> tuple[Any, Any, float]:
        """Stacked errors, their Jacobian by the coordinates, and the worst in tolerances."""
        angles = self.sign * q[self.coordinate]
        pin.computeJointJacobians(self.model, self.data, angles)
        errors, rows, worst = [], [], 0.0
        for c in constraints:
            a, da = self._value(c["kind"], c["node"], c["local"], len(q))
            b, db = self._value(c["kind"], c["other"], c["other_local"], len(q))
            tolerance = TOLERANCE[c["kind"]]
            if c["kind"] == "across":
                error, row = np.array([a @ b]), (b @ da + a @ db)[None]
            else:
                error, row = a - b, da - db
            worst = max(worst, float(np.linalg.norm(error)) / tolerance)
            errors.append(error / tolerance)
            rows.append(row / tolerance)
        return np.concatenate(errors), np.vstack(rows), worst

    def _value(self, kind: str, node: int, local: list[float], width: int) -> tuple[Any, Any]:
        if node < 0:
            return np.array(local), np.zeros((3, width))
        joint = self.joints[node]
        place = self.data.oMi[joint]
        arm = place.rotation @ np.array(local)
        frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        jacobian = pin.getJointJacobian(self.model, self.data, joint, frame)
        turned = -pin.skew(arm) @ jacobian[3:]
        if kind == "point":
            turned = turned + jacobian[:3]
        out = np.zeros((3, width))
        np.add.at(out.T, self.coordinate, (turned * self.sign).T)
        return (place.translation + arm if kind == "point" else arm), out


def solve(model: Model, chain: dict[str, Any], step: dict[str, Any]) -> tuple[Any, int]:
    """Return the best posture of some starts, and how many evaluations it took."""
    free, constraints = np.array(step["free"]), step["constraints"]
    lower, upper = np.array(chain["lower"])[free], np.array(chain["upper"])[free]
    rng = np.random.default_rng(0)
    best, least, evaluations = None, math.inf, 0
    for start in range(STARTS):
        q = np.array(chain["idle"])
        if start:
            q[free] = lower + rng.uniform(0.15, 0.85, len(free)) * (upper - lower)
        for _ in range(MAX_STEPS):
            errors, jacobian, worst = model.errors(q, constraints)
            evaluations += 1
            if worst < least:
                best, least = q.copy(), worst
            if worst <= 1.0:
                break
            J = jacobian[:, free]
            damping = DAMPING * float(errors @ errors) * np.eye(len(errors))
            go = -J.T @ np.linalg.solve(J @ J.T + damping, errors)
            go *= min(1.0, LONGEST_RAD / max(float(np.abs(go).max()), 1e-12))
            q[free] = np.clip(q[free] + go, lower, upper)
        if least <= 1.0:
            break
    return best, evaluations


def main() -> None:
    task = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    model = Model(task["chain"])
    answers = []
    for problem in [task["problems"][0], *task["problems"]]:
        (step,) = problem["steps"]
        began, spent = time.perf_counter(), time.process_time()
        q, evaluations = solve(model, task["chain"], step)
        seconds = min(time.perf_counter() - began, time.process_time() - spent)
        answer = {"seconds": seconds, "evaluations": evaluations, "rounds": [], "q": q.tolist()}
        answers.append(answer)
    # The first problem warmed up.
    done = {"version": f"pinocchio {pin.__version__}", "answers": answers[1:]}
    Path(sys.argv[2]).write_text(json.dumps(done), encoding="utf-8")


if __name__ == "__main__":
    main()
