"""The Sign Language of the Netherlands as a library of AZee rules: `use 'ngt`.

The signs are notated in gestural SiGML; NOTICE says by whom. The first use writes a rule for each
into the user's cache folder, which takes some seconds, once for each version of the converter.
"""

from pathlib import Path

ARCHIVE = Path(__file__).parent / "ngt.zip"
SOURCE = "NGT lexicon of upf-gti/performs, Apache-2.0"


def folder() -> Path:
    """Return the folder of the rules."""
    from azee.lexicon.installing import rules_of

    return rules_of(ARCHIVE, "ngt", SOURCE)
