"""Mistakes in single words, and their messages."""

from __future__ import annotations

import re
import unicodedata

from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span

APOSTROPHES = frozenset("’‘‛′´`ʼ＇")
"""Characters that word processors and keyboards write instead of a straight apostrophe."""

QUOTES = frozenset("“”„‟″«»＂")
"""Characters that they write instead of straight quotation marks."""

MINUSES = "−–—‐‑‒﹣－"
"""Characters that they write instead of a hyphen-minus."""

INVISIBLE = re.compile(
    "[\0-\x08\x0e-\x1b\x7f-\x84\x86-\x9f\u00ad\u061c\u180e\u200b\u200e\u200f\u202a-\u202e"
    "\u2060-\u206f\ufeff\ufff9-\ufffb\ud800-\udfff\U000e0000-\U000e007f]"
)
"""Controls, marks of direction and other invisible characters (but not joiners)."""

_CLOSING = {"“": "”", "„": "“”", "«": "»", "»": "«", "”": "”", "‟": "”", "″": "″", "＂": "＂"}
_MINUS_IN_REF = re.compile(rf":([{MINUSES}])\.?[0-9]")
_LIKE_NUMBER = re.compile(rf"[+\-{MINUSES}]?\.?[0-9]")
_UNITS = r"(?:s|ms|m|cm|mm|deg|°|%)"
_NUMBER_AND_UNIT = re.compile(rf"([+\-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)){_UNITS}")
_BRACKETS = {
    "[": "a list is written `list` with its items as operands",
    "{": "indentation or parentheses show what belongs together",
    "]": "a list is written `list` with its items as operands",
    "}": "indentation or parentheses show what belongs together",
    ";": "the end of a line ends an expression; `#` opens a comment",
    "#": "`#` opens a comment at the start of a line or after a space",
}
_SIGILS = ":.'^!@?#"


def looks_like_number(word: str) -> bool:
    """Whether a word is more likely a misspelt number than a name.

    After a dot, a name may begin with a digit (`.2nd`), so only units and signs decide.
    """
    if word.startswith("."):
        return bool(_NUMBER_AND_UNIT.fullmatch(word)) or (
            _LIKE_NUMBER.match(word) is not None and not any(c.isalpha() for c in word)
        )
    return bool(_LIKE_NUMBER.match(word)) or (word[0].isdecimal() and not word[0].isascii())


def bad_number(span: Span) -> Diagnostic:
    """Report a word that begins like a number."""
    word = span.text
    if word[0] in MINUSES and _LIKE_NUMBER.match(word):
        return not_a_minus(span)
    if unit := _NUMBER_AND_UNIT.fullmatch(word):
        return Diagnostic(
            "bad-number",
            f"a number has no unit: `{word}`",
            span,
            help=f"write `{unit[1]}`; times are in seconds, lengths in metres, angles in degrees",
        )
    if re.fullmatch(r"[+-]?[0-9.]+[eE][+-]?[0-9]+", word):
        return Diagnostic(
            "bad-number",
            f"a number has no exponent: `{word}`",
            span,
            help="write all its digits, as in `.001`",
        )
    if not word.isascii() and word.isdecimal():
        plain = "".join(str(unicodedata.decimal(c)) for c in word)
        return Diagnostic(
            "bad-number",
            f"numbers are written with the digits 0 to 9, not `{word}`",
            span,
            help=f"write `{plain}`",
        )
    return Diagnostic(
        "bad-number",
        f"`{word}` is not a number",
        span,
        help="numbers look like `2`, `.5`, `-.25` or `1.75`",
    )


def not_a_minus(span: Span) -> Diagnostic:
    """Report a dash in the place of a minus."""
    text = span.text
    name = unicodedata.name(text[0], "a dash").lower()
    return Diagnostic(
        "bad-number",
        f"`{text}` does not begin with a minus sign",
        span,
        label=f"this is the character {name}, U+{ord(text[0]):04X}",
        help=f"write `-{text[1:]}`, with the hyphen of the keyboard",
    )


def minus_in_ref(word: str) -> tuple[int, int] | None:
    """Return where a ref such as `'A:start:−.25` has a dash in the place of a minus."""
    found = _MINUS_IN_REF.search(word)
    return (found.start(1), len(word)) if found else None


def decimal_comma(span: Span) -> Diagnostic:
    """Report `0,5`."""
    return Diagnostic(
        "bad-number",
        f"`{span.text}` has a decimal comma",
        span,
        help=f"write `{span.text.replace(',', '.')}`",
    )


def too_many_digits(span: Span, digits: int, most: int) -> Diagnostic:
    """Report a number with more digits than any computation keeps."""
    return Diagnostic(
        "bad-number",
        f"this number has {digits} digits; {most} is the most",
        span,
        help="round it: a thousandth is finer than any signer moves",
    )


def too_many_words(span: Span, most: int) -> Diagnostic:
    """Report the first word beyond the limit of words."""
    return Diagnostic(
        "size-limit",
        f"this text has more than {most:,} words, signs and comments; the rest of it is not read",
        span,
        help="divide it into several files",
    )


def curly_apostrophe(span: Span) -> Diagnostic:
    """Report `’word`."""
    return Diagnostic(
        "syntax",
        f"`{span.text}` begins with a curly apostrophe",
        span,
        help=f"write `'{span.text[1:]}`, with the apostrophe of the keyboard",
    )


def curly_quotes(span: Span) -> Diagnostic:
    """Report `“text”`."""
    inside = span.text[1:].rstrip("".join(QUOTES))
    return Diagnostic(
        "syntax",
        "a text stands between straight quotation marks",
        span,
        help=f'write `"{inside}"`',
    )


def closing_quote(text: str, start: int, end: int) -> int:
    """Return where a text that begins with a curly quotation mark ends, at most at `end`."""
    closing = _CLOSING[text[start]] + '"'
    for at in range(start + 1, end):
        if text[at] in closing:
            return at + 1
    return end


def unclosed_text(span: Span) -> Diagnostic:
    """Report a quotation mark without its partner on the line."""
    return Diagnostic(
        "unclosed-text",
        "this text is never closed",
        span,
        label='no second `"` on this line',
        help="a text begins and ends on the same line",
    )


def missing_space(span: Span) -> Diagnostic:
    """Report two words without a space between them."""
    return Diagnostic(
        "syntax",
        f"a space is missing before `{shortened(span.text)}`",
        span,
    )


def missing_name(span: Span) -> Diagnostic:
    """Report a sigil without a name."""
    what = {
        ":": "the name of a rule",
        ":#": "the name of a posture rule",
        ".": "the name of a rule",
        "'": "a word",
        "^": "the name of a parameter",
        "!": "the name of a bone",
        "@": "the name of a site",
        "?": "a name",
    }[span.text]
    return Diagnostic(
        "syntax", f"{what} must follow `{span.text}` directly", span, label="nothing follows it"
    )


def rule_name(name: str, span: Span) -> Diagnostic | None:
    """Describe the mistake in the name of a rule, if there is any."""
    if name[0] in _SIGILS:
        bare = name.lstrip(_SIGILS)
        return Diagnostic(
            "syntax",
            f"the name of a rule cannot begin with `{name[0]}`",
            span,
            help=f"write `{span.text.replace(name, bare)}`" if bare else None,
        )
    if found := re.search(r"""[(),="]""", name):
        at = span.start + found.start()
        return Diagnostic(
            "syntax",
            f"the name of a rule cannot contain `{found.group()}`",
            Span(span.source, at, at + 1),
            help="`azop` declares what a rule takes; `#` after a space opens a comment",
        )
    for gap in re.finditer(r"\s+", name):
        if gap.group() != " " or not name[gap.end()].isalpha():
            at = span.start + gap.start()
            return Diagnostic(
                "syntax",
                "the words of a name are separated by one space and begin with a letter",
                Span(span.source, at, at + len(gap.group()) + 1),
            )
    return None


def definition_without_name(span: Span) -> Diagnostic:
    """Report `def` without a name."""
    return Diagnostic(
        "syntax",
        "this definition has no name",
        span,
        help="write it after `def` on the same line, as in `def personne`",
    )


def bracket(span: Span) -> Diagnostic | None:
    """Report characters of other programming languages."""
    word = unicodedata.normalize("NFC", span.text)
    for c in (word[0], word[-1]):
        if c in _BRACKETS:
            return Diagnostic("syntax", f"`{c}` means nothing in AZee", span, help=_BRACKETS[c])
    return None


def invisible(span: Span) -> Diagnostic:
    """Report an invisible character."""
    code = ord(span.text)
    name = unicodedata.name(span.text, "a control character").lower()
    return Diagnostic(
        "syntax",
        f"an invisible character stands in this word: {name}, U+{code:04X}",
        span,
        help="delete it; it often comes along when text is pasted",
    )


def shortened(text: str, most: int = 40) -> str:
    """Return a text, shortened to fit into a message."""
    return text if len(text) <= most else f"{text[: most - 1]}…"
