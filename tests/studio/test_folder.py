"""Nothing outside the open folder is read or written, and nothing is overwritten unread."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from azee.studio.folder import LARGEST_TEXT, ConflictError, Folder, RefusedError


@pytest.fixture
def folder(tmp_path: Path) -> Folder:
    inside = tmp_path / "open"
    (inside / "sub").mkdir(parents=True)
    (inside / "a.azee").write_text(":a\n")
    (inside / "sub" / "b.azee").write_text(":b\n")
    (tmp_path / "secret.azee").write_text(":secret\n")
    return Folder(inside)


@pytest.mark.parametrize(
    "name",
    [
        *("", "..", ".", "/", "../secret.azee", "sub/../../secret.azee", "sub/../a.azee"),
        *("./a.azee", "//a.azee", "sub//b.azee", ".hidden.azee", "sub/.git/x.azee", "a.txt"),
        *("..\\secret.azee", "c:a.azee", "a.azee\0", "a\n.azee", "a/" * 9 + "x.azee"),
        *("x" * 300 + ".azee", "\ud800.azee", "node_modules/a.azee", "a.azee/"),
    ],
)
def test_what_is_no_name_is_refused(folder: Folder, name: str) -> None:
    with pytest.raises(RefusedError) as refused:
        folder.path(name)
    assert refused.value.status == 400


def test_absolute_paths_are_no_names(folder: Folder, tmp_path: Path) -> None:
    with pytest.raises(RefusedError):
        folder.path(str(tmp_path / "secret.azee"))


def test_links_lead_out_of_the_folder_for_nobody(folder: Folder, tmp_path: Path) -> None:
    (folder.root / "link.azee").symlink_to(tmp_path / "secret.azee")
    (folder.root / "way").symlink_to(tmp_path)
    (folder.root / "new.azee").symlink_to(tmp_path / "not-there.azee")
    (folder.root / "round.azee").symlink_to(folder.root / "round.azee")
    for name in ("link.azee", "way/secret.azee", "new.azee"):
        with pytest.raises(RefusedError) as refused:
            folder.read(name)
        assert refused.value.status == 403
        with pytest.raises(RefusedError):
            folder.save(name, "x", None)
    with pytest.raises(RefusedError):
        folder.read("round.azee")
    assert (tmp_path / "secret.azee").read_text() == ":secret\n"
    assert not (tmp_path / "not-there.azee").exists()
    assert folder.names() == ["a.azee", "sub/b.azee"]


def test_links_inside_the_folder_are_followed(folder: Folder) -> None:
    (folder.root / "same.azee").symlink_to(folder.root / "a.azee")
    stored = folder.read("same.azee")
    folder.save("same.azee", ":c\n", stored.digest)
    assert (folder.root / "a.azee").read_text() == ":c\n"
    assert (folder.root / "same.azee").is_symlink()


@pytest.mark.long
@given(
    st.lists(st.sampled_from(["..", ".", "a", "sub", "%2e%2e", "\\", "~"]) | st.text(max_size=4))
)
@settings(max_examples=200)
def test_no_name_whatever_leads_out(parts: list[str]) -> None:
    root = Path(__file__).parent
    opened = Folder(root)
    try:
        path = opened.path("/".join(parts) + ".azee")
    except RefusedError:
        return
    assert path.is_relative_to(root.resolve())


def test_a_text_is_saved_over_what_was_read_only(folder: Folder) -> None:
    read = folder.read("a.azee")
    (folder.root / "a.azee").write_text(":theirs\n")
    with pytest.raises(ConflictError) as conflict:
        folder.save("a.azee", ":mine\n", read.digest)
    assert conflict.value.stored is not None
    assert conflict.value.stored.text == ":theirs\n"
    assert (folder.root / "a.azee").read_text() == ":theirs\n"
    made = folder.save("a.azee", ":mine\n", conflict.value.stored.digest)
    assert folder.read("a.azee").digest == made


def test_a_new_text_does_not_replace_one_and_a_removed_one_is_a_conflict(folder: Folder) -> None:
    with pytest.raises(ConflictError):
        folder.save("a.azee", ":new\n", None)
    digest = folder.read("a.azee").digest
    (folder.root / "a.azee").unlink()
    with pytest.raises(ConflictError) as conflict:
        folder.save("a.azee", ":new\n", digest)
    assert conflict.value.stored is None
    folder.save("a.azee", ":new\n", None)
    assert (folder.root / "a.azee").read_text() == ":new\n"


def test_line_ends_and_byte_order_mark_stay_as_they_were(folder: Folder) -> None:
    (folder.root / "w.azee").write_bytes(b"\xef\xbb\xbf:a\r\n    'b\r\n")
    read = folder.read("w.azee")
    assert read.text == ":a\n    'b\n"
    folder.save("w.azee", ":é\n    'b\n", read.digest)
    assert (folder.root / "w.azee").read_bytes() == "\ufeff:é\r\n    'b\r\n".encode()


@pytest.mark.parametrize(
    ("data", "status"), [(b"\xff\xfe:\0", 409), (b"x" * (LARGEST_TEXT + 1), 413)]
)
def test_what_is_no_text_is_not_opened(folder: Folder, data: bytes, status: int) -> None:
    (folder.root / "odd.azee").write_bytes(data)
    with pytest.raises(RefusedError) as refused:
        folder.read("odd.azee")
    assert refused.value.status == status


def test_half_a_character_and_too_much_text_are_not_written(folder: Folder) -> None:
    for text in ("\ud800", "é" * LARGEST_TEXT):
        with pytest.raises(RefusedError):
            folder.save("new.azee", text, None)
    assert sorted(p.name for p in folder.root.iterdir()) == ["a.azee", "sub"]
