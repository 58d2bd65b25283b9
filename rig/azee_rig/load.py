"""Loads a rig that ships, or one from a folder."""

from __future__ import annotations

import hashlib
import json
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

from azee_rig.rig import Rig
from azee_rig.rig_json import MESH_DIGEST, read_description
from azee_rig.soundness import check_mesh, check_rig, check_same_body

_SHIPPED = Path(__file__).parent / "data"

DAMAGED = (
    *(ValueError, TypeError, LookupError, AttributeError, ArithmeticError, EOFError),
    *(MemoryError, RecursionError, NotImplementedError, RuntimeError),
    *(zipfile.BadZipFile, zlib.error),
)
"""What Python, numpy and their readers of zip files raise on files that are damaged."""


class RigError(Exception):
    """A rig that is not there or cannot be read. The message is for the user."""


def shipped_rigs() -> tuple[str, ...]:
    """Names of the rigs that ship."""
    return tuple(sorted(p.parent.name for p in _SHIPPED.glob("*/rig.json")))


def load_rig(name_or_path: str | Path = "signer") -> Rig:
    """Load a rig by the name of one that ships, or by its folder.

    Raises: RigError: no such rig, or its files cannot be read.
    """
    ships = str(name_or_path) in shipped_rigs()
    folder = _SHIPPED / name_or_path if ships else Path(name_or_path)
    path = folder / "rig.json"
    if not path.is_file():
        known = ", ".join(shipped_rigs())
        raise RigError(
            f"there is no rig `{name_or_path}`: neither one that ships ({known}) "
            "nor a folder with a rig.json"
        )
    try:
        return _read(folder, ships=ships)
    except KeyError as error:
        raise RigError(f"cannot read the rig in {path}: {error} is missing") from error
    except OSError as error:
        raise RigError(f"cannot read the rig in {path}: {error.strerror or error}") from error
    except DAMAGED as error:
        reason = str(error) or "its files are damaged"
        raise RigError(f"cannot read the rig in {path}: {reason}") from error


def _read(folder: Path, *, ships: bool) -> Rig:
    """Read a rig and hold it together; what ships has had its mesh looked into by our tests."""
    content = json.loads((folder / "rig.json").read_text(encoding="utf-8"))
    rig = read_description(content, folder)
    check_rig(rig)
    known = _check_digest(content, folder / "mesh.npz")
    if not ships:
        check_mesh(rig, rig.mesh)
        if not known:
            check_same_body(rig, rig.mesh)
    return rig


def _check_digest(content: Mapping[str, object], mesh: Path) -> bool:
    """Hold a mesh to be the one that the description was made with; False where none is named."""
    try:
        data = mesh.read_bytes()
    except OSError as error:
        raise ValueError(f"its {mesh.name} cannot be read: {error.strerror}") from error
    if MESH_DIGEST not in content:
        return False
    if content[MESH_DIGEST] != hashlib.sha256(data).hexdigest():
        raise ValueError(
            f"its {mesh.name} is not the one that rig.json was made with: the files of two bodies "
            "were mixed, or one is damaged"
        )
    return True
