"""Prints the oldest versions that pyproject.toml allows of what azee itself needs, for pip's `-c`.

Extras and tools of development stay free: their own needs decide.
"""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]


def oldest(dependencies: Sequence[str]) -> list[str]:
    """Return `name==version` for each `name>=version`."""
    return [dependency.replace(">=", "==") for dependency in dependencies]


if __name__ == "__main__":
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    print("\n".join(oldest(tomllib.loads(text)["project"]["dependencies"])))
