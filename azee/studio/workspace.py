"""What the pages of one server share: the folder, what was typed, compiler, language server."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from azee.studio.compiler import Compiler
from azee.studio.folder import Folder
from azee.studio.history import History
from azee.studio.job import read_job
from azee.studio.language import Languages


@dataclass(frozen=True, eq=False)
class Workspace:
    """An open folder.

    bodies: what `load_rig` takes, by the name that pages know a body by. first: the text that pages
    show first. scratch: a folder for files that are made to be sent.
    """

    folder: Folder
    history: History
    compiler: Compiler
    languages: Languages
    libraries: Sequence[Path]
    bodies: Mapping[str, str]
    first: str | None
    scratch: Path

    def job(self, message: Mapping[str, Any]) -> dict[str, Any]:
        """Return the job of a message as the worker takes it. Raises: RefusedError."""
        job = read_job(message, tuple(self.bodies))
        self.folder.path(job.file)
        return {**job.as_json(), "rig": self.bodies[job.rig]}
