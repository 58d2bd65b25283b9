"""Tells whether the project can be released as its version says.

Usage: release.py [TAG]. pyproject.toml, CITATION.cff, the conda recipe and CHANGELOG.md must agree
on the version and on the dependencies; a tag must be `v` and the version, and its section of the
changelog must have a date.
"""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
RECIPE = Path("packaging") / "conda" / "meta.yaml"


def disagreements(root: Path = ROOT, tag: str | None = None) -> Iterator[str]:
    """Yield a line for each file that does not agree."""
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    version = project["version"]
    recipe = (root / RECIPE).read_text(encoding="utf-8")
    for name, text, pattern in (
        ("CITATION.cff", (root / "CITATION.cff").read_text(encoding="utf-8"), r"^version: (\S+)$"),
        (RECIPE.as_posix(), recipe, r'set version = "([^"]+)"'),
    ):
        found = re.search(pattern, text, re.M)
        if found is None or found[1] != version:
            yield f"{name} does not have the version {version}"
    run = recipe[recipe.index("  run:") : recipe.index("\ntest:")]
    listed = {"".join(line.split()[1:]) for line in run.splitlines() if "- " in line}
    wanted = {*project["dependencies"], f"python{project['requires-python']}"}
    for dependency in sorted(listed ^ wanted):
        where = "only in pyproject.toml" if dependency in wanted else "only there"
        yield f"{RECIPE.as_posix()}: {dependency} is {where}"
    changelog = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    section = re.search(rf"^## {re.escape(version)} – (\S+)$", changelog, re.M)
    if section is None:
        yield f"CHANGELOG.md has no section for {version}"
    elif tag is not None and not re.fullmatch(r"\d{4}-\d\d-\d\d", section[1]):
        yield f"the section of CHANGELOG.md for {version} has no date"
    if tag is not None and tag != f"v{version}":
        yield f"the tag {tag} is not v{version}"


def main(arguments: Sequence[str]) -> int:
    """Print what does not agree; 1 if anything does not."""
    found = list(disagreements(tag=arguments[0] if arguments else None))
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
