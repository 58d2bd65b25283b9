"""Editors colour a text word by word as the parser reads it."""

from __future__ import annotations

import json
import re
from pathlib import Path

from programs import Node

from azee_grammar.layout import LayoutReader
from azee_grammar.library import shipped
from azee_grammar.source import Source
from azee_grammar.token import BAD

ROOT = Path(__file__).parents[2]
GRAMMAR = ROOT / "editors" / "vscode" / "syntaxes" / "azee.tmLanguage.json"

SCOPES = {
    "RULE": "entity.name.function.azee",
    "POSTURE": "entity.name.function.posture.azee",
    "REFERENCE": "entity.name.function.reference.azee",
    "SYMBOL": "constant.other.symbol.azee",
    "PARAMETER": "variable.parameter.azee",
    "HOLE": "variable.other.hole.azee",
    "BONE": "support.class.bone.azee",
    "SITE": "support.constant.site.azee",
    "SIDE": "constant.language.side.azee",
    "NUMBER": "constant.numeric.azee",
    "TEXT": "string.quoted.double.azee",
    "OPERATOR": "support.function.operator.azee",
    "DEF": "keyword.control.definition.azee",
    "NAME": "entity.name.function.definition.azee",
    "USE": "keyword.control.azee",
    "_OPEN": "punctuation.section.parens.begin.azee",
    "_CALL": "punctuation.section.parens.begin.azee",
    "CLOSE": "punctuation.section.parens.end.azee",
    "_COMMA": "punctuation.separator.operand.azee",
    "_EQUALS": "keyword.operator.assignment.azee",
}
COMMENT = "comment.line.number-sign.azee"
Word = tuple[int, int, int, str]

TRICKY = (
    ":une personne 'loc ^Rssp\n:f s\n:f  s\n.nb-5\n.5\n.2nd\n:x#y\n:#a b  c # d\n",
    "def aujourd'hui  # a comment\ndef x# y\n    use\ndef(1)\ndef\tü é\n",
    "\ufeffdef first\n    key(-.5,+1.) # a\r\n  # b\r\nplace(@I_TIP(w), !thumb(s, 3))\n",
    ':e\u0301te\u0301 \U0001f600\n\'\U0001f600 ^\U0001f600x (s) =s,"é\U0001f600" s\n',
    "seq# not a comment\n:a (?b)\n+.5.\n1.2.3 12x\n",
)


def texts() -> list[str]:
    files = [*shipped().rglob("*.azee"), *(ROOT / "examples").rglob("*.azee")]
    found = [path.read_text(encoding="utf-8") for path in sorted(files)]
    for page in sorted((ROOT / "docs").rglob("*.md")):
        text = page.read_text(encoding="utf-8")
        found += re.findall(r"^```azee[^\n]*\n(.*?)^```$", text, re.M | re.S)
    return [*found, *TRICKY]


def words_of_the_parser(text: str) -> tuple[set[Word], set[int]]:
    """Return the words, and the lines that the parser does not read to their end."""
    reader = LayoutReader(Source("text", text))
    items = list(reader.items())
    lines = [m.span() for m in re.finditer(r"[^\r\n]*(?:\r\n|\r|\n|$)", text)]

    def place(start: int, end: int, scope: str) -> Word:
        number = next(n for n, (first, last) in enumerate(lines) if start < last or last == first)
        first = lines[number][0]
        units = [len(text[first:at].encode("utf-16-le")) // 2 for at in (start, end)]
        return number, units[0], units[1], scope

    words = {place(start, end, COMMENT) for start, end in reader.comments}
    doubtful = set()
    for item in items:
        for token in item.tokens:
            if token.kind == BAD:
                doubtful.add(place(token.start, token.end, "")[0])
            elif token.kind in SCOPES:
                words.add(place(token.start, token.end, SCOPES[token.kind]))
        for diagnostic in item.diagnostics:
            if diagnostic.span:
                doubtful.add(place(diagnostic.span.start, diagnostic.span.end, "")[0])
    return words, doubtful


def test_every_shipped_rule_example_and_block_of_the_manual(node: Node, tmp_path: Path) -> None:
    every = texts()
    file = tmp_path / "texts.json"
    file.write_text(json.dumps(every), encoding="utf-8")
    answers = json.loads(node("textmate.mjs", GRAMMAR, file))
    compared = 0
    for text, answer in zip(every, answers, strict=True):
        theirs = {(line, start, end, scope) for line, start, end, scope in answer}
        ours, doubtful = words_of_the_parser(text)
        read = {word[0] for word in ours}
        seen = {w for w in theirs if w[0] not in doubtful and w[0] in read}
        expected = {w for w in ours if w[0] not in doubtful}
        assert seen == expected, text
        compared += len(expected)
    assert compared > 3000
