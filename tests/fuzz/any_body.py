"""What must hold of any file of a body, and how one is damaged; for `make fuzz-bodies`."""

from __future__ import annotations

import copy
import json
import random
import struct
import tempfile
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

from azee_rig.importing import importer
from azee_rig.importing.fault import BodyError
from azee_rig.importing.folder import write_folder
from azee_rig.load import load_rig
from azee_rig.mesh import BodyMesh
from azee_rig.rig import Rig, RigSite

Path_ = tuple[str | int, ...]

ODD: tuple[Any, ...] = (
    *(None, True, False, -1, 0, 1, 2, 3, 5, 10**6, 2**31, 2**63, 10**400, -(10**400)),
    *(1e308, 1e-308, 1.5, float("nan"), float("inf"), 5126, 5121, "VEC3", "SCALAR", "MAT4"),
    *("x", "", "\ud800", "a\0b", "data:;base64,ä", [], {}, [[]], [0], [1, 2, 3], {"a": 1}),
)
"""Values that are put in the place of others."""
NUMBERS = (0, -1, 1e-9, 1e-4, -0.5, 1000, 1e9, 1e30, 1e300)
LONGEST = 600
"""Letters that a message may have."""
KEYS = (
    *("extensions", "extras", "sparse", "skin", "mesh", "scale", "rotation", "matrix", "uri"),
    *("skeleton", "byteStride", "children", "name", "mode", "normalized", "material", "targets"),
)
"""Properties that are added."""
VALUES: tuple[Any, ...] = (*ODD, [0, 0, 0], [1, 1, 1, 1], [1e-20] * 3, {"count": 1})


def examine(data: bytes, folder: Path | None = None) -> str:
    """Take a body in, write its rig and load that; return the message of a fault, "" without one.

    Sites stay in their nodes' frames: to fit them takes most of the time and reads no file.
    Raises where anything but a BodyError comes, or a warning of numpy's.
    """
    with tempfile.TemporaryDirectory(dir=folder) as place, warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        path = Path(place) / "body.glb"
        path.write_bytes(data)
        fault = ""
        with patch.object(importer, "riding", _rigid):
            try:
                made = importer.import_body(path, "body")
                write_folder(made, Path(place) / "rig")
                load_rig(Path(place) / "rig")
            except BodyError as error:
                fault = error.message or "a fault without a message"
    fault.encode()
    if len(fault) > LONGEST:
        raise ValueError(f"a message of {len(fault)} letters")
    return fault


def _rigid(rig: Rig, mesh: BodyMesh) -> dict[str, RigSite]:
    return dict(rig.sites)


def split(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the JSON of a GLB, and what follows it."""
    size = struct.unpack_from("<I", data, 12)[0]
    document: dict[str, Any] = json.loads(data[20 : 20 + size])
    return document, data[20 + size :]


def joined(document: object, rest: bytes) -> bytes:
    """Return a GLB of a JSON and of the chunks that follow it."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + rest
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def spots(value: object, path: Path_ = ()) -> Iterator[tuple[Path_, object]]:
    """All values of a JSON document, with the way to each."""
    yield path, value
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from spots(inner, (*path, key))
    elif isinstance(value, list):
        for number, inner in enumerate(value):
            yield from spots(inner, (*path, number))


def damaged(data: bytes, chance: random.Random) -> bytes:
    """Return a GLB with one to four changes: to its JSON, mostly, else to its bytes."""
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        data = (
            _damaged_json(data, chance) if chance.random() < 0.75 else _damaged_bytes(data, chance)
        )
    return data


def _damaged_bytes(data: bytes, chance: random.Random) -> bytes:
    spoilt = bytearray(data)
    if chance.random() < 0.1:
        return bytes(spoilt[: chance.randrange(len(spoilt))])
    start = chance.choice((0, struct.unpack_from("<I", data, 12)[0] + 28 if len(data) > 28 else 0))
    for _ in range(chance.choice((1, 50, 2000))):
        if start < len(spoilt):
            spoilt[chance.randrange(start, len(spoilt))] = chance.randrange(256)
    return bytes(spoilt)


def _damaged_json(data: bytes, chance: random.Random) -> bytes:
    try:
        document, rest = split(data)
        top = chance.choice(list(document))
        found = list(spots(document[top], (top,)))
        path, old = chance.choice(found)
        holder: Any = document
        for key in path[:-1]:
            holder = holder[key]
        change = chance.choice(CHANGES)
        change(holder, path[-1], old, chance, found)
        return joined(document, rest)
    except (ValueError, struct.error, IndexError, AttributeError):
        return data  # an earlier change left no JSON to damage


Change = Callable[[Any, Any, Any, random.Random, list[tuple[Path_, object]]], None]


def _drop(holder: Any, key: Any, old: Any, chance: random.Random, found: Any) -> None:
    del holder[key]


def _odd(holder: Any, key: Any, old: Any, chance: random.Random, found: Any) -> None:
    holder[key] = chance.choice(ODD)


def _other_number(holder: Any, key: Any, old: Any, chance: random.Random, found: Any) -> None:
    if isinstance(old, int | float) and not isinstance(old, bool) and abs(old) < 1e300:
        holder[key] = chance.choice((old + 1, old - 1, old * 2, old * 1000, -old, *NUMBERS))


def _from_elsewhere(holder: Any, key: Any, old: Any, chance: random.Random, found: Any) -> None:
    taken = copy.deepcopy(chance.choice(found)[1])
    if len(json.dumps(taken)) < 10_000:
        holder[key] = taken


def _added(holder: Any, key: Any, old: Any, chance: random.Random, found: Any) -> None:
    if isinstance(holder, dict):
        holder[chance.choice(KEYS)] = copy.deepcopy(chance.choice(VALUES))


CHANGES: tuple[Change, ...] = (_drop, _odd, _odd, _other_number, _from_elsewhere, _added)
