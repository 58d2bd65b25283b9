"""What all tests share: Hypothesis' profiles, the body, and the programs that tests run."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn
from uuid import uuid4

import pytest
from hypothesis import HealthCheck, settings
from programs import NODE_FOLDER, WEB_FOLDER, Node, Python
from servers import NoServerError, postgresql_server

if TYPE_CHECKING:
    from azee_rig.rig import Rig

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile("quick", settings.get_profile("repeatable"), max_examples=25)
settings.register_profile("search", settings.get_profile("repeatable"), derandomize=False)
settings.register_profile("long", settings.get_profile("search"), max_examples=5000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))


def pytest_configure(config: pytest.Config) -> None:
    """Keep what programs keep in a folder of these tests alone, and each process to one core.

    Tests run side by side: threads that OpenBLAS starts beside them only wait for each other, and
    what one worker of xdist keeps, all find in the folder that they have from the first process.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if hasattr(config, "workerinput"):
        return
    folder = tempfile.mkdtemp(prefix="azee-tests-")
    os.environ["AZEE_CACHE"] = folder
    config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what needs Node or a browser by the fixtures it asks for."""
    for item in items:
        for name in {"node", "browser"}.intersection(getattr(item, "fixturenames", ())):
            item.add_marker(name)


@pytest.fixture(scope="session")
def signer() -> Rig:
    """The body that ships."""
    from azee_rig.load import load_rig

    return load_rig("signer")


@pytest.fixture
def python(tmp_path: Path) -> Python:
    """Python in a process of its own, in the test's own folder."""
    return Python(tmp_path)


@pytest.fixture(scope="session")
def node() -> Node:
    """Node with the packages of tests/node."""
    return Node(_program(("node",), "Node"))


@pytest.fixture(scope="session")
def web(node: Node) -> Node:
    """Node with the packages that build the pages of azee/web."""
    if not (WEB_FOLDER / "node_modules" / "vite").exists():
        _missing("the packages of azee/web are not installed: `make node`")
    return node.in_folder(WEB_FOLDER)


@pytest.fixture(scope="session")
def browser(node: Node) -> Node:
    """Node that may start a headless Chromium."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    return Node(node.program, chromium=_program(names, "Chromium"))


@pytest.fixture(scope="session")
def assimp() -> str:
    """Path of Assimp's command, a reader of glTF that is not ours."""
    found = shutil.which("assimp")
    if found is None:
        _missing("Assimp is not installed: Debian's assimp-utils")
    assert found is not None
    return found


@pytest.fixture(scope="session")
def opengl() -> str:
    """The name of OpenGL's renderer."""
    from azee.export.pictures.opengl.context import NoOpenGLError, OpenGL

    try:
        with OpenGL() as there:
            return there.name
    except NoOpenGLError as error:
        _missing(f"{error}: {error.remedy}")


@pytest.fixture(scope="session")
def postgresql() -> Iterator[str]:
    """URL of a PostgreSQL that only these tests use, with {} for the name of a database."""
    with ExitStack() as stack:
        try:
            url = stack.enter_context(postgresql_server())
        except NoServerError as error:
            _missing(str(error))
        yield url


@pytest.fixture(params=["sqlite", "postgresql"])
def database_place(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """Where a database may be made: a test that asks for it runs for both kinds."""
    if request.param == "sqlite":
        return str(tmp_path / "signs.db")
    import psycopg

    server: str = request.getfixturevalue("postgresql")
    name = f"signs_{uuid4().hex}"
    with psycopg.connect(server.format("postgres"), autocommit=True) as connection:
        connection.execute(f'CREATE DATABASE "{name}"'.encode())
    return server.format(name)


def _program(names: Sequence[str], title: str) -> str:
    """Path of the first program that exists; else the test is skipped, or fails in CI."""
    found = next(filter(None, map(shutil.which, names)), None)
    if found is None:
        _missing(f"{title} is not installed")
    if not (NODE_FOLDER / "node_modules" / "three").exists():
        _missing("the packages of tests/node are not installed: `make node`")
    assert found is not None
    return found


def _missing(reason: str) -> NoReturn:
    if os.environ.get("AZEE_REQUIRE_BROWSER"):
        pytest.fail(reason)
    pytest.skip(reason)
