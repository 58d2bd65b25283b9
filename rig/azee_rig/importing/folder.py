"""Writes a taken-in body's folder whole or not at all."""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

from azee_rig.build.pack import write_mesh, write_rig
from azee_rig.importing.fault import BodyError
from azee_rig.importing.importer import Imported

MAP = "map.json"


def check_folder(folder: Path) -> None:
    """Refuse a folder that holds anything but a rig. Raises: BodyError, OSError."""
    if folder.exists() and not folder.is_dir():
        raise NotADirectoryError(20, "it is a file", str(folder))
    if folder.is_dir() and any(folder.iterdir()) and not (folder / "rig.json").is_file():
        raise BodyError(
            "body-folder",
            f"`{folder}` holds other things than a rig: it is left alone",
            help_="name a folder that is new, empty, or a rig's",
        )
    if not folder.resolve().parent.is_dir():
        raise FileNotFoundError(2, "no such folder", str(folder.parent))


def write_folder(made: Imported, folder: Path) -> None:
    """Write rig.json, mesh.npz and map.json, beside first, then in place of what was there.

    Raises: BodyError, OSError: as `check_folder`, or the folder cannot be written.
    """
    check_folder(folder)
    target = folder.resolve()
    beside = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    old = beside / "old"
    new = beside / "new"
    try:
        new.mkdir()
        write_mesh(new / "mesh.npz", made.mesh, compressed=True)
        write_rig(new / "rig.json", made.rig, new / "mesh.npz")
        text = json.dumps(made.bones.as_json(), indent=1, ensure_ascii=False)
        (new / MAP).write_text(f"{text}\n", encoding="utf-8", newline="\n")
        if target.exists():
            target.replace(old)
        try:
            new.replace(target)
        except OSError:
            if old.exists():
                old.replace(target)
            raise
    finally:
        shutil.rmtree(beside, ignore_errors=True)
