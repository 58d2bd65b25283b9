"""Opens a folder and serves it to pages on this machine until it is told to stop."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from azee.studio.app import studio_app
from azee.studio.compiler import Compiler
from azee.studio.folder import LARGEST_TEXT, Folder
from azee.studio.history import History
from azee.studio.language import Languages
from azee.studio.workspace import Workspace
from azee.webserver.serving import LocalServer

LARGEST_MESSAGE = 2 * LARGEST_TEXT + 100_000
"""Bytes; a text takes more as JSON."""


def history_path(root: Path, data: Path) -> Path:
    """Return where drafts and versions of a folder are kept, in a folder for data."""
    name = hashlib.sha256(str(root.resolve()).encode("utf-8", "surrogatepass")).hexdigest()[:24]
    return data / "studio" / f"{name}.sqlite"


def serve(
    server: LocalServer,
    root: Path,
    first: str | None,
    *,
    libraries: Sequence[Path],
    bodies: Mapping[str, str],
    kept: Path,
) -> None:
    """Serve a folder until the process is interrupted.

    Args: first: the text that is shown first. bodies: what `load_rig` takes, by name. kept: the
        file of drafts and versions.
    Raises: OSError: the folder or the file of drafts cannot be opened.
    """
    folder = Folder(root)
    history = History(kept)
    with tempfile.TemporaryDirectory(prefix="azee-studio-") as scratch:
        workspace = Workspace(
            folder,
            history,
            Compiler(folder.root, libraries),
            Languages(folder, libraries),
            libraries,
            bodies,
            first,
            Path(scratch),
        )
        server.serve(studio_app(workspace), largest_body=LARGEST_MESSAGE)
