"""Small signs that tests store: nobody's movements, quickly made."""

from __future__ import annotations

from azee.signs.sign import Identity, Motion, SignFacts, Timing
from azee.signs.skeleton import StoredSkeleton

STICK = StoredSkeleton("stick", "d" * 64, ("root", "arm"), ("arm.flexion",))


def facts(name: str, *tags: str, language: str = "", variant: str = "") -> SignFacts:
    """What is known of a sign of a second and a half."""
    timing = Timing.of(1.5, 46, 30.0)
    return SignFacts(Identity(name, language, variant), timing, tags=tags)


def motion(name: str, size: int = 20) -> Motion:
    """Blobs that say whose they are."""
    return Motion(f"clip {name} ".encode() * size, f"file {name} ".encode() * size, f"{name}.bvh")
