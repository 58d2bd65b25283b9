"""Signs are stored, found, changed and removed, in SQLite and in PostgreSQL alike."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from laws import examples
from made_signs import STICK, facts, motion
from sqlalchemy import insert, text, update

from azee.signs.database import SignDatabase
from azee.signs.fault import SignsError
from azee.signs.integrity import problems
from azee.signs.query import ALL_SIGNS, Query
from azee.signs.sign import Identity, Motion, SignFacts, Timing
from azee.signs.skeleton import StoredSkeleton
from azee.signs.tables import METADATA, MOTION, SIGN, VERSION, VERSION_TABLE


@pytest.fixture
def signs(database_place: str) -> Iterator[SignDatabase]:
    database, before = SignDatabase.create(database_place)
    assert before is None
    with database:
        yield database


def names(signs: SignDatabase, query: Query = ALL_SIGNS) -> list[str]:
    return [str(sign.identity) for sign in signs.find(query)]


@pytest.mark.long
def test_what_is_stored_is_found_and_comes_back(signs: SignDatabase) -> None:
    stored = signs.add(facts("BONJOUR", "greeting", language="lsf"), motion("b"), STICK)
    assert signs.one("BONJOUR") == stored
    assert signs.motion(stored) == motion("b")
    assert signs.original(stored) == ("b.bvh", motion("b").original)
    assert signs.made_from(motion("b").original, STICK) == stored
    assert signs.made_from(motion("c").original, STICK) is None
    assert signs.skeletons() == [STICK]
    assert list(problems(signs)) != []  # these bytes are no clip


def test_signs_are_found_by_beginning_tag_language_and_kind(signs: SignDatabase) -> None:
    for name, tag, language in (
        ("ARBRE", "plant", "lsf"),
        ("ARBRES", "plant", "lsf"),
        ("ARC", "tool", "lsf"),
        ("plant", "word", "asl"),
        ("İYİ", "word", "tid"),
    ):
        signs.add(facts(name, tag, language=language), motion(name), STICK)
    assert names(signs, Query(prefix="ARB")) == ["ARBRE (lsf)", "ARBRES (lsf)"]
    assert names(signs, Query(tag="plant")) == ["ARBRE (lsf)", "ARBRES (lsf)"]
    assert names(signs, Query(word="plant")) == ["ARBRE (lsf)", "ARBRES (lsf)", "plant (asl)"]
    assert names(signs, Query(language="asl")) == ["plant (asl)"]
    assert names(signs, Query(tag="plant", prefix="ARBRES")) == ["ARBRES (lsf)"]
    assert names(signs, Query(prefix="İ")) == ["İYİ (tid)"]
    assert names(signs, Query(kind="spelled")) == []
    assert len(names(signs)) == 5


def test_a_name_is_taken_once_for_each_skeleton_language_and_variant(signs: SignDatabase) -> None:
    signs.add(facts("A"), motion("1"), STICK)
    signs.add(facts("A", variant="2"), motion("2"), STICK)
    signs.add(facts("A", language="lsf"), motion("3"), STICK)
    other = StoredSkeleton("other", "e" * 64, ("root",), ())
    signs.add(facts("A"), motion("4"), other)
    with pytest.raises(SignsError, match="has a sign `A` of this skeleton already") as caught:
        signs.add(facts("A"), motion("5"), STICK)
    assert caught.value.code == "sign-exists"
    assert len(names(signs)) == 4
    with pytest.raises(SignsError, match="4 signs are called `A`"):
        signs.one("A")
    assert signs.one("A", variant="2").identity == Identity("A", variant="2")


@pytest.mark.long
def test_tags_come_and_go(signs: SignDatabase) -> None:
    sign = signs.add(facts("A", "x", "y"), motion("a"), STICK)
    assert signs.tag(sign, ["z", "x"], ["y"]).facts.tags == ("x", "z")
    assert names(signs, Query(tag="y")) == []
    assert names(signs, Query(tag="z")) == ["A"]


@pytest.mark.long
def test_renaming_keeps_the_motion_and_takes_no_other_s_name(signs: SignDatabase) -> None:
    sign = signs.add(facts("A", "x"), motion("a"), STICK)
    signs.add(facts("B"), motion("b"), STICK)
    with pytest.raises(SignsError, match="`B` of this skeleton already"):
        signs.rename(sign, Identity("B"))
    renamed = signs.rename(sign, Identity("C", "lsf", "1"))
    assert renamed == signs.one("C")
    assert signs.motion(renamed) == motion("a")
    assert names(signs) == ["B", "C (lsf, 1)"]


def test_a_sign_goes_with_all_that_is_its_own(signs: SignDatabase) -> None:
    sign = signs.add(facts("A", "x"), motion("a"), STICK)
    signs.remove(sign)
    assert names(signs) == []
    with signs.store.reading() as connection:
        for table in ("motion", "tag"):
            assert connection.execute(text(f"SELECT count(*) FROM {table}")).scalar() == 0
    for late in (
        lambda: signs.remove(sign),
        lambda: signs.tag(sign, ["y"]),
        lambda: signs.rename(sign, Identity("B")),
        lambda: signs.motion(sign),
        lambda: signs.original(sign),
    ):
        with pytest.raises(SignsError, match="the sign `A` is gone"):
            late()
    with pytest.raises(SignsError, match="has no sign `A`"):
        signs.one("A")


def test_a_copy_is_the_same_but_for_its_number(signs: SignDatabase, tmp_path: Path) -> None:
    sign = signs.add(facts("A", "x", language="lsf"), motion("a"), STICK)
    other, _ = SignDatabase.create(str(tmp_path / "other.db"))
    with other:
        copied = signs.copy(sign, other)
        assert (copied.facts, copied.digest) == (sign.facts, sign.digest)
        assert other.motion(copied) == motion("a")
        assert other.skeletons() == [STICK]


WORDS = st.text(st.characters(categories=("L", "N", "P", "S")), min_size=1, max_size=30)
TIMES = st.floats(0, 1e4).flatmap(
    lambda d: st.tuples(st.just(d), st.floats(0, d / 2), st.floats(0, d / 2))
)
JSON_VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(-1e9, 1e9) | WORDS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(WORDS, inner, max_size=3),
    max_leaves=6,
)
FACTS = st.builds(
    SignFacts,
    identity=st.builds(Identity, WORDS, WORDS | st.just(""), WORDS | st.just("")),
    timing=st.builds(
        lambda t, frames, rate: Timing(t[0], frames, rate, t[1], t[2]),
        TIMES,
        st.integers(1, 10**6),
        st.none() | st.floats(0.1, 1000),
    ),
    kind=st.sampled_from(["recorded", "azee", "spelled"]),
    tags=st.lists(WORDS, max_size=4).map(tuple),
    licence=WORDS | st.just(""),
    provenance=st.dictionaries(WORDS, JSON_VALUES, max_size=3),
    repositioned=st.booleans(),
)


@pytest.mark.long
@settings(max_examples=examples(0.4))
@given(known=FACTS, clip=st.binary(max_size=200), original=st.binary(max_size=200))
def test_every_sign_comes_back_as_it_was(
    known: SignFacts, clip: bytes, original: bytes, tmp_path_factory: pytest.TempPathFactory
) -> None:
    blobs = Motion(clip, original, "x.bvh")
    database, _ = SignDatabase.create(str(tmp_path_factory.mktemp("law") / "signs.db"))
    with database:
        stored = database.add(known, blobs, STICK)
        (found,) = database.find(Query(name=known.identity.name, prefix=known.identity.name))
        assert found == stored
        assert found.facts == known
        assert database.motion(found) == blobs
        for tag in known.tags:
            assert database.find(Query(word=tag)) == [found]


@pytest.mark.long
def test_damaged_blobs_are_told_and_the_rest_is_served(signs: SignDatabase) -> None:
    sign = signs.add(facts("A"), motion("a"), STICK)
    whole = signs.add(facts("B"), motion("b"), STICK)
    with signs.store.writing() as connection:
        connection.execute(update(MOTION).where(MOTION.c.sign == sign.number).values(clip=b"?"))
    with pytest.raises(SignsError, match="the movement of `A` is damaged") as caught:
        signs.motion(sign)
    assert caught.value.code == "damaged-sign"
    assert "--original" in str(caught.value.remedy)
    assert signs.original(sign)[1] == motion("a").original
    assert signs.motion(whole) == motion("b")
    assert "the movement of `A` is damaged" in str(next(problems(signs)))


def test_half_a_sign_would_be_found(signs: SignDatabase) -> None:
    sign = signs.add(facts("A"), motion("a"), STICK)
    with signs.store.writing() as connection:
        connection.execute(MOTION.delete().where(MOTION.c.sign == sign.number))
    assert [str(p) for p in problems(signs)] == ["the sign `A` has no movement"]


@pytest.mark.long
def test_migrations_make_the_tables_that_the_code_uses(signs: SignDatabase) -> None:
    from alembic.autogenerate import compare_metadata
    from alembic.migration import MigrationContext

    with signs.store.reading() as connection:
        options = {"version_table": VERSION_TABLE, "compare_type": True}
        context = MigrationContext.configure(connection, opts=options)
        assert compare_metadata(context, METADATA) == []
        assert context.get_current_revision() == VERSION


@pytest.mark.long
def test_other_versions_and_other_databases_are_refused(
    signs: SignDatabase, database_place: str
) -> None:
    with signs.store.writing() as connection:
        connection.execute(text(f"UPDATE {VERSION_TABLE} SET version_num = '9999'"))
    for use in (SignDatabase.open, SignDatabase.create):
        with pytest.raises(SignsError, match=f"of version 9999; this azee reads version {VERSION}"):
            use(database_place)
    with signs.store.writing() as connection:
        connection.execute(text(f"UPDATE {VERSION_TABLE} SET version_num = '0000'"))
    with pytest.raises(SignsError, match="of version 0000; this azee needs") as caught:
        SignDatabase.open(database_place)
    assert "brings it up to date" in str(caught.value.remedy)
    with signs.store.writing() as connection:
        connection.execute(text(f"DROP TABLE {VERSION_TABLE}"))
    for use in (SignDatabase.open, SignDatabase.create):
        with pytest.raises(SignsError, match="is the database of another program"):
            use(database_place)


@pytest.mark.long
def test_making_a_database_again_keeps_its_signs(signs: SignDatabase, database_place: str) -> None:
    signs.add(facts("A"), motion("a"), STICK)
    again, before = SignDatabase.create(database_place)
    with again:
        assert before == VERSION
        assert names(again) == ["A"]


@pytest.mark.long
def test_a_row_that_breaks_a_rule_of_the_tables_is_refused(signs: SignDatabase) -> None:
    signs.add(facts("A"), motion("a"), STICK)
    row = {
        "skeleton": 1, "language": "", "name": "B", "variant": "", "kind": "guessed",
        "duration_s": 1.0, "frames": 1, "attack_s": 0.0, "decay_s": 0.0, "repositioned": False,
        "provenance": {}, "licence": "", "digest": "",
    }  # fmt: skip
    with pytest.raises(SignsError, match="refuses"), signs.store.writing() as connection:
        connection.execute(insert(SIGN).values(row))
    assert names(signs) == ["A"]


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Identity(" "), "the name of a sign is empty"),
        (lambda: Identity("a\nb"), "cannot be printed"),
        (lambda: Identity("\udce9"), "cannot be printed"),
        (lambda: Identity("a" * 201), "more than 200 characters"),
        (lambda: Identity("a", "b\0"), "the language of a sign has characters"),
        (lambda: facts("A", ""), "a tag is empty"),
        (lambda: Timing.of(1.0, 31, 30.0, 0.8, 0.3), "do not fit into 1 s"),
        (lambda: Timing(1.0, 31, 30.0, -0.1, 0.3), "do not fit into 1 s"),
        (lambda: SignFacts(Identity("A"), Timing.of(1.0, 31, 30.0), kind="x"), "none of the kinds"),
    ],
)
def test_what_no_sign_can_be(make: object, said: str) -> None:
    with pytest.raises(SignsError, match=said):
        make()  # type: ignore[operator]


def test_attack_and_decay_are_a_second_or_what_there_is_room_for() -> None:
    assert (Timing.of(3.0, 91, 30.0).attack_s, Timing.of(3.0, 91, 30.0).decay_s) == (1.0, 1.0)
    assert (Timing.of(1.0, 31, 30.0).attack_s, Timing.of(1.0, 31, 30.0).decay_s) == (0.5, 0.5)
    one = Timing.of(1.5, 46, 30.0, decay_s=1.2)
    assert one.attack_s == pytest.approx(0.3)
    assert one.decay_s == 1.2


def test_names_are_composed() -> None:
    assert Identity("e\N{COMBINING ACUTE ACCENT}te ").name == "éte"
