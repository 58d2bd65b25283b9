"""Texts that would take for ever or fill the memory, with the diagnostic that each ends in."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Hostile:
    """A text, and the codes that its check must end in. is_slow: it takes seconds to get there."""

    name: str
    text: str
    codes: tuple[str, ...]
    is_slow: bool = False


def _doubling(count: int) -> str:
    lets = "".join(f"let('x{i + 1}, list(^x{i}, ^x{i}), " for i in range(count))
    return f"let('x0, list(1, 1), {lets}count(^x{count})" + ")" * (count + 1) + "\n"


def _expansion(depth: int) -> str:
    """Every rule applies the one before it twice, with an argument so that nothing is shared."""
    rules = "def r0\n    azop('n, 0, blank(^n))\n"
    for i in range(depth):
        inner = f"r{i}(add(^n, {i})), r{i}(mul(^n, 2))"
        rules += f"def r{i + 1}\n    azop('n, 0, seq(list({inner})))\n"
    return f"{rules}:r{depth}(1)\n"


def _sums(depth: int) -> str:
    """As above, but all of it is right, and the values are small."""
    rules = "def r0\n    azop('n, 0, ^n)\n"
    for i in range(depth):
        rules += f"def r{i + 1}\n    azop('n, 0, add(r{i}(^n), r{i}(neg(^n))))\n"
    return f"{rules}blank r{depth}(1)\n"


def _scores(depth: int) -> str:
    """Every score holds the one before it twice: small in memory, huge as a tree."""
    lets = "".join(f"let('s{i + 1}, seq(list(^s{i}, ^s{i})), " for i in range(depth))
    return f"let('s0, :bien, {lets}^s{depth}" + ")" * (depth + 1) + "\n"


def _circle(count: int) -> str:
    blocks = "".join(
        f"    'B{i} blank(1)\n    'start 'B{(i + 1) % count}:end\n" for i in range(count)
    )
    return f"sync\n    'FIRST blank(1)\n{blocks}"


_TWICE = "azop('x, 0, map(azop('y, 0, range(1, 400)), range(1, 400)))"

HOSTILE = (
    Hostile("50,000 open parentheses", "neg(" * 50_000, ("recursion-limit",)),
    Hostile("5,000 levels, closed", "neg(" * 5000 + "1" + ")" * 5000 + "\n", ("recursion-limit",)),
    Hostile(
        "2,000 levels of lines",
        "".join(" " * i + "seq\n" for i in range(2000)),
        ("recursion-limit",),
    ),
    Hostile("let that doubles a list, 60 times", _doubling(60), ("size-limit",)),
    Hostile("let that doubles a score, 60 times", _scores(60), ("size-limit",)),
    Hostile("rules that apply others twice, 60 deep", _expansion(60), ("step-limit",), True),
    Hostile("rules that add others twice, 60 deep", _sums(60), ("step-limit",)),
    Hostile("a range of 10¹⁵ numbers", "count(range(1, 1000000000000000))\n", ("size-limit",)),
    Hostile("lists of lists", f"map({_TWICE}, range(1, 400))\n", ("size-limit",)),
    Hostile("a number of 1,000,000 digits", f"blank {'9' * 1_000_000}\n", ("bad-number",)),
    Hostile("a rule that applies itself", "def f\n    :f\n:f\n", ("recursion-limit",)),
    Hostile(
        "two rules that apply each other",
        "def f\n    :g\ndef g\n    :f\n:f\n",
        ("recursion-limit",),
    ),
    Hostile("a circle of 2,000 blocks", _circle(2000), ("cyclic-sync",)),
    Hostile("a million words", "list " + "1 " * 1_000_000 + "\n", ("size-limit",), True),
)


def sequence(count: int) -> str:
    """A `seq` of so many `:info-about` of small scores, each on its own line."""
    lines = "        info-about(:t, :i)\n" * count
    return f"def t\n    blank .1\ndef i\n    blank .2\nseq\n    list\n{lines}"


def nested(depth: int) -> str:
    """So many `:info-about`, each the info of the one around it."""
    return "info-about(:chat, " * depth + ":bien" + ")" * depth + "\n"
