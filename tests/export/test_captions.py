"""Captions of pictures fit below them, and no word is cut where others can be left out."""

from __future__ import annotations

import pytest

from azee.export.pictures.typeface import fitted, typeface

TEXT = "key 1.25 s  PERM, K1, no-worries"


@pytest.mark.parametrize("room", [40, 60, 80, 100, 120, 140, 160, 180, 200, 400])
def test_a_caption_fits_and_ends_with_a_whole_word(room: int) -> None:
    font = typeface(13)
    shown = fitted(TEXT, font, room)
    assert font.getlength(shown) <= room
    if shown != TEXT:
        words = shown.removesuffix(" …").split(" ")
        assert shown.endswith(" …")
        assert [word.rstrip(",") for word in TEXT.split(" ")][: len(words)] == [
            word.rstrip(",") for word in words
        ]


def test_a_word_that_is_too_long_alone_is_cut() -> None:
    font = typeface(13)
    shown = fitted("n" * 100, font, 60)
    assert shown.endswith("n…")
    assert font.getlength(shown) <= 60
