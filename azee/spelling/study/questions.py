"""What participants are asked beside the choices (Wheatland 2016, section 5.2)."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

Choice: TypeAlias = Literal["first", "second", "none"]
CHOICES: tuple[Choice, ...] = get_args(Choice)

AGES = ("18–25", "26–35", "36–45", "46–55", "56–65", "66+")
FLUENCIES = (
    "Fluent: it is my first or main language.",
    "Fluent: I learnt it later, and am an expert.",
    "Somewhat fluent: I have studied it.",
    "Not fluent: I know some of it.",
    "I do not know it.",
)
WHICH = "Which of these animations is more like a person's fingerspelling, the more natural one?"
OPEN = (
    "By what did you decide which animation was more natural?",
    "Which words could you read?",
    "Were some clips easier to understand than others? What made them so?",
    "What was missing that would make these animations better?",
    "Is there anything else that you wish to say?",
)
"""In our words; the questions are those of the thesis."""
