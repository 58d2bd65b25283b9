"""`azee spell`: fingerspelling."""

from __future__ import annotations

import click

from azee.cli.spell_timing import evaluate, fit, timing, warp
from azee.cli.spell_word import word


class Spelling(click.Group):
    """Subcommands; what begins with none of their names is a text that is spelled."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the subcommand, its name and its arguments."""
        if args and args[0] not in self.commands:
            return word.name, word, args
        return super().resolve_command(ctx, args)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Leave options that are not the group's own to the text."""
        if args and args[0].startswith("-") and args[0] not in ctx.help_option_names:
            args = ["word", *args]
        return super().parse_args(ctx, args)


@click.group(
    "spell", cls=Spelling, short_help="Fingerspelling: words as movement, and their times."
)
def spell() -> None:
    """Spell words, and work on when their letters happen.

    `azee spell HELLO -o hello.mp4` is short for `azee spell word HELLO …`; the words `word`,
    `timing`, `fit`, `evaluate` and `warp` are spelled by the long form alone, or in capitals.
    """


spell.add_command(word)
spell.add_command(timing)
spell.add_command(fit)
spell.add_command(evaluate)
spell.add_command(warp)
