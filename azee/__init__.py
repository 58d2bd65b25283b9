"""AZee: from a formal description of a sign-language utterance to a signing body.

`azee.compile(text_or_path)` goes the whole way; importing the package loads next to nothing.
"""

from azee.compilation import Compilation, compile  # noqa: A004 - azee.compile, as re.compile
from azee_grammar.diagnostic import AZeeError

__all__ = ["AZeeError", "Compilation", "compile"]
