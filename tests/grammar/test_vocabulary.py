"""The tables of names agree with each other and with what a text may write."""

from __future__ import annotations

import pytest

from azee_grammar.nearest import nearest
from azee_grammar.vocabulary import (
    BONES,
    MORPHS,
    SITES,
    WITHOUT_MORPH,
    bone_names,
    morph,
    nearest_site,
    site,
    site_names,
)


def test_the_published_counts() -> None:
    assert len(BONES) == 44
    assert len(SITES) == 323
    kinds = [entry.kind for entry in MORPHS.values()]
    assert kinds.count("skeletal") == 31
    assert kinds.count("facial") == 70
    assert kinds.count("facial-alternative") == 24
    assert len(WITHOUT_MORPH) == 18


def test_every_bone_hangs_on_the_root() -> None:
    for name in BONES:
        seen = [name]
        while (parent := BONES[seen[-1]]) is not None:
            assert parent not in seen
            seen.append(parent)
        assert seen[-1] == "back_1"


def test_every_site_is_carried_by_a_bone() -> None:
    assert {entry.bone for entry in SITES.values()} <= set(BONES)


@pytest.mark.parametrize("name", [name for name in SITES if "_L" in name])
def test_sides_come_in_pairs_on_mirrored_bones(name: str) -> None:
    names = site_names()
    unsided = next(n for n in names if name in (f"{n}_L", *(f"{n}_L_{i}" for i in (1, 2, 3))))
    other = f"{unsided}_R{name[len(unsided) + 2 :]}"
    assert SITES[other].bone == SITES[name].bone.replace("_L", "_R")
    assert "left" in SITES[name].description.lower()
    assert SITES[other].description.lower() == SITES[name].description.lower().replace(
        "left", "right"
    )


def test_descriptions_are_unique() -> None:
    texts = [entry.description for entry in SITES.values()]
    assert len(set(texts)) == len(texts)


def test_contradictory_descriptions_are_corrected() -> None:
    assert SITES["CH"].description == "Chin"
    assert SITES["ST"].description == "Sternum"


@pytest.mark.parametrize(
    ("name", "takes_side", "side_optional", "phalanges"),
    [
        ("FH", True, True, ()),
        ("I_TIP", True, False, ()),
        ("I_BACK", True, False, (1, 2)),
        ("T_BACK", True, False, (1, 2, 3)),
        ("L_TIP", True, False, ()),
        ("HEAD", True, True, ()),
        ("TO", False, False, ()),
    ],
)
def test_what_a_site_takes(
    name: str, takes_side: bool, side_optional: bool, phalanges: tuple[int, ...]
) -> None:
    found = site(name)
    assert found is not None
    assert (found.takes_side, found.side_optional, found.phalanges) == (
        takes_side,
        side_optional,
        phalanges,
    )
    assert found.takes_phalanx == bool(phalanges)


def test_a_full_site_name_is_no_site_of_a_text() -> None:
    assert site("I_TIP_L") is None


def test_what_a_bone_takes() -> None:
    names = bone_names()
    assert set(names) == {
        *("back_1", "back_2", "neck", "head", "eye", "clav", "arm", "f_arm", "palm"),
        *("thumb", "index", "middle", "ring", "little"),
    }
    assert names["index"].phalanges == (1, 2, 3)
    assert names["palm"].takes_side
    assert not names["palm"].takes_phalanx
    assert not names["head"].takes_side


def test_a_morph_with_its_suffix_takes_no_side() -> None:
    with_suffix, without = morph("index_bend_L"), morph("index_bend")
    assert with_suffix is not None
    assert not with_suffix.takes_side
    assert without is not None
    assert without.takes_side
    assert not without.side_optional
    assert morph("AU45") is None


@pytest.mark.parametrize("name", ["smile", "lipBrollout", "palm_l_closed", "little_closed"])
def test_published_older_morphs_are_known(name: str) -> None:
    assert name in MORPHS


@pytest.mark.parametrize(
    ("written", "known", "expected"),
    [
        ("Age", ["âge", "page"], ("âge",)),
        ("nb5", ["nb-5", "nb-2"], ("nb-5",)),
        ("infoabout", ["info-about", "about-ref"], ("info-about",)),
        ("indxe", ["index", "ring"], ("index",)),
        ("pers", ["personne", "pays"], ("personne",)),
        ("a", ["b"], ()),
        ("", ["b"], ()),
        ("x" * 1000, ["x" * 999], ()),
        ("elephant", ["index"], ()),
    ],
)
def test_nearest(written: str, known: list[str], expected: tuple[str, ...]) -> None:
    assert nearest(written, known) == expected


def test_a_site_is_found_by_what_it_is() -> None:
    assert nearest_site("CHIN_TIP")[0] == "CH"
    assert nearest_site("elbow") == ("EL", "ELi")
    assert nearest_site("xyzzy") == ()
