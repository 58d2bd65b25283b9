"""AZee: from a formal description of a sign-language utterance to a signing body.

`azee.compile(text_or_path)` goes the whole way. Importing the package loads almost nothing. In a
notebook, scores, clips, bodies and reports show themselves.
"""

import sys
from typing import Any

from azee.compilation import Compilation, compile  # noqa: A004 - azee.compile, as re.compile
from azee_grammar.diagnostic import AZeeError

__all__ = ["AZeeError", "Compilation", "compile", "load_ipython_extension"]


def load_ipython_extension(ipython: Any) -> None:
    """Let IPython show our objects; automatic if the package is imported in a notebook."""
    from azee.notebook.registration import register

    register(ipython)


if "IPython" in sys.modules and (_running := sys.modules["IPython"].get_ipython()) is not None:
    load_ipython_extension(_running)
