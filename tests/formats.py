"""The schemas of docs/formats.md, as the page prints them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

PAGE = Path(__file__).parents[1] / "docs" / "formats.md"


def schema(name: str) -> dict[str, Any]:
    """Return the JSON Schema in the block that begins with ```json schema=NAME."""
    blocks = re.findall(
        rf"^```json schema={name}\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S
    )
    (text,) = blocks
    document: dict[str, Any] = json.loads(text)
    return document
