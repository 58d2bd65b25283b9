"""How Sphinx makes the site: Markdown by MyST, docstrings by autodoc, the theme furo.

Nothing is fetched while it is built, and nothing is loaded from elsewhere when it is read.
"""

from __future__ import annotations

import re
import sys
from importlib.metadata import version as version_of
from pathlib import Path
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).parent))

from docstrings import as_rst
from lexer import AZeeLexer

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "azee"
author = "the authors of azee"
release = version_of("azee")
version = release
extensions = ["myst_parser", "sphinx.ext.autodoc"]
html_theme = "furo"
html_title = f"azee {release}"
html_favicon = "icon.svg"
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False
html_last_updated_fmt = None
html_css_files = ["site.css"]
highlight_language = "none"
# Options of code blocks, such as `error=syntax`, are for the tests that run the pages.
myst_heading_anchors = 6
autodoc_default_options = {"members": True, "member-order": "bysource", "show-inheritance": True}
autodoc_preserve_defaults = True
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 88

ADDRESS = re.compile(r" at 0x[0-9a-f]+")


def _docstring(
    _app: Sphinx, _what: str, _name: str, _object: object, _options: object, lines: list[str]
) -> None:
    lines[:] = as_rst(lines)


def setup(app: Sphinx) -> None:
    """Take part in reading docstrings, and colour AZee."""
    app.connect("autodoc-process-docstring", _docstring)
    app.add_lexer("azee", AZeeLexer)
