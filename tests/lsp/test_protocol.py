"""The language server, asked over the protocol by a client that is not ours."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from editor import SOON_S, Editor, editor
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from azee.lsp.document import Document
from azee.lsp.server import PAUSE_S, make_server

SIGNS = """\
def été
    'meaning "summer"
    azop
        'où
        ^Rssp
        sync
            'SIG :chat
            'GAZE key(.2, lookat(^où))
            'start 'SIG:start
def 😀
    :été('où = ^Lssp)
:été
"""
MAIN = "use 'signs\n:info-about\n    'topic :été\n    'info :😀\n"


def play(folder: Path, scene: Callable[[Editor], Awaitable[None]]) -> None:
    """Let somebody do something in an editor."""

    async def whole() -> None:
        async with editor(folder) as one:
            await scene(one)

    asyncio.run(whole())


def lines(text: str) -> list[str]:
    return text.replace("\r\n", "\n").split("\n")


@pytest.mark.long
def test_edits_break_a_text_and_mend_it(tmp_path: Path) -> None:
    async def scene(one: Editor) -> None:
        assert await one.open("a.azee", "# 😀\n:chat\n:personne\n") == []
        assert await one.replace("a.azee", ":chat", "😀😀 :caht") == [
            "unknown-operator",
            "unknown-rule",
        ]
        assert one.messages[one.uri("a.azee")].diagnostics[1].range == one.range("a.azee", ":caht")
        assert await one.replace("a.azee", "😀😀 :caht", ":caht") == ["unknown-rule"]
        message = one.messages[one.uri("a.azee")].diagnostics[0]
        assert message.range == one.range("a.azee", ":caht")
        assert "did you mean `:cat` or `:chat`?" in message.message
        assert await one.replace("a.azee", ":caht", "(") == ["unclosed-paren"]
        assert await one.replace("a.azee", "(", ":chat") == []

    play(tmp_path, scene)


@pytest.mark.long
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_accents_and_line_ends(tmp_path: Path, end: str) -> None:
    text = SIGNS.replace("\n", end)

    async def scene(one: Editor) -> None:
        assert await one.open("signs.azee", text) == []
        one.texts["signs.azee"] = SIGNS  # line ends count for no position
        client, item = one.client, one.item("signs.azee")
        use = one.at("signs.azee", ":été(", 2)
        hover = await client.text_document_hover_async(types.HoverParams(item, use))
        assert hover is not None
        assert isinstance(hover.contents, types.MarkupContent)
        assert "summer" in hover.contents.value
        place = await client.text_document_definition_async(types.DefinitionParams(item, use))
        assert isinstance(place, types.Location)
        assert place.range == one.range("signs.azee", "été")
        edits = await client.text_document_formatting_async(
            types.DocumentFormattingParams(item, types.FormattingOptions(4, True))
        )
        assert edits is not None
        if end == "\r\n":
            assert "\n" not in edits[0].new_text.replace("\r\n", "")
        assert "'où = ^Lssp" in edits[0].new_text

    play(tmp_path, scene)


@pytest.mark.long
def test_two_open_texts_of_which_one_defines_the_others_rule(tmp_path: Path) -> None:
    for name, text in (("signs.azee", "def old\n    :chat\n"), ("main.azee", MAIN)):
        (tmp_path / name).write_text(text, encoding="utf-8")

    async def scene(one: Editor) -> None:
        client = one.client
        assert await one.open("main.azee", MAIN) == ["unknown-rule", "unknown-rule"]
        await one.open("signs.azee", SIGNS)  # not saved: the editor's version counts
        await one.wait_for_codes("main.azee", [])
        await one.replace("signs.azee", "def 😀", "def 😎")
        await one.wait_for_codes("main.azee", ["unknown-rule"])
        await one.replace("signs.azee", "def 😎", "def 😀")
        await one.wait_for_codes("main.azee", [])

        use = one.at("main.azee", ":été", 1)
        item = one.item("main.azee")
        place = await client.text_document_definition_async(types.DefinitionParams(item, use))
        assert isinstance(place, types.Location)
        assert (place.uri, place.range) == (
            one.uri("signs.azee"),
            one.range("signs.azee", "été"),
        )
        found = await client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(True), item, use)
        )
        assert found is not None
        assert sorted((Path(p.uri).name, p.range.start.line) for p in found) == [
            ("main.azee", 2),
            ("signs.azee", 0),
            ("signs.azee", 10),
            ("signs.azee", 11),
        ]
        edit = await client.text_document_rename_async(types.RenameParams(item, use, "l'été"))
        assert edit is not None
        assert edit.changes is not None
        counts = {uri: len(edits) for uri, edits in edit.changes.items()}
        assert counts == {one.uri("main.azee"): 1, one.uri("signs.azee"): 3}
        assert {e.new_text for edits in edit.changes.values() for e in edits} == {"l'été"}

    play(tmp_path, scene)


@pytest.mark.long
def test_arguments_and_blocks_are_renamed_with_all_their_uses(tmp_path: Path) -> None:
    async def scene(one: Editor) -> None:
        client, item = one.client, one.item("signs.azee")
        await one.open("signs.azee", SIGNS)

        async def edits(word: str, skip: int, name: str) -> list[tuple[int, str]]:
            where = one.at("signs.azee", word, skip)
            params = types.RenameParams(item, where, name)
            edit = await client.text_document_rename_async(params)
            assert edit is not None
            assert edit.changes is not None
            return sorted((e.range.start.line, e.new_text) for e in edit.changes[item.uri])

        assert await edits("^où", 1, "place") == [(3, "place"), (7, "place"), (10, "place")]
        assert await edits("'SIG:start", 1, "SIGN") == [(6, "SIGN"), (8, "SIGN")]
        with pytest.raises(JsonRpcException, match="cannot be the name"):
            await edits("'SIG:start", 1, "a b")
        with pytest.raises(JsonRpcException, match="already"):
            await edits("def été", 4, "😀")
        with pytest.raises(JsonRpcException, match="ships with azee"):
            await edits(":chat", 1, "dog")

    play(tmp_path, scene)


@pytest.mark.long
def test_what_is_offered_and_told_while_typing(tmp_path: Path) -> None:
    async def scene(one: Editor) -> None:
        client, item = one.client, one.item("a.azee")
        await one.open("a.azee", "# 😀😀\n:info-about\n    'topic :pers\n    'i\nplace(@I_, )\n")

        async def offered(word: str, skip: int) -> list[str]:
            where = one.at("a.azee", word, skip)
            params = types.CompletionParams(item, where)
            found = await client.text_document_completion_async(params)
            assert isinstance(found, types.CompletionList)
            return [entry.label for entry in found.items]

        assert (await offered(":pers", 5))[0] == ":personne"
        assert (await offered("'i", 2))[0] == "'info"
        assert "@I_TIP" in await offered("@I_", 3)
        where = one.at("a.azee", "@I_", 3)
        signature = await client.text_document_signature_help_async(
            types.SignatureHelpParams(item, where)
        )
        assert signature is not None
        assert signature.signatures[0].label.startswith("place ")
        assert signature.active_parameter == 0

    play(tmp_path, scene)


@pytest.mark.long
def test_outline_symbols_and_colours(tmp_path: Path) -> None:
    async def scene(one: Editor) -> None:
        client, item = one.client, one.item("signs.azee")
        await one.open("signs.azee", SIGNS)
        outline = await client.text_document_document_symbol_async(types.DocumentSymbolParams(item))
        assert outline is not None
        assert [symbol.name for symbol in outline] == ["été", "😀", ":été"]
        first = outline[0]
        assert isinstance(first, types.DocumentSymbol)
        assert [block.name for block in first.children or ()] == ["SIG", "GAZE"]
        found = await client.workspace_symbol_async(types.WorkspaceSymbolParams("ete"))
        assert found is not None
        assert [symbol.name for symbol in found] == ["été"]
        colours = await client.text_document_semantic_tokens_full_async(
            types.SemanticTokensParams(item)
        )
        assert colours is not None
        spans = []
        line = start = 0
        for i in range(0, len(colours.data), 5):
            down, right, length = colours.data[i : i + 3]
            line, start = line + down, right if down else start + right
            units = lines(SIGNS)[line].encode("utf-16-le")
            spans.append(units[2 * start : 2 * (start + length)].decode("utf-16-le"))
        assert spans[:4] == ["def", "été", "'meaning", '"summer"']
        assert spans[-6:] == ["def", "😀", ":été", "'où", "^Lssp", ":été"]

    play(tmp_path, scene)


@pytest.mark.long
def test_saved_changed_and_deleted_libraries_count_at_once(tmp_path: Path) -> None:
    library = tmp_path / "signs.azee"
    library.write_text("def old\n    :chat\n", encoding="utf-8")
    for name in ("main.azee", "other.azee"):
        (tmp_path / name).touch()
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "a.azee").write_text("def gone\n    :chat\n", encoding="utf-8")

    async def scene(one: Editor) -> None:
        client = one.client

        def watched(name: str, how: types.FileChangeType) -> None:
            client.workspace_did_change_watched_files(
                types.DidChangeWatchedFilesParams([types.FileEvent(one.uri(name), how)])
            )

        assert await one.open("main.azee", "use 'signs\nuse 'lsf\n:new\n") == ["unknown-rule"]
        library.write_text("def new\n    :chat\n", encoding="utf-8")
        client.text_document_did_save(types.DidSaveTextDocumentParams(one.item("main.azee")))
        await one.wait_for_codes("main.azee", [])
        library.write_text("def newer\n    :chat\n", encoding="utf-8")
        watched("signs.azee", types.FileChangeType.Changed)
        await one.wait_for_codes("main.azee", ["unknown-rule"])
        library.unlink()
        watched("signs.azee", types.FileChangeType.Deleted)
        await one.wait_for_codes("main.azee", ["library-not-found", "unknown-rule"])

        assert await one.open("other.azee", "use 'lib\n:gone\n") == []
        (tmp_path / "lib" / "a.azee").unlink()
        watched("lib/a.azee", types.FileChangeType.Deleted)
        await one.wait_for_codes("other.azee", ["library-not-found", "unknown-rule"])
        (tmp_path / "lib").rmdir()
        watched("lib", types.FileChangeType.Deleted)
        found = await client.workspace_symbol_async(types.WorkspaceSymbolParams("gone"))
        assert found == []
        assert one.complaints == []

    play(tmp_path, scene)


AT_THE_START = {"line": 0, "character": 0}


@pytest.mark.long
def test_a_request_that_nobody_can_read_is_answered(tmp_path: Path) -> None:
    requests: list[tuple[str, dict[str, object], str]] = [
        ("textDocument/hover", {"position": {"line": -1, "character": 0}}, "-1"),
        ("textDocument/completion", {"position": {"line": 0, "character": -5}}, "-5"),
        ("textDocument/hover", {"position": {"line": "first", "character": 0}}, "first"),
        ("textDocument/definition", {}, "position"),
        ("textDocument/hover", {"position": AT_THE_START, "textDocument": 3}, "textDocument"),
        ("textDocument/nothing", {}, "nothing"),
    ]

    async def scene(one: Editor) -> None:
        assert await one.open("a.azee", ":chat\n") == []
        item: dict[str, object] = {"textDocument": {"uri": one.uri("a.azee")}}
        for method, parameters, reason in requests:
            with pytest.raises(JsonRpcException, match=reason):
                await asyncio.wait_for(one.ask(method, item | parameters), SOON_S)
        good = item | {"position": AT_THE_START}
        assert await asyncio.wait_for(one.ask("textDocument/hover", good), SOON_S)

    play(tmp_path, scene)


IMPOSSIBLE = (
    "file:///a%00b.azee",
    f"file:///{'a' * 5000}.azee",
    f"file:///{'a/' * 5000}",
    "file://[",
    "file:",
    "file:a.azee",
    "untitled:" + "a" * 5000,
    "",
)


@pytest.mark.long
def test_texts_at_impossible_addresses_hinder_no_other(tmp_path: Path) -> None:
    async def scene(one: Editor) -> None:
        client = one.client
        for uri in IMPOSSIBLE:
            item = types.TextDocumentItem(uri, "azee", 1, "def odd\n    :chat\n")
            client.text_document_did_open(types.DidOpenTextDocumentParams(item))
        codes = ["library-not-found", "unknown-rule"]
        assert await one.open("a.azee", f"use '{'n' * 300}\n:caht\n") == codes
        await one.replace("a.azee", f"use '{'n' * 300}\n:caht", "def mine\n    :chat")
        where = one.at("a.azee", "mine")
        references = await client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(True), one.item("a.azee"), where)
        )
        assert references is not None
        assert len(references) == 1
        found = await client.workspace_symbol_async(types.WorkspaceSymbolParams("mine"))
        assert found is not None
        assert [symbol.name for symbol in found] == ["mine"]

    play(tmp_path, scene)


@pytest.mark.long
def test_a_file_of_a_library_sees_the_others(tmp_path: Path) -> None:
    shared = "def shared\n    azop\n        'shape 'nodefault\n        apply ^shape\n"
    folder = tmp_path / "lib"
    folder.mkdir()
    (folder / "a.azee").write_text(shared, encoding="utf-8")

    async def scene(one: Editor) -> None:
        # not yet on the disk, and with rules that the other file lacks or has
        assert await one.open("lib/b.azee", "def b\n    key 1 :#shared(.flat-hand)\n") == []
        await one.open("lib/a.azee", shared)
        await one.replace("lib/a.azee", "def shared", "def other")
        await one.wait_for_codes("lib/b.azee", ["unknown-rule"])
        await one.replace("lib/a.azee", "def other", "def shared")
        await one.wait_for_codes("lib/b.azee", [])
        use = one.at("lib/b.azee", "shared", 1)
        place = await one.client.text_document_definition_async(
            types.DefinitionParams(one.item("lib/b.azee"), use)
        )
        assert isinstance(place, types.Location)
        assert place.uri == one.uri("lib/a.azee")

    play(tmp_path, scene)


class Output:
    """A pipe to an editor, which counts what is written after it is closed."""

    closed = False
    late = 0

    def close(self) -> None:
        self.closed = True

    def write(self, _: bytes) -> None:
        self.late += self.closed
        if self.closed:
            raise ValueError("write to closed file")


def test_a_server_that_leaves_checks_nothing_more(tmp_path: Path) -> None:
    """A check that was due wrote to the closed pipe, told its own fault there, and never ended."""
    server, output = make_server(), Output()
    protocol, leaving = server.protocol, {"jsonrpc": "2.0", "method": "exit"}
    protocol.set_writer(output)
    uri = (tmp_path / "a.azee").as_uri()
    server.texts.put(Document(uri, ":caht\n", 1))

    async def leave() -> None:
        server.check_all()
        with pytest.raises(SystemExit):
            protocol.handle_message(protocol.structure_message(leaving))
        await asyncio.sleep(2 * PAUSE_S)

    asyncio.run(leave())
    assert output.closed
    assert output.late == 0
