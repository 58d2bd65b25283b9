"""Colours of AZee in the pages, as editors/vscode has them."""

from __future__ import annotations

from typing import ClassVar

from pygments.lexer import RegexLexer, bygroups
from pygments.token import Comment, Keyword, Name, Number, Operator, Punctuation, String, Text

NAME = r'[^\s(),="]+'
SPOKEN = NAME + r'(?: (?=[^\W\d_])[^\s(),="]+)*'
"""After one space the name of a rule goes on while the next word begins with a letter."""


class AZeeLexer(RegexLexer):
    """Tells the words of AZee apart by their first sign."""

    name = "AZee"
    aliases: ClassVar = ["azee"]
    filenames: ClassVar = ["*.azee"]
    tokens: ClassVar = {
        "root": [
            (r"\s+", Text),
            (r"#.*$", Comment.Single),
            (r"^(def)(\s+)(.*?)(?=\s+#|\s*$)", bygroups(Keyword, Text, Name.Function)),
            (r'"[^"]*"', String),
            (r'[+-]?(?:\d+\.?\d*|\.\d+)(?=[\s(),="]|$)', Number),
            (f"[:.]{SPOKEN}", Name.Function),
            (f"'{NAME}", Name.Attribute),
            (rf"[\^?]{NAME}", Name.Variable),
            (f"!{NAME}", Name.Class),
            (f"@{NAME}", Name.Constant),
            (r'(?:use|def)(?=[\s(),="]|$)', Keyword),
            (r"[(),]", Punctuation),
            (r"=", Operator),
            (NAME, Name.Builtin),
            (r".", Text),
        ]
    }
