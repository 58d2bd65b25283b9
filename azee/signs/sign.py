"""A sign: what is stored of it beside its motion."""

from __future__ import annotations

import hashlib
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from azee.signs.fault import SignsError

KINDS = ("recorded", "azee", "spelled")
"""Where a movement comes from: a recording, a text in AZee, letters."""
USUAL_S = 1.0
"""Attack and decay if nobody says otherwise (Gürel 2010, §4.2): a second each."""
LONGEST = 200
"""Characters of a name, a variant, a language or a tag."""


def digest_of(data: bytes) -> str:
    """Return the SHA-256 of bytes, in hexadecimal digits."""
    return hashlib.sha256(data).hexdigest()


def written(text: str, what: str) -> str:
    """Return a name as it is stored: composed (NFC), without blanks at its ends.

    Args: what: it names, for the message.
    Raises: SignsError: bad-sign: it is empty, too long, or has what cannot be printed.
    """
    plain = unicodedata.normalize("NFC", text).strip()
    if not plain:
        raise SignsError("bad-sign", f"{what} is empty")
    if len(plain) > LONGEST:
        raise SignsError("bad-sign", f"{what} has more than {LONGEST} characters")
    if not plain.isprintable():
        raise SignsError("bad-sign", f"{what} has characters that cannot be printed: {plain!r}")
    return plain


def optional(text: str, what: str) -> str:
    """Return a text that may be missing, as it is stored. Raises: SignsError: bad-sign."""
    return written(text, what) if text.strip() else ""


@dataclass(frozen=True, slots=True)
class Identity:
    """What tells signs of one skeleton apart.

    language, variant: may be empty. Raises: SignsError: bad-sign.
    """

    name: str
    language: str = ""
    variant: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", written(self.name, "the name of a sign"))
        for what in ("language", "variant"):
            object.__setattr__(self, what, optional(getattr(self, what), f"the {what} of a sign"))

    def __str__(self) -> str:
        behind = ", ".join(filter(None, (self.language, self.variant)))
        return f"{self.name} ({behind})" if behind else self.name


@dataclass(frozen=True, slots=True)
class Timing:
    """How long a sign lasts, and which parts of it lead in and out.

    duration_s: at least attack_s + decay_s (Gürel 2010, §4.2). rate: frames a second; None if
    frames are not evenly spaced. Raises: SignsError: bad-sign.
    """

    duration_s: float
    frames: int
    rate: float | None
    attack_s: float
    decay_s: float

    def __post_init__(self) -> None:
        if self.frames < 1 or not 0.0 <= self.duration_s < float("inf"):
            raise SignsError("bad-sign", "a sign has frames and a duration")
        fits = self.attack_s + self.decay_s <= self.duration_s + 1e-9
        if not (self.attack_s >= 0.0 and self.decay_s >= 0.0 and fits):
            raise SignsError(
                "bad-sign",
                f"attack {self.attack_s:g} s and decay {self.decay_s:g} s do not fit into "
                f"{self.duration_s:.3g} s",
            )

    @classmethod
    def of(
        cls,
        duration_s: float,
        frames: int,
        rate: float | None,
        attack_s: float | None = None,
        decay_s: float | None = None,
    ) -> Timing:
        """Make one; an attack or decay that is not given is a second, or what there is room for."""
        half = duration_s / 2
        if attack_s is None:
            room = half if decay_s is None else max(0.0, duration_s - decay_s)
            attack_s = min(USUAL_S, room)
        if decay_s is None:
            decay_s = min(USUAL_S, max(0.0, duration_s - attack_s))
        return cls(duration_s, frames, rate, attack_s, decay_s)


@dataclass(frozen=True, slots=True)
class SignFacts:
    """What is known of a sign; provenance is any JSON.

    Raises: SignsError: bad-sign: a tag or the kind cannot be.
    """

    identity: Identity
    timing: Timing
    kind: str = "recorded"
    tags: tuple[str, ...] = ()
    licence: str = ""
    provenance: Mapping[str, Any] = field(default_factory=dict)
    repositioned: bool = False

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise SignsError("bad-sign", f"`{self.kind}` is none of the kinds {', '.join(KINDS)}")
        tags = sorted({written(tag, "a tag") for tag in self.tags})
        object.__setattr__(self, "tags", tuple(tags))
        object.__setattr__(self, "licence", optional(self.licence, "the licence of a sign"))


@dataclass(frozen=True, slots=True)
class Motion:
    """The two blobs of a sign: the clip as npz on its skeleton, and the file that it came from."""

    clip: bytes
    original: bytes
    original_name: str


@dataclass(frozen=True, slots=True)
class Sign:
    """A sign of a database.

    number: of its row. skeleton: name of the body it was stored for; skeleton_digest: what that
    skeleton is. digest: SHA-256 of its clip.
    """

    number: int
    facts: SignFacts
    skeleton: str
    skeleton_digest: str
    digest: str

    @property
    def identity(self) -> Identity:
        """Name, language and variant."""
        return self.facts.identity

    def document(self) -> dict[str, Any]:
        """Return what programs read of it, as docs/signs.md describes it."""
        facts, timing = self.facts, self.facts.timing
        return {
            "name": facts.identity.name,
            "language": facts.identity.language,
            "variant": facts.identity.variant,
            "kind": facts.kind,
            "tags": list(facts.tags),
            "skeleton": self.skeleton,
            "skeleton_digest": self.skeleton_digest,
            "duration_s": timing.duration_s,
            "frames": timing.frames,
            "rate": timing.rate,
            "attack_s": timing.attack_s,
            "decay_s": timing.decay_s,
            "repositioned": facts.repositioned,
            "licence": facts.licence,
            "provenance": dict(facts.provenance),
            "digest": self.digest,
        }
