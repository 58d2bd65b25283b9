"""The pages of the API reference: one a package, with a section for each public module."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from pathlib import PurePosixPath

PACKAGES = (
    "azee_grammar",
    "azee_rig",
    "azee_solver",
    "azee.score",
    "azee.clip",
    "azee.quality",
    "azee.export",
    "azee.signs",
    "azee.corpus",
    "azee.blocks",
    "azee.assist",
)
"""What programs import: data, and what reads, makes and writes it.

How a text becomes a movement (`azee.lang`, `azee.motion`) and the tools are read in their sources.
"""

INNER = ("build", "importing", "kernels", "migrations")
"""Packages inside of these that no program calls, such as loops for numba."""

HEAD = """# Python API

`azee.compile` goes the whole way; [the library](../library.md) explains it. The packages below it
are its parts. CONTRIBUTING has the [map](../contributing.md#where-things-are) of who imports whom.

```{eval-rst}
.. automodule:: azee
   :no-members:

.. autofunction:: azee.compile

.. autoclass:: azee.Compilation
   :members:
```
"""


def pages() -> Iterator[tuple[PurePosixPath, str]]:
    """Yield each page's place and text."""
    entries = "\n".join(PACKAGES)
    yield PurePosixPath("api/index"), f"{HEAD}\n```{{toctree}}\n{entries}\n```\n"
    for package in PACKAGES:
        sections = "\n".join(map(_section, _modules(package)))
        title = f"# {package}\n\n```{{eval-rst}}\n.. automodule:: {package}\n   :no-members:\n```\n"
        yield PurePosixPath("api") / package, f"{title}\n{sections}"


def _modules(package: str) -> Iterator[str]:
    """Yield the names of the modules in a package, and in those inside of it."""
    for found in pkgutil.walk_packages(import_module(package).__path__, f"{package}."):
        inner = found.name.removeprefix(f"{package}.").split(".")
        if not found.ispkg and not any(n in INNER or n.startswith("_") for n in inner):
            yield found.name


def _section(module: str) -> str:
    return f"## {module}\n\n```{{eval-rst}}\n.. automodule:: {module}\n```\n"
