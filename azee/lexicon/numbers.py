"""Numbers as AZee texts write them."""

from __future__ import annotations


def number(value: float) -> str:
    """Return a number with up to three digits behind the point: `.26`, `-1.5`, `0`."""
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    sign, digits = ("-", text[1:]) if text.startswith("-") else ("", text)
    digits = digits.removeprefix("0") or "0"
    return "0" if digits == "0" else sign + digits
