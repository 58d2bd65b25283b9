"""Places in texts, both ways, and edits, for any text."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types

from azee.lsp.document import Document

TEXTS = st.text(alphabet="aé😀\u0301 \n\r\u2028\x0b", max_size=30)


@given(TEXTS, st.data())
def test_a_place_has_one_name_in_each_way_of_counting(text: str, data: st.DataObject) -> None:
    document = Document("file:///a.azee", text)
    offset = data.draw(st.integers(0, len(text)))
    if text[offset - 1 : offset + 1] == "\r\n":
        return  # inside a line end is no place of the protocol
    position = document.position(offset)
    assert document.offset(position) == offset
    line = text[:offset].replace("\r\n", "\n").replace("\r", "\n").split("\n")[-1]
    assert position.character == len(line.encode("utf-16-le")) // 2


@given(TEXTS, TEXTS, st.data())
def test_an_edit_replaces_its_range(text: str, new: str, data: st.DataObject) -> None:
    document = Document("file:///a.azee", text)
    start, end = sorted(data.draw(st.tuples(*[st.integers(0, len(text))] * 2)))
    if any(text[at - 1 : at + 1] == "\r\n" for at in (start, end)):
        return
    place = types.Range(document.position(start), document.position(end))
    change = types.TextDocumentContentChangePartial(place, new)
    assert document.edited([change], 2).text == text[:start] + new + text[end:]


def test_a_place_inside_a_character_or_beyond_a_line_is_the_nearest() -> None:
    document = Document("file:///a.azee", "😀x\nab")
    assert document.offset(types.Position(0, 1)) == 0
    assert document.offset(types.Position(0, 99)) == 2
    assert document.offset(types.Position(9, 0)) == 5
