"""What a release needs: versions and dependencies that agree, workflows that call make."""

from __future__ import annotations

import ast
import importlib.util
import re
import shutil
import subprocess
import tomllib
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[2]
FILES = ("pyproject.toml", "CITATION.cff", "CHANGELOG.md", "packaging/conda/meta.yaml")
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def _script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, ROOT / "packaging" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_all_files_agree_on_version_and_dependencies() -> None:
    assert list(_script("release").disagreements()) == []


@pytest.mark.parametrize(
    ("file", "before", "after", "told"),
    [
        ("CITATION.cff", "version: 0.1.0", "version: 0.2.0", "CITATION.cff does not have"),
        ("CHANGELOG.md", "## 0.1.0 –", "## 0.2.0 –", "CHANGELOG.md has no section"),
        ("packaging/conda/meta.yaml", "- lark >=1.2.1\n", "", "lark>=1.2.1 is only in pyproject"),
        ("packaging/conda/meta.yaml", "- lark >=1.2.1", "- lark >=1.0", "lark>=1.0 is only there"),
    ],
)
def test_a_file_that_differs_is_named(
    file: str, before: str, after: str, told: str, tmp_path: Path
) -> None:
    for name in FILES:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, tmp_path / name)
    text = (tmp_path / file).read_text(encoding="utf-8")
    assert before in text
    (tmp_path / file).write_text(text.replace(before, after, 1), encoding="utf-8")
    assert any(told in line for line in _script("release").disagreements(tmp_path))


def test_a_tag_needs_its_version_and_a_date() -> None:
    found = list(_script("release").disagreements(tag="v9.9.9"))
    assert any("v9.9.9 is not v" in line for line in found)


def test_the_oldest_dependencies_are_exact() -> None:
    assert _script("oldest").oldest(["click>=8.1", "lark>=1.2"]) == ["click==8.1", "lark==1.2"]


def test_a_wheel_for_a_platform_has_every_kernel() -> None:
    compiled = {
        f"{'.'.join(file.relative_to(place).with_suffix('').parts)}.{node.name}"
        for place in (ROOT / "rig", ROOT / "solver")
        for file in place.rglob("*.py")
        for node in ast.parse(file.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef)
        for decorator in node.decorator_list
        if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "cfunc"
    }
    found = {kernel.full_name for kernel in _script("kernels").kernels()}
    assert found >= compiled
    assert len(compiled) >= 8


def test_kernels_are_compiled_ahead_only_for_platforms_that_are_known() -> None:
    kernels = _script("kernels")
    assert kernels.baseline("linux", "x86_64")[2] == "manylinux_2_17_x86_64"
    for system, machine in (("linux", "riscv64"), ("darwin", "x86_64"), ("win32", "AMD64")):
        with pytest.raises(kernels.NoBaseline, match=r"only on: linux x86_64$"):
            kernels.baseline(system, machine)


class AbortedError(Exception):
    """What the application of hatch was told to end with."""


class Application:
    """Stands for that of hatch."""

    def abort(self, message: str) -> None:
        raise AbortedError(message)


@pytest.fixture
def hook(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The build hook, as on Linux on x86-64."""
    found = _script("build_hook")
    monkeypatch.setattr(found.sys, "platform", "linux")
    monkeypatch.setattr(found.platform, "machine", lambda: "x86_64")
    return found


def _kernels_of(hook: ModuleType) -> Any:
    return hook.Kernels(str(ROOT), {}, None, None, "", "wheel", Application())


def test_the_hook_puts_what_is_compiled_into_a_wheel_for_one_platform(
    hook: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    def compiled(command: list[str], check: bool) -> subprocess.CompletedProcess[bytes]:
        (Path(command[-1]) / "manifest.json").write_text("{}", encoding="utf-8")
        return subprocess.CompletedProcess(command, 0)

    monkeypatch.setattr(hook.subprocess, "run", compiled)
    kernels, data = _kernels_of(hook), {"pure_python": True, "force_include": {}}
    kernels.initialize("editable", data)
    assert data == {"pure_python": True, "force_include": {}}
    kernels.initialize("standard", data)
    assert (data["pure_python"], data["tag"]) == (False, "py3-none-manylinux_2_17_x86_64")
    ((folder, place),) = data["force_include"].items()  # type: ignore[attr-defined]
    assert place == "azee_rig/compiled"
    assert [file.name for file in Path(folder).iterdir()] == ["manifest.json"]
    kernels.finalize("standard", data, "")
    assert not Path(folder).exists()


def test_the_hook_tells_what_stops_it_in_a_sentence(
    hook: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed = subprocess.CompletedProcess[bytes]([], 1)
    monkeypatch.setattr(hook.subprocess, "run", lambda command, check: failed)
    with pytest.raises(AbortedError, match="could not be compiled"):
        _kernels_of(hook).initialize("standard", {"force_include": {}})
    monkeypatch.setattr(hook.platform, "machine", lambda: "riscv64")
    with pytest.raises(AbortedError, match="only on: linux x86_64"):
        _kernels_of(hook).initialize("standard", {"force_include": {}})


def test_a_wheel_is_pure_unless_it_is_asked_for_a_platform() -> None:
    """Any `pip install` of the sources must work without numba at hand to build."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    hook = project["tool"]["hatch"]["build"]["targets"]["wheel"]["hooks"]["custom"]
    assert hook["enable-by-default"] is False
    assert (ROOT / hook["path"]).is_file()
    assert "/packaging" in project["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_workflows_call_targets_that_exist(path: Path) -> None:
    targets = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M))
    workflow = yaml.safe_load(path.read_text(encoding="utf-8"))
    called = []
    for job in workflow["jobs"].values():
        versions = job.get("strategy", {}).get("matrix", {}).get("versions", [""])
        for step in job["steps"]:
            assert ("run" in step) != ("uses" in step)
            run = step.get("run", "")
            filled = (run.replace("${{ matrix.versions }}", version) for version in versions)
            called += [m[1] for m in (re.match(r"make (\S+)", line) for line in filled) if m]
    assert called
    assert set(called) <= targets


def test_systems_and_versions_of_python_that_are_tried() -> None:
    text = (ROOT / ".github" / "workflows" / "test.yml").read_text(encoding="utf-8")
    matrix = yaml.safe_load(text)["jobs"]["check"]["strategy"]["matrix"]
    assert {system.partition("-")[0] for system in matrix["system"]} == {
        "ubuntu",
        "macos",
        "windows",
    }
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    classified = re.findall(r"Programming Language :: Python :: (3\.\d+)", project)
    assert matrix["python"] == classified


def test_the_citation_has_what_its_format_requires() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors", "version", "license"} <= set(citation)
    for reference in citation["references"]:
        assert {"type", "title", "authors"} <= set(reference)
