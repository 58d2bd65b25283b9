"""Writes a rig's folder: the same input gives the same bytes, on any day and any machine.

Arrays go into a zip with a fixed date, uncompressed where bytes count, for compressors differ;
numbers in JSON are rounded, which outlasts the last bits in which linear algebra libraries
differ: the chain to a picometre, what was measured on the mesh to a micrometre.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee_rig.mesh import BodyMesh
from azee_rig.rig import Rig
from azee_rig.rig_json import MESH_DIGEST

EXACT, MEASURED = 12, 6
DELTA_M = 1e-5
_DATE = (1980, 1, 1, 0, 0, 0)


def write_arrays(
    path: Path, arrays: Mapping[str, NDArray[np.generic]], *, compressed: bool = False
) -> None:
    """Write an .npz that bears no date; `compressed` halves it, at the price named above."""
    how = zipfile.ZIP_DEFLATED if compressed else zipfile.ZIP_STORED
    with zipfile.ZipFile(path, "w", how) as archive:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(array), allow_pickle=False)
            entry = zipfile.ZipInfo(f"{name}.npy", _DATE)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, buffer.getvalue(), compress_type=how, compresslevel=9)


def write_mesh(path: Path, mesh: BodyMesh, *, compressed: bool = False) -> None:
    """Pack a mesh: see azee_rig.mesh.read_mesh for the units.

    Numbers of more than 16 bits, and shifts of more than 32 cm, are for large meshes of others.
    """
    rows = "<u2" if len(mesh.vertices) <= 0x10000 else "<u4"
    delta_m = max(DELTA_M, float(np.abs(mesh.unit_deltas).max(initial=0.0)) / 0x7FFF)
    described = {
        "parts": [
            {
                "name": p.name,
                "start": p.start,
                "stop": p.stop,
                "colour": p.colour,
                "roughness": p.roughness,
            }
            for p in mesh.parts
        ],
        "units": mesh.units,
        "delta_m": delta_m,
        "joint_count": mesh.joint_count,
    }
    text = json.dumps(described, separators=(",", ":")).encode()
    write_arrays(
        path,
        {
            "described": np.frombuffer(text, dtype=np.uint8),
            "vertices": mesh.vertices.astype("<f4"),
            "triangles": mesh.triangles.astype(rows),
            "colours": np.round(mesh.colours * 255.0).astype(np.uint8),
            "joints": mesh.joints.astype(np.uint8 if mesh.joint_count <= 0x100 else "<u2"),
            "weights": np.round(mesh.weights * 65535.0).astype("<u2"),
            "unit_start": mesh.unit_start.astype("<i4"),
            "unit_rows": mesh.unit_rows.astype(rows),
            "unit_deltas": np.round(mesh.unit_deltas / delta_m).astype("<i2"),
        },
        compressed=compressed,
    )


def write_rig(path: Path, rig: Rig, mesh: Path) -> None:
    """Write everything but the mesh as JSON, one item to a line where items are many.

    Args: mesh: its file, written before: the description bears its digest.
    """
    c, chain, drive = rig.coordinates, rig.chain, rig.drive
    content = {
        "name": rig.name,
        MESH_DIGEST: hashlib.sha256(mesh.read_bytes()).hexdigest(),
        "skeleton": {
            "names": rig.skeleton.names,
            "parents": _plain(rig.skeleton.parents),
            "offsets_m": _plain(rig.skeleton.offsets),
        },
        "coordinates": [
            {
                "name": name,
                "lower": _plain(c.lower[i]),
                "upper": _plain(c.upper[i]),
                "idle": _plain(c.idle[i]),
                "bind": _plain(c.bind[i]),
                "stiffness": _plain(c.stiffness[i]),
            }
            for i, name in enumerate(c.names)
        ],
        "nodes": [
            {
                "name": name,
                "parent": _plain(chain.parents[b]),
                "offset_m": _plain(chain.offsets[b]),
                "zero": _plain(chain.zero[b]),
                "turns": [
                    [
                        _plain(chain.dof_axis[d]),
                        _plain(chain.dof_scale[d]),
                        c.names[chain.dof_coordinate[d]],
                    ]
                    for d in range(chain.dof_start[b], chain.dof_start[b + 1])
                ],
            }
            for b, name in enumerate(chain.names)
        ],
        "drive": [
            {
                "joint": name,
                "node": _plain(drive.node[j]),
                "twist": _plain(drive.twist_coordinate[j]),
                "left_out": _plain(drive.twist_left_out[j]),
                "helper_of": _plain(drive.helper_of[j]),
                "share": _plain(drive.helper_share[j]),
            }
            for j, name in enumerate(rig.skeleton.names)
        ],
        "bones": {b: [n.node, n.origin_node] for b, n in rig.bones.items()},
        "sites": [
            {
                "name": s.name,
                "bone": s.bone,
                "node": s.node,
                "position_m": _plain(s.position, MEASURED),
                "normal": _plain(s.normal, MEASURED),
                "shares": [
                    {
                        "node": share.node,
                        "vector_m": _plain(share.vector, MEASURED),
                        "normal": _plain(share.normal, MEASURED),
                    }
                    for share in s.shares
                ],
            }
            for s in rig.sites.values()
        ],
        "capsules": [
            {
                "name": name,
                "node": _plain(rig.capsules.node[k]),
                "a_m": _plain(rig.capsules.a[k], MEASURED),
                "b_m": _plain(rig.capsules.b[k], MEASURED),
                "radius_m": _plain(rig.capsules.radius[k], MEASURED),
            }
            for k, name in enumerate(rig.capsules.names)
        ],
        "pairs": _plain(rig.capsules.pairs),
        "finger_pairs": _plain(rig.capsules.finger_pairs),
        "landmarks": {
            "shoulder_middle_m": _plain(rig.landmarks.shoulder_middle),
            "upper_arm_m": _plain(rig.landmarks.upper_arm_m),
            "forearm_m": _plain(rig.landmarks.forearm_m),
            "arm_m": _plain(rig.landmarks.arm_m),
            "reference_arm_m": _plain(rig.landmarks.reference_arm_m),
        },
        "signing_space_m": {name: _plain(p, MEASURED) for name, p in rig.signing_space.items()},
        "skeletal_morphs": {
            morph: {name: _plain(angle) for name, angle in moves.items()}
            for morph, moves in rig.skeletal_morphs.items()
        },
        "face_morphs": {morph: dict(units) for morph, units in rig.face_morphs.items()},
        "unexpressed_morphs": dict(rig.unexpressed_morphs),
        "lids": dict(rig.lids),
        "units": rig.units,
    }
    lines = []
    for key, value in content.items():
        lines.append(f'  "{key}": {_laid_out(value)}')
    path.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8", newline="\n")


def _laid_out(value: object) -> str:
    """One line per item of a list of objects or of a mapping of mappings, else one line."""
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n" + ",\n".join(f"    {_compact(item)}" for item in value) + "\n  ]"
    if isinstance(value, dict) and any(isinstance(v, dict | list) for v in value.values()):
        items = (f"    {_compact(k)}: {_compact(v)}" for k, v in value.items())
        return "{\n" + ",\n".join(items) + "\n  }"
    return _compact(value)


def _compact(value: object) -> str:
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False)


def _plain(value: object, digits: int = EXACT) -> object:
    """Numbers as JSON has them, rounded; −0 becomes 0."""
    array = np.asarray(value)
    if array.dtype.kind == "f":
        array = np.round(array, digits) + 0.0
    return array.tolist()
