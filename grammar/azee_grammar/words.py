"""The words of one line: tokens with the positions of the text as written."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable

from azee_grammar import misspelt
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Source, Span
from azee_grammar.token import BAD, Token

MOST_WORDS = 150_000
"""The most words of a text, comments and punctuation included. A news item has about 200."""

MOST_DIGITS = 17
"""The most digits of a number: enough to distinguish any two float64."""

_WORD = re.compile(r"""[^\s(),="]+""")
_SPACE = re.compile(r"\s+")
_COMMENT = re.compile(r"\s#")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
_SIGILS = {
    ":": "RULE",
    ".": "REFERENCE",
    "'": "SYMBOL",
    "^": "PARAMETER",
    "!": "BONE",
    "@": "SITE",
    "?": "HOLE",
}
_PUNCTUATION = {"(": "_OPEN", ")": "CLOSE", ",": "_COMMA", "=": "_EQUALS"}
_SIDES = frozenset({"s", "w", "L", "R"})
_KEYWORDS = {"use": "USE", "def": "DEF"}


class WordReader:
    """Splits lines of a source into tokens, and reports mistakes in words.

    A misspelt word that can only mean one thing still gives its token, so that one mistake does not
    hide the next. Any other misspelt word gives a BAD token.
    """

    def __init__(
        self,
        source: Source,
        report: Callable[[Diagnostic], None],
        comments: list[tuple[int, int]],
    ) -> None:
        self.source = source
        self.text = source.text
        self._report = report
        self._said = 0
        self.comments = comments
        self.left = MOST_WORDS  # words that may still come; below zero, reading stops
        self._foreign = False  # whether a bracket of another language was reported on this line

    def read(self, start: int, end: int) -> list[Token]:
        """Return the tokens of `text[start:end]`, the part of a line after its indentation."""
        text = self.text
        tokens: list[Token] = []
        self._foreign = False
        at = start
        spaced = True
        while at < end:
            space = _SPACE.match(text, at, end)
            if space:
                at = space.end()
                spaced = True
                continue
            c = text[at]
            said = self._said
            if c == "#" and spaced:
                self.comment(at, end)
                break
            glued = not spaced and bool(tokens) and tokens[-1].kind not in _BEFORE_OPEN
            if c in _PUNCTUATION:
                kind = "_CALL" if c == "(" and glued else _PUNCTUATION[c]
                token = Token(kind, at, at + 1)
            elif c == '"':
                token = self._text(at, end)
            else:
                token = self._word(at, end)
            if glued and token.kind not in _AFTER_WORD:
                if self._said == said:
                    self._say(misspelt.missing_space(self._span(token.start, token.end)))
                token = token._replace(kind=BAD)
            self._count(token.start)
            if self.left < 0:
                return [*tokens, token._replace(kind=BAD)]
            tokens.append(token)
            at = token.end
            spaced = False
        return tokens

    def comment(self, start: int, end: int) -> None:
        """Store the place of a comment."""
        self._count(start)
        self.comments.append((start, end))

    def definition(self, start: int, end: int) -> list[Token]:
        """Return the tokens of a `def` line, whose name is the rest of the line."""
        head = Token("DEF", start, start + 3)
        comment = _COMMENT.search(self.text, start, end)
        if comment:
            self.comment(comment.end() - 1, end)
        rest = self.text[start + 3 : comment.start() if comment else end]
        name = rest.strip()
        at = start + 3 + len(rest) - len(rest.lstrip())
        if not name:
            self._say(misspelt.definition_without_name(self._span(start, start + 3)))
            return [head, Token(BAD, head.end, head.end)]
        token = Token("NAME", at, at + len(name), self._visible(name, at))
        problem = misspelt.rule_name(name, self._span(token.start, token.end))
        if problem:
            self._say(problem)
            return [head, token._replace(kind=BAD)]
        return [head, token]

    def _count(self, start: int) -> None:
        if self.left == 0:
            self._say(misspelt.too_many_words(self._span(start, start + 1), MOST_WORDS))
        self.left -= 1

    def _say(self, diagnostic: Diagnostic) -> None:
        self._said += 1
        self._report(diagnostic)

    def _span(self, start: int, end: int) -> Span:
        return Span(self.source, start, end)

    def _text(self, start: int, end: int) -> Token:
        close = self.text.find('"', start + 1, end)
        if close < 0:
            self._say(misspelt.unclosed_text(self._span(start, end)))
            return Token(BAD, start, end)
        return Token("TEXT", start, close + 1, self.text[start + 1 : close])

    def _word(self, start: int, end: int) -> Token:
        found = _WORD.match(self.text, start, end)
        assert found, "every other character is punctuation or white space"
        word = found.group()
        called = self.text.startswith("(", found.end()) and found.end() < end
        kind = _SIGILS.get(word[0])
        if _NUMBER.fullmatch(word):
            return self._number(start, word)
        number = not called and misspelt.looks_like_number(word)
        if kind == "RULE" or (kind == "REFERENCE" and not number):
            return self._rule(start, end, found.end())
        if kind and not number:
            return self._named(kind, start, word)
        return self._bare(start, end, word, called)

    def _number(self, start: int, word: str) -> Token:
        token = Token("NUMBER", start, start + len(word), word)
        digits = sum(c.isdigit() for c in word)
        if digits > MOST_DIGITS:
            span = self._span(token.start, token.end)
            self._say(misspelt.too_many_digits(span, digits, MOST_DIGITS))
            return token._replace(text="0")
        return token

    def _rule(self, start: int, end: int, word_end: int) -> Token:
        """Read the name of a rule; after one space it continues if a word begins with a letter."""
        text = self.text
        posture = text.startswith(":#", start)
        kind = "POSTURE" if posture else _SIGILS[text[start]]
        name_start = start + (2 if posture else 1)
        at = word_end
        while at + 1 < end and text[at] == " " and text[at + 1].isalpha():
            found = _WORD.match(text, at + 1, end)
            assert found, "a letter begins a word"
            at = found.end()
        if name_start == word_end:
            self._say(misspelt.missing_name(self._span(start, word_end)))
            return Token(BAD, start, word_end)
        name = text[name_start:at]
        if problem := misspelt.rule_name(name, self._span(start, at)):
            self._say(problem)
            return Token(BAD, start, at)
        return Token(kind, start, at, self._visible(name, name_start))

    def _named(self, kind: str, start: int, word: str) -> Token:
        stop = start + len(word)
        if len(word) == 1:
            self._say(misspelt.missing_name(self._span(start, stop)))
            return Token(BAD, start, stop)
        if kind == "SYMBOL" and (place := misspelt.minus_in_ref(word)):
            self._say(misspelt.not_a_minus(self._span(start + place[0], start + place[1])))
        return Token(kind, start, stop, self._visible(word[1:], start + 1))

    def _bare(self, start: int, end: int, word: str, called: bool) -> Token:
        stop = start + len(word)
        span = self._span(start, stop)
        first = _normal(word)[0]
        if word in _SIDES:
            return Token("SIDE", start, stop, word)
        if word in _KEYWORDS and not called:
            return Token(_KEYWORDS[word], start, stop, word)
        if first in misspelt.QUOTES:
            return self._curly_text(start, end)
        if first in misspelt.APOSTROPHES:
            self._say(misspelt.curly_apostrophe(span))
            return Token("SYMBOL", start, stop, self._visible(word, start))
        if not called and misspelt.looks_like_number(word):
            self._say(misspelt.bad_number(span))
            return Token("NUMBER", start, stop, "0")
        if problem := misspelt.bracket(span):
            if not self._foreign:
                self._say(problem)
            self._foreign = True
            return Token(BAD, start, stop)
        return Token("OPERATOR", start, stop, self._visible(word, start))

    def _curly_text(self, start: int, end: int) -> Token:
        close = misspelt.closing_quote(self.text, start, end)
        self._say(misspelt.curly_quotes(self._span(start, close)))
        return Token("TEXT", start, close, self.text[start + 1 : close - 1])

    def _visible(self, name: str, start: int) -> str:
        """Return the name at `start` in NFC; report an invisible character."""
        if found := misspelt.INVISIBLE.search(name):
            at = start + found.start()
            self._say(misspelt.invisible(self._span(at, at + 1)))
        return _normal(name)


def _normal(name: str) -> str:
    return unicodedata.normalize("NFC", name)


_BEFORE_OPEN = frozenset({"_OPEN", "_CALL", "_COMMA", "_EQUALS"})
_AFTER_WORD = frozenset({"_CALL", "CLOSE", "_COMMA", "_EQUALS", BAD})
