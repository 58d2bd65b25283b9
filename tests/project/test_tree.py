"""Nothing in the tree depends on the machine it was written on, or names a registry."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MACHINE_PATH = re.compile(r"(?<![\w.~-])/(?:work|tmp|root|home|Users)/\w")
REGISTRY = re.compile(r"https?://[\w.-]*(?:pypi|python|npm)[\w.-]*/(?:simple|packages|[\w@]\S*/-/)")


def _committed_texts() -> list[Path]:
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=False,
    )
    if listed.returncode:
        pytest.skip("not a git checkout")
    names = listed.stdout.decode().split("\0")
    here = Path(__file__).relative_to(ROOT)
    return [ROOT / name for name in names if name and Path(name) != here]


@pytest.mark.parametrize("pattern", [MACHINE_PATH, REGISTRY], ids=["machine path", "registry"])
def test_no_machine_and_no_registry_is_named(pattern: re.Pattern[str]) -> None:
    found = []
    for path in _committed_texts():
        if not path.is_file():
            continue
        data = path.read_bytes()
        if b"\0" in data[:8192]:
            continue
        for number, line in enumerate(data.decode("utf-8").splitlines(), 1):
            if pattern.search(line):
                found.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()[:100]}")
    assert found == []


def test_the_patterns_find_what_they_are_for() -> None:
    assert MACHINE_PATH.search("open('/home/ann/x')")
    assert not MACHINE_PATH.search("docs/home/index.md")
    address = "https://" + "registry.npm.example/three/-/three-1.tgz"
    assert REGISTRY.search(f'"resolved": "{address}"')


def test_every_pinned_version_is_exact_and_every_dependency_is_pinned() -> None:
    import tomllib

    pinned = {}
    for line in (ROOT / "constraints.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            name, version = re.fullmatch(r"([\w.-]+)==([\w.]+)", line).groups()  # type: ignore[union-attr]
            pinned[_normal(name)] = version
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    wanted = project["project"]["dependencies"] + project["build-system"]["requires"]
    for extra in project["project"]["optional-dependencies"].values():
        wanted += extra
    named = {_normal(re.match(r"[\w.-]+", want)[0]) for want in wanted}  # type: ignore[index]
    ours = {"azee", "azee-ngt"}
    missing = named - set(pinned) - ours
    assert missing == set()


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()
