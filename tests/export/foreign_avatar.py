"""A VRM avatar that is not ours: one body's lengths on nodes of another's names and axes.

Only the standard library and numpy write it. Every node has axes of its own at rest, the skeleton
hangs on a turned node, and the eyes are bones. Its T-pose is what VRM asks for: arms along ±X.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def write_foreign_avatar(
    places: Mapping[str, Floats], parents: Mapping[str, str | None], path: Path
) -> Path:
    """Write bones at places (3,) in the T-pose, by VRM's names, each after the one above it."""
    rng = np.random.default_rng(8)
    world = {}
    nodes: list[dict[str, object]] = []
    number = {}
    for bone, place in places.items():
        world[bone] = _random_turn(rng), place
        above = parents[bone]
        R, p = world[above] if above else (np.eye(3), np.zeros(3))
        number[bone] = len(nodes)
        nodes.append(
            {
                "name": f"Bip_{len(nodes)}",
                "translation": (R.T @ (place - p)).tolist(),
                "rotation": _xyzw(R.T @ world[bone][0]),
            }
        )
        if above:
            nodes[number[above]].setdefault("children", []).append(number[bone])  # type: ignore[attr-defined]
    expressions: dict[str, dict[str, dict[str, object]]] = {
        "preset": {"aa": {}, "blinkLeft": {}, "blinkRight": {}},
        "custom": {"browInnerUp": {}, "mouthSmileLeft": {}},
    }
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [number["hips"]]}],
        "nodes": nodes,
        "extensionsUsed": ["VRMC_vrm"],
        "extensions": {
            "VRMC_vrm": {
                "specVersion": "1.0",
                "meta": {
                    "name": "foreign",
                    "authors": ["tests"],
                    "licenseUrl": "https://vrm.dev/licenses/1.0/",
                },
                "humanoid": {"humanBones": {bone: {"node": n} for bone, n in number.items()}},
                "expressions": expressions,
                "lookAt": {
                    "type": "bone",
                    "offsetFromHeadBone": [0.0, 0.06, 0.0],
                    **{
                        f"rangeMap{way}": {"inputMaxValue": 90.0, "outputScale": 90.0}
                        for way in (
                            *("HorizontalInner", "HorizontalOuter"),
                            *("VerticalDown", "VerticalUp"),
                        )
                    },
                },
            }
        },
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text)) + struct.pack(
        "<I4s", len(text), b"JSON"
    )
    path.write_bytes(head + text)
    return path


def _random_turn(rng: np.random.Generator) -> Floats:
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray(q * np.sign(np.linalg.det(q)))


def _xyzw(R: Floats) -> list[float]:
    """Return a rotation as a quaternion by its eigenvector of eigenvalue 1 (Bar-Itzhack 2000)."""
    K = np.zeros((4, 4))
    K[:3, :3] = R + R.T - np.trace(R) * np.eye(3)
    K[:3, 3] = K[3, :3] = [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
    K[3, 3] = np.trace(R)
    return [float(x) for x in np.linalg.eigh(K)[1][:, -1]]
