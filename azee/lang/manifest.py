"""Manifests: what a library of rules is, and the state of each of its rules, as data.

A manifest is the file `library.json` in the folder of a library. Who keeps the library writes its
version, licence, language and citation; the program writes the rest. Two hashes stand for a rule:
one of its body in canonical layout, one of what its header says. So layout and comments change
neither, and a changed form can be told from a changed description.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from azee.lang.rule import Rule
from azee.lang.scope import Namespace
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.files import is_file
from azee_grammar.format import one_line

FILE = "library.json"
FIELDS = ("version", "licence", "language", "citation")
"""What only people can say of a library, all as text."""
_HASH_LENGTH = 16


@dataclass(frozen=True, slots=True)
class RuleState:
    """The status of a rule as its header has it, and the hashes of its form and its header."""

    status: str | None
    form: str
    header: str

    @classmethod
    def of(cls, rule: Rule) -> RuleState:
        """Take the state of a rule."""
        body = rule.definition.body
        form = _hash("" if body is None else one_line(body))
        entries = {symbol.name: text.text for symbol, text in rule.definition.entries}
        status = entries.pop("status", None)
        return cls(status, form, _hash(json.dumps(entries, sort_keys=True)))

    def as_json(self) -> dict[str, object]:
        """Return it as the manifest's JSON has it."""
        return {"status": self.status, "form": self.form, "header": self.header}


@dataclass(frozen=True)
class Manifest:
    """A library's name, what people say of it, and its rules by name."""

    name: str
    version: str
    licence: str
    language: str
    citation: str
    rules: Mapping[str, RuleState]

    @classmethod
    def of(cls, namespace: Namespace, said: Mapping[str, str]) -> Manifest:
        """Return the manifest of a library as it is now; `said` has the `FIELDS`."""
        rules = namespace.rules
        states = {name: RuleState.of(rules[name]) for name in sorted(rules)}
        return cls(namespace.name or "", **{key: said[key] for key in FIELDS}, rules=states)

    @classmethod
    def read(cls, path: Path) -> Manifest:
        """Read a manifest from its file. Raises: AZeeError: cannot-read or bad-manifest."""
        try:
            data = json.loads(path.read_text(encoding="utf-8"))  # not UTF-8 is a ValueError too
        except OSError as problem:
            reason = (problem.strerror or "it cannot be opened").lower()
            message = f"cannot read the manifest `{path}`: {reason}"
            raise AZeeError(Diagnostic("cannot-read", message, None)) from problem
        except ValueError as problem:
            raise _bad(path, "it is not JSON") from problem
        return cls._from_json(data, path)

    @classmethod
    def _from_json(cls, data: Any, path: Path) -> Manifest:
        if not isinstance(data, dict):
            raise _bad(path, "it is not an object")
        for key in ("name", *FIELDS):
            if not isinstance(data.get(key), str):
                raise _bad(path, f"its `{key}` is missing or not a text")
        rules = data.get("rules")
        if not isinstance(rules, dict):
            raise _bad(path, "its `rules` are missing or not an object")
        states = {name: _state(name, state, path) for name, state in rules.items()}
        said = {key: data[key] for key in FIELDS}
        return cls(data["name"], **said, rules=states)

    @property
    def said(self) -> dict[str, str]:
        """What people say of the library: the `FIELDS`."""
        return {key: getattr(self, key) for key in FIELDS}

    @cached_property
    def digest(self) -> str:
        """A hash of the forms of all rules: it changes when any body is to sign anything else."""
        return _hash(json.dumps({name: state.form for name, state in self.rules.items()}))

    @property
    def text(self) -> str:
        """The content of `library.json`: JSON with a line for each rule, so that lines compare."""
        head = {"name": self.name, **self.said, "digest": self.digest}
        states = (f"    {_json(n)}: {_json(s.as_json())}" for n, s in self.rules.items())
        lines = [
            *(f"  {_json(key)}: {_json(value)}," for key, value in head.items()),
            '  "rules": {',
            ",\n".join(states),
            "  }",
        ]
        return "\n".join(["{", *lines, "}", ""])


def read_beside(folder: Path) -> Manifest | None:
    """Return the manifest of the library in a folder, None if it has none.

    Raises: AZeeError: cannot-read or bad-manifest.
    """
    path = folder / FILE
    return Manifest.read(path) if is_file(path) else None


@dataclass(frozen=True, slots=True)
class Change:
    """How a rule differs between two states of a library; none where it is not in one of them."""

    name: str
    before: RuleState | None
    after: RuleState | None

    @property
    def kind(self) -> str:
        """`added`, `removed`, `form`, `status` or `header`: the weightiest difference."""
        if self.before is None:
            return "added"
        if self.after is None:
            return "removed"
        if self.before.form != self.after.form:
            return "form"
        return "status" if self.before.status != self.after.status else "header"


def changes(before: Manifest, after: Manifest) -> list[Change]:
    """Return the rules that differ, by name."""
    names = sorted({*before.rules, *after.rules})
    pairs = (Change(name, before.rules.get(name), after.rules.get(name)) for name in names)
    return [pair for pair in pairs if pair.before != pair.after]


def _state(name: str, data: Any, path: Path) -> RuleState:
    known = data if isinstance(data, dict) else {}
    status, form, header = known.get("status"), known.get("form"), known.get("header")
    if not (isinstance(form, str) and isinstance(header, str)):
        raise _bad(path, f"the rule `{name}` lacks a hash")
    if not (status is None or isinstance(status, str)):
        raise _bad(path, f"the status of the rule `{name}` is not a text")
    return RuleState(status, form, header)


def _bad(path: Path, why: str) -> AZeeError:
    hint = "`azee manifest` writes manifests; see docs/formats.md"
    message = f"`{path}` is no manifest of a library: {why}"
    return AZeeError(Diagnostic("bad-manifest", message, None, help=hint))


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:_HASH_LENGTH]
