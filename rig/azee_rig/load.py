"""Loads a rig that ships, or one from a folder. A process reads each rig once."""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
import zlib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from reprlib import repr as shown

from azee_rig.rig import MESH, SHIPPED, Rig, Stamp, shared
from azee_rig.rig_json import MESH_DIGEST, read_description
from azee_rig.soundness import check_mesh, check_rig, check_same_body

DESCRIPTION = "rig.json"
MOST_KEPT = 4
"""Rigs that a process keeps. Each takes some 25 MB with its surface."""

DAMAGED = (
    *(ValueError, TypeError, LookupError, AttributeError, ArithmeticError, EOFError),
    *(MemoryError, RecursionError, NotImplementedError, RuntimeError),
    *(zipfile.BadZipFile, zlib.error),
)
"""What Python, numpy and their readers of zip files raise on files that are damaged."""


class RigError(ValueError):
    """A rig that is not there or cannot be read. The message is for the user."""


def shipped_rigs() -> tuple[str, ...]:
    """Names of the rigs that ship."""
    return tuple(sorted(p.parent.name for p in SHIPPED.glob(f"*/{DESCRIPTION}")))


def load_rig(name_or_path: str | Path = "signer") -> Rig:
    """Load a rig by the name of one that ships, or by its folder.

    A second call returns the same object; rigs are immutable. The rig is read again when a file
    of its folder was added, removed, or has another size or modification time.

    Raises: RigError: no such rig, or its files cannot be read.
    """
    if not isinstance(name_or_path, str | os.PathLike):
        raise RigError(
            f"a rig is the name of one that ships ({', '.join(shipped_rigs())}) or a folder with "
            f"a {DESCRIPTION}, not {shown(name_or_path)}"
        )
    ships = str(name_or_path) in shipped_rigs()
    folder = SHIPPED / name_or_path if ships else Path(name_or_path)
    path = folder / DESCRIPTION
    if not str(name_or_path) or not _is_file(path):
        raise RigError(
            f"there is no rig `{name_or_path}`: neither one that ships "
            f"({', '.join(shipped_rigs())}) nor a folder with a {DESCRIPTION}"
        )
    try:
        return _loaded(folder.absolute(), _stamp(folder), ships)
    except KeyError as error:
        raise RigError(f"cannot read the rig in {path}: {error} is missing") from error
    except OSError as error:
        raise RigError(f"cannot read the rig in {path}: {error.strerror or error}") from error
    except DAMAGED as error:
        reason = str(error) or "its files are damaged"
        raise RigError(f"cannot read the rig in {path}: {reason}") from error


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # such as a name that is too long
        return False


def _stamp(folder: Path) -> Stamp:
    """Return the state of a folder, without reading its files."""
    found = ((file.name, file.stat()) for file in folder.iterdir() if file.is_file())
    return tuple(sorted((name, stat.st_mtime_ns, stat.st_size) for name, stat in found))


@lru_cache(maxsize=MOST_KEPT)
def _loaded(folder: Path, stamp: Stamp, ships: bool) -> Rig:
    """Read a rig. The stamp is part of the cache's key."""
    return shared(_read(folder, ships=ships), stamp)


def _read(folder: Path, *, ships: bool) -> Rig:
    """Read a rig and hold it together; what ships has had its mesh looked into by our tests."""
    content = json.loads((folder / DESCRIPTION).read_text(encoding="utf-8"))
    rig = read_description(content, folder)
    check_rig(rig)
    known = _check_digest(content, folder / MESH)
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
        if isinstance(error, FileNotFoundError):
            raise ValueError(f"{mesh.name} is missing") from error
        raise ValueError(f"its {mesh.name} cannot be read: {error.strerror}") from error
    if MESH_DIGEST not in content:
        return False
    if content[MESH_DIGEST] != hashlib.sha256(data).hexdigest():
        raise ValueError(
            f"its {mesh.name} is not the one that rig.json was made with: the files of two bodies "
            "were mixed, or one is damaged"
        )
    return True
