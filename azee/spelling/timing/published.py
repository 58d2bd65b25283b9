"""What Wheatland (2016) publishes about the timing of fingerspelling, with the places.

N. Wheatland, Capturing and Animating Hand and Finger Motion for 3D Communicative Characters,
University of California, Riverside, 2016, chapters 4 and 5 and appendices B and C. One fluent
student signer, recorded at 120 Hz. Times are in seconds.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

Style: TypeAlias = Literal["normal", "careful"]


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


FRAME_S = 1.0 / 120.0
"""A frame of the recordings, and the step between classes of hold times (section 4.2.1)."""
CLASSES = 40
"""Classes of hold times: 8.33 to 333.33 ms (section 4.2.1)."""

HOLD_S: Mapping[Style, Mapping[int, tuple[float, float]]] = {
    "careful": {3: (0.16, 0.03), 4: (0.14, 0.03), 5: (0.13, 0.02)},
    "normal": {3: (0.10, 0.03), 4: (0.09, 0.02), 5: (0.08, 0.01)},
}
"""Mean and deviation of letter holds, by letters of the word; 5 is five and more (table 4.1)."""
DOUBLES_FASTER: Mapping[Style, float] = {"careful": 0.16, "normal": 0.22}
"""How much faster words with double letters are than others of the same length (section 4.1)."""
REPEATED_FASTER = 0.20
"""How much faster the last spelling of a word in a text is than the first (section 4.1)."""
REPEATED = {"COACHELLA": 5, "MADONNA": 3}
"""The words that were spelled repeatedly, and how often (section 4.1)."""
ELEPHANT_FASTER = 0.29
"""How much faster the middle letters of ELEPHANT are than those of CRYPTOGRAPHY (section 4.1)."""
MOBILE_S = (34 / 29.97, 14 / 29.97)
"""First and 23rd spelling of MOBILE in a conversation (Thumann, cited in section 2.3.2)."""
BY_DIFFICULTY = _words(
    "HEAVEN ELEPHANT HOODIE GUITAR POTATO MOVIE ARREST PEDANTIC ALUMNUS CRYPTOGRAPHY PSYCHIATRY"
)
"""The longer words, from the easiest to spell to the hardest, as the signer says (appendix C)."""

ENTRIES = 304
"""Letters in the data of hold times (section 4.2)."""
TRAINING_SIZES = (243, 152, 91)
"""Letters in the reduced training data of figure 4.6."""
ACCURACY = {"9 features, no word": 0.6053, "10 features": 0.7237, "9 features, no shape": 0.7500}
"""Share of letters put into their class of hold times (section 4.2.1)."""
HOLD_ERROR_S, HOLD_BIAS_S = 0.01382, 0.00817
"""Mean error and mean difference of the classifier, a letter (section 4.3)."""
CONSTANT_ERROR_S, CONSTANT_BIAS_S = 0.1709, -0.1677
"""The same for the constant model (section 4.3)."""

CORRELATION = {"RMSD": 0.44, "MD": 0.42, "CD": 0.38, "GPLVMD": 0.22}
"""Of transition times with distances of letter poses (figure 4.7)."""
TRANSITION_ERROR_S = 0.04469
"""Mean error of the regression on RMSD (section 4.2.2)."""
TRANSITION_MEAN_S = 0.21611
TRANSITION_RANGE_S = (0.08333, 0.39167)
"""All recorded transition times (section 4.2.2)."""
T_TO_A_S, A_AND_T_S = 0.125, 0.150
"""The fastest transition but for doubles, and the mean of both ways (section 4.2.2)."""
LARGEST_RMSD, RMSD_E_Z = 1.10, 0.51
"""Radians (section 4.2.2)."""

CONSTANT_HOLD_S, CONSTANT_LAST_S, CONSTANT_TRANSITION_S = 0.243, 0.800, 0.250
"""The constant model: of Huenerfauth, with transitions as in section 4.3."""
WORD_ERROR_S: Mapping[str, float] = {"variable": 0.1225, "constant": 2.1025}
"""Mean error of whole words (table 4.3)."""

THREE = _words("THE HER HIM BAT CAB ALL BUT NOT CAN OLD WHO MAN NEW")
FOUR = _words("SINK BELL DOOR WANT AQUA ENDS GRIP VAIN THIN ROTS ROMP PUNT PORT FAST TEAM VEIN")
LONGER = _words(
    "HEAVEN GUITAR HOODIE ELEPHANT CRYPTOGRAPHY PSYCHIATRY ALUMNUS PEDANTIC ARREST POTATO MOVIE"
)
"""Words of the recording (appendix B, objectives 3 to 5)."""
NAMES = _words(
    "KATHERINE JASON COLEMAN JACKSON SOPHIE VICTOR MICHAEL DAVID LOLLAPALOOZA FOX GOOGLE YAHOO "
    "AOL FACEBOOK TWITTER TUMBLR EBAY AIRBNB ABC NBC CBS"
)
"""Words in the sentences of appendix B (objective 6) that make up 304 letters with the others.

Which ones the 304 entries hold is not published. These do hold every letter, as theirs did.
"""
WORDS = (*THREE, *FOUR, *LONGER, *NAMES)
STUDIED = _words("GUITAR HEAVEN ARREST ELEPHANT PSYCHIATRY DAVID MICHAEL VICTOR")
"""The words that people watched (section 5.2)."""


def length_class(word: str) -> int:
    """Row of table 4.1 for a word: 3, 4, or 5 for five and more letters."""
    return min(max(len(word), 3), 5)
