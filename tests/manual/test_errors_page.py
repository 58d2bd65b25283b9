"""docs/language/errors.md: every code has its entry, every example its message."""

from __future__ import annotations

import ast
import dataclasses
import io
import json
import re
import shlex
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from diagnostic_codes import UnknownCodeError, codes, codes_in
from pages import Block, blocks, page, pairs
from sqlalchemy import update

from azee.cli.main import run
from azee.clip.archive import write_clip
from azee.clip.clip import Clip
from azee.compilation import lacks
from azee.lang.program import load
from azee.lang.unshowable import beyond_frames
from azee.signs.database import SignDatabase
from azee.signs.sign import Identity, Motion, SignFacts, Timing
from azee.signs.skeleton import StoredSkeleton
from azee.signs.tables import MOTION
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.render import render
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig

PAGE = page("errors.md")
BLOCKS = list(blocks(PAGE))
EXAMPLES = [(block, shown) for block, shown in pairs(BLOCKS) if block.kind == "azee"]
COMMANDS = [block for block in BLOCKS if block.kind == "console"]
ENTRIES = re.findall(r"^### `([a-z0-9-]+)`$", PAGE, re.M)


def _sign() -> bytes:
    """A clip of two seconds, in which nothing happens."""
    rig = load_rig("signer")
    still = np.tile(rig.coordinates.idle, (61, 1))
    file = io.BytesIO()
    write_clip(Clip(np.arange(61) / 30, still, (), np.zeros((61, 0))), rig, file)
    return file.getvalue()


COFFEE = {"gloss": "COFFEE", "file": "coffee.tsv", "digest": ""}


def _signs() -> bytes:
    """A database of two signs; the movement of the second is damaged."""
    rig, clip = load_rig("signer"), _sign()
    known = Timing.of(2.0, 61, 30.0)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "signs.db"
        database, _ = SignDatabase.create(str(path))
        with database:
            for name in ("TREE", "HOUSE"):
                motion = Motion(clip, name.encode(), f"{name}.npz")
                database.add(SignFacts(Identity(name), known), motion, StoredSkeleton.of(rig))
            with database.store.writing() as connection:
                connection.execute(update(MOTION).where(MOTION.c.sign == 2).values(clip=b"?"))
        return path.read_bytes()


FILES = {
    "north/tea.azee": b"def tea\n    :bien\n",
    "south/tea.azee": b"def tea\n    :mignon\n",
    "rules-only.azee": b"def tea\n    :bien\n",
    "latin-1.azee": ":âge\n".encode("latin-1"),
    "body.fbx": b"Kaydara FBX Binary",
    "old.gltf": b'{"asset": {"version": "1.0"}}',
    "statue.gltf": b'{"asset": {"version": "2.0"}}',
    "kept/letter.txt": b"keep me",
    "torn.sigml": b'<sigml><hns_sign gloss="TEA">',
    "tea.tsv": "TEA\t\ue001\ue038\ue020\n".encode(),
    "coffee.tsv": "COFFEE\t\ue001\ue020\ue038\n".encode(),
    "own/own-coffee.azee": b"def own-coffee\n    :bien\n",
    "own/lexicon.json": json.dumps(
        {"language": "own", "source": "", "rules": {"own-coffee": COFFEE}}
    ).encode(),
    "broken/lexicon.json": b"{}",
    "markers.trc": b"index_tip 1 2 3",
    "sign.npz": _sign(),
    "signs.db": _signs(),
    "shortcuts.txt": b":bien\n",
}
"""What the examples find beside them."""


@pytest.fixture(autouse=True)
def _beside_the_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, data in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(data)
    monkeypatch.chdir(tmp_path)


def _reported(block: Block, request: pytest.FixtureRequest) -> tuple[Diagnostic, ...]:
    """All that is wrong with an example.

    `body-without=NAME` has a body play it that lacks the name, `fps=N` a clip of so many frames.
    """
    Path("example.azee").write_text(block.text, encoding="utf-8", newline="\n")
    program = load(Source("example.azee", block.text))
    name, fps = block.options.get("body-without"), block.options.get("fps")
    if name is None and fps is None:
        return program.check()
    assert program.check() == ()
    if fps is not None:
        return tuple(beyond_frames(program.score(), float(fps)))
    assert name is not None
    return lacks(program.score(), _without(name, request.getfixturevalue("signer")), strict=True)


def _without(name: str, rig: Rig) -> Rig:
    return dataclasses.replace(
        rig,
        name="small",
        bones={key: bone for key, bone in rig.bones.items() if key != name},
        sites={key: site for key, site in rig.sites.items() if key != name},
        face_morphs={key: morph for key, morph in rig.face_morphs.items() if key != name},
    )


def _place(found: Diagnostic) -> str | None:
    return None if found.span is None else f"{found.span.line}:{found.span.column}"


@pytest.mark.long
@pytest.mark.parametrize(("block", "shown"), EXAMPLES, ids=str)
def test_an_example_has_its_mistake_at_its_place_in_these_words(
    block: Block, shown: Block | None, request: pytest.FixtureRequest
) -> None:
    reported = _reported(block, request)
    place = next((word for word in block.options if ":" in word), None)
    assert [(d.code, _place(d)) for d in reported] == [(block.options["error"], place)]
    assert shown is not None
    assert shown.kind == "text"
    assert shown.text == render(reported[0]) + "\n"


@pytest.mark.parametrize("block", COMMANDS, ids=str)
def test_a_command_says_what_is_printed(
    block: Block, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    command, _, said = block.text.partition("\n")
    if missing := block.options.get("without"):
        _hide(missing, monkeypatch)
    program, *arguments = shlex.split(command.removeprefix("$ "))
    assert program == "azee"
    code = run(arguments)
    captured = capsys.readouterr()
    told = (captured.out + captured.err).replace("\\", "/")
    assert told.rstrip("\n") == said.rstrip("\n")
    entry = _entry(block)
    assert f"error[{entry}]" in said or f"warning[{entry}]" in said
    assert (code == 1) == ("error[" in said)


def _hide(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have a package that is optional, and what of ours needs it, be missing."""
    for name in [n for n in sys.modules if n.startswith(("azee.lsp", f"{package}."))]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)


def _entry(block: Block) -> str:
    """The entry in which a block stands."""
    above = "\n".join(PAGE.split("\n")[: block.line])
    last: str = re.findall(r"^### `([a-z0-9-]+)`$", above, re.M)[-1]
    return last


@pytest.mark.long
def test_every_code_has_its_entry_and_no_other() -> None:
    assert len(ENTRIES) == len(set(ENTRIES))
    assert set(ENTRIES) == codes()


def test_every_entry_has_an_example_of_its_code_and_a_remedy() -> None:
    for entry in PAGE.split("\n### ")[1:]:
        code = entry.split("`")[1]
        assert f"```azee error={code} " in entry or "```console" in entry, code
        assert entry.count("**Remedy.**") == 1, code


def test_every_code_is_in_the_table() -> None:
    table = PAGE.split("\n## ")[1]
    assert re.findall(r"\[`([a-z0-9-]+)`\]\(#\1\)", table) == ENTRIES


def test_codes_are_found_however_they_are_chosen() -> None:
    made = (
        "def f(x):\n    code = 'a' if x else 'b'\n    raise Diagnostic(code) from fault('c', x)\n"
    )
    assert codes_in(ast.parse(made), "f") == {"a", "b", "c"}
    with pytest.raises(UnknownCodeError):
        codes_in(ast.parse("def f(code):\n    return Diagnostic(code)\n"), "f")
