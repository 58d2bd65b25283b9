"""MediaPipe in an environment of its own, which is made when first asked for.

The wheel 0.10.14 (Apache-2.0) holds the trackers of pose, face and hands with their models; newer
ones download models when they run. It exists for Python 3.8 to 3.12.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from benchmarks.ik.elsewhere import NotThere

OUT = Path(__file__).parents[2] / "out"
FOLDER = OUT / "env-mediapipe"
PACKAGES = ("mediapipe==0.10.14", "av", "pillow", "scikit-learn")
VERSIONS = ("3.11", "3.12", "3.10", "3.9")
TRACK = Path(__file__).with_name("track.py")
FACE_MARKS = Path(__file__).with_name("face_marks.py")


def interpreter() -> Path:
    """Return the environment's Python, which is made unless it is there.

    Raises: NotThere: no fitting Python on this machine, or the package cannot be installed.
    """
    windows = sys.platform == "win32"
    python = FOLDER / ("Scripts/python.exe" if windows else "bin/python")
    ready = FOLDER / ".ready"
    if ready.exists() and ready.read_text(encoding="utf-8") == " ".join(PACKAGES):
        return python
    _run([_base(), "-m", "venv", "--clear", str(FOLDER)], "no environment can be made")
    _run(
        [str(python), "-m", "pip", "install", "--quiet", *PACKAGES],
        f"{PACKAGES[0]} cannot be installed",
    )
    ready.write_text(" ".join(PACKAGES), encoding="utf-8")
    return python


def _base() -> str:
    """Return a Python that the wheel exists for: this one, or another of the machine's."""
    if "{}.{}".format(*sys.version_info) in VERSIONS:
        return sys.executable
    for version in VERSIONS:
        found = shutil.which(f"python{version}")
        if found and not subprocess.run([found, "-c", ""], capture_output=True).returncode:
            return found
    raise NotThere(
        f"{PACKAGES[0]} needs Python 3.9 to 3.12: this is "
        f"{sys.version_info.major}.{sys.version_info.minor}, and no other was found"
    )


def track(python: Path, film: Path, out: Path) -> None:
    """Look for a person in a film. Raises: NotThere: the tracker has failed."""
    _run([str(python), str(TRACK), str(film), str(out)], f"{film.name} cannot be tracked")


def look_for_faces(python: Path, pictures: Path, out: Path) -> None:
    """Look for a face in each picture. Raises: NotThere: the tracker has failed."""
    _run([str(python), str(FACE_MARKS), str(pictures), str(out)], "faces cannot be tracked")


def _run(command: list[str], failure: str) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise NotThere(f"{failure}: {last}")
