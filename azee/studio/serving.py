"""Opens a folder and serves it to pages on this machine until it is told to stop."""

from __future__ import annotations

import hashlib
import secrets
import socket
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import uvicorn

from azee.studio.app import studio_app
from azee.studio.compiler import Compiler
from azee.studio.folder import LARGEST_TEXT, Folder
from azee.studio.history import History
from azee.studio.language import Languages
from azee.studio.workspace import Workspace

LOOPBACK = "127.0.0.1"
MOST_CONNECTIONS = 64


def history_path(root: Path, data: Path) -> Path:
    """Return where drafts and versions of a folder are kept, in a folder for data."""
    name = hashlib.sha256(str(root.resolve()).encode("utf-8", "surrogatepass")).hexdigest()[:24]
    return data / "studio" / f"{name}.sqlite"


def serve(
    root: Path,
    first: str | None,
    listening: socket.socket,
    *,
    libraries: Sequence[Path],
    bodies: Mapping[str, str],
    kept: Path,
    announce: Callable[[str], None],
) -> None:
    """Serve a folder until the process is interrupted.

    Args: first: the text that is shown first. listening: a socket on loopback. bodies: what
        `load_rig` takes, by name. kept: the file of drafts and versions. announce: is given the
        address, with its token, when the server is about to listen.
    Raises: OSError: the folder or the file of drafts cannot be opened.
    """
    port = listening.getsockname()[1]
    token = secrets.token_urlsafe(24)
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
        config = uvicorn.Config(
            studio_app(workspace, token, port),
            log_level="warning",
            server_header=False,
            limit_concurrency=MOST_CONNECTIONS,
            ws="websockets-sansio",
            ws_max_size=2 * LARGEST_TEXT + 100_000,
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=1,
        )
        announce(f"http://{LOOPBACK}:{port}/{token}/")
        uvicorn.Server(config).run(sockets=[listening])
