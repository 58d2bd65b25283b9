"""Statuses of the rules in a text are counted, and their libraries stamped."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from evaluations import program
from formats import schema

from azee.lang.library import shipped_library
from azee.lang.manifest import FILE, Manifest, RuleState, changes, read_beside
from azee.lang.provenance import names_by_status, provenance_of, written
from azee.lang.stocktaking import library_now, namespace_of
from azee.score.provenance import LibraryStamp
from azee_grammar.diagnostic import AZeeError
from azee_grammar.library import shipped, shipped_names

SAID = {"version": "1.0", "licence": "CC0-1.0", "language": "fsl", "citation": "Tea, signed"}
STATES = {
    "printed": "published",
    "shown": "read-off",
    "guessed": "placeholder",
    "seen": "judged by two signers, 2027-01",
    "silent": None,
    "misspelt": "plublished",
}
DRINKS = "".join(
    f"def {name}\n" + (f'    \'status "{status}"\n' if status else "") + "    blank 1\n\n"
    for name, status in STATES.items()
)


@pytest.fixture
def drinks(tmp_path: Path) -> Path:
    """The folder of a library with a rule of each status."""
    folder = tmp_path / "drinks"
    folder.mkdir()
    (folder / "all.azee").write_text(DRINKS, encoding="utf-8")
    return folder


def test_every_status_is_counted_the_most_trusted_first() -> None:
    calls = "".join(f":{name}\n" for name in (*STATES, "guessed", "unknown"))
    found = provenance_of(written(program(f"{DRINKS}{calls}")))
    assert list(found.statuses.items()) == [
        ("published", 1),
        ("read-off", 1),
        ("placeholder", 2),
        ("judged", 1),
        ("without a status", 3),
    ]
    assert found.applications == 8
    assert found.text == (
        "8 applications: 1 published, 1 read-off, 2 placeholder, 1 judged, 3 without a status"
    )
    assert found.libraries == ()


def test_one_application_is_singular_and_none_has_no_counts() -> None:
    assert provenance_of(written(program(":arbre\n"))).text == "1 application: 1 published"
    assert provenance_of([]).text == "0 applications"


def test_names_are_listed_once_by_status() -> None:
    found = names_by_status(written(program(f"{DRINKS}:shown\n:shown\n:printed\n:silent\n")))
    assert found == {
        "published": ["printed"],
        "read-off": ["shown"],
        "without a status": ["silent"],
    }


def test_a_library_is_stamped_as_its_manifest_says(drinks: Path) -> None:
    text = program("use 'drinks\n:shown\n:guessed\n", drinks.parent)
    assert provenance_of(written(text)).libraries == (LibraryStamp("drinks"),)
    manifest = Manifest.of(namespace_of(drinks), SAID)
    (drinks / FILE).write_text(manifest.text, encoding="utf-8")
    stamp = LibraryStamp("drinks", "1.0", "CC0-1.0", "Tea, signed", manifest.digest)
    assert provenance_of(written(text)).libraries == (stamp,)
    assert stamp.text == f"drinks 1.0 {manifest.digest}"


def test_rules_that_changed_after_the_manifest_was_written_are_named(drinks: Path) -> None:
    manifest = Manifest.of(namespace_of(drinks), SAID)
    (drinks / FILE).write_text(manifest.text, encoding="utf-8")
    later = DRINKS.replace("blank 1", "blank 2", 2)
    (drinks / "all.azee").write_text(later, encoding="utf-8")
    text = program("use 'drinks\n:shown\n:guessed\n", drinks.parent)
    assert [library.changed for library in provenance_of(written(text)).libraries] == [("shown",)]
    found = changes(manifest, library_now(str(drinks)))
    assert [(change.name, change.kind) for change in found] == [
        ("printed", "form"),
        ("shown", "form"),
    ]


# Manifests --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", shipped_names())
def test_the_manifest_of_a_library_that_ships_is_current(name: str) -> None:
    """If this fails: azee manifest grammar/azee_grammar/rules/*."""
    recorded = read_beside(shipped() / name)
    assert recorded is not None
    assert recorded == Manifest.of(shipped_library(name).namespace, recorded.said)
    assert recorded.name == name
    text = (shipped() / name / FILE).read_text(encoding="utf-8")
    assert recorded.text == text
    jsonschema.validate(json.loads(text), schema("manifest"))


def test_a_manifest_reads_back_as_it_was(drinks: Path) -> None:
    manifest = Manifest.of(namespace_of(drinks), SAID)
    (drinks / FILE).write_text(manifest.text, encoding="utf-8")
    assert read_beside(drinks) == manifest == library_now(str(drinks))
    assert {name: state.status for name, state in manifest.rules.items()} == STATES
    assert list(manifest.rules) == sorted(STATES)


def _state(text: str) -> RuleState:
    return RuleState.of(program(text).scope.own.rules["tea"])


def test_hashes_follow_meaning_and_not_layout() -> None:
    plain = _state('def tea\n    \'meaning "tea"\n    key(.5, look(^fwd))\n')
    laid_out = 'def tea\n    \'meaning "tea"\n    # warm\n    key(.5,  look(^fwd)) # here\n'
    assert _state(laid_out) == plain
    reworded = _state('def tea\n    \'meaning "a tea"\n    key(.5, look(^fwd))\n')
    assert (reworded.form == plain.form, reworded.header == plain.header) == (True, False)
    longer = _state('def tea\n    \'meaning "tea"\n    key(.6, look(^fwd))\n')
    assert (longer.form == plain.form, longer.header == plain.header) == (False, True)
    judged = _state(
        'def tea\n    \'meaning "tea"\n    \'status "judged"\n    key(.5, look(^fwd))\n'
    )
    assert (judged.form, judged.header) == (plain.form, plain.header)
    assert judged != plain


def test_the_weightiest_difference_names_a_change() -> None:
    old, new = RuleState("inferred", "1", "1"), RuleState("published", "1", "2")
    before = Manifest("a", **SAID, rules={"gone": old, "same": old, "trusted": old, "formed": old})
    formed = RuleState("published", "2", "2")
    worded = RuleState("inferred", "1", "2")
    rules = {"same": old, "trusted": new, "formed": formed, "new": new}
    after = Manifest("a", **SAID, rules=rules)
    kinds = [(change.name, change.kind) for change in changes(before, after)]
    assert kinds == [
        ("formed", "form"),
        ("gone", "removed"),
        ("new", "added"),
        ("trusted", "status"),
    ]
    assert [c.kind for c in changes(before, Manifest("a", **SAID, rules={"same": worded}))] == [
        *("removed", "removed", "header", "removed")
    ]


GOOD = {"name": "a", **SAID, "rules": {"tea": {"status": None, "form": "1", "header": "2"}}}


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ("tea", "it is not JSON"),
        ("[1]", "it is not an object"),
        ({**GOOD, "licence": 3}, "its `licence` is missing or not a text"),
        ({**GOOD, "rules": []}, "its `rules` are missing or not an object"),
        ({**GOOD, "rules": {"tea": 1}}, "the rule `tea` lacks a hash"),
        ({**GOOD, "rules": {"tea": {"form": "1"}}}, "the rule `tea` lacks a hash"),
        (
            {**GOOD, "rules": {"tea": {"form": "1", "header": "2", "status": 3}}},
            "the status of the rule `tea` is not a text",
        ),
    ],
)
def test_a_file_that_is_no_manifest_is_refused(content: object, why: str, tmp_path: Path) -> None:
    text = content if isinstance(content, str) else json.dumps(content)
    (tmp_path / FILE).write_text(text, encoding="utf-8")
    with pytest.raises(AZeeError) as caught:
        Manifest.read(tmp_path / FILE)
    (found,) = caught.value.diagnostics
    assert found.code == "bad-manifest"
    assert found.message.endswith(f"is no manifest of a library: {why}")


def test_what_is_no_library_is_told_with_a_remedy(tmp_path: Path) -> None:
    for name, hint in (("lfs", "did you mean `lsf`?"), ("zzz", "name a folder, or one of")):
        with pytest.raises(AZeeError) as caught:
            library_now(name)
        (found,) = caught.value.diagnostics
        assert found.code == "library-not-found"
        assert (found.help or "").startswith(hint)
    (tmp_path / "empty").mkdir()
    with pytest.raises(AZeeError) as caught:
        library_now(str(tmp_path / "empty"))
    assert "is no library: no file in it defines a rule" in caught.value.diagnostics[0].message
