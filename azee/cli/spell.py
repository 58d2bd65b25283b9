"""`azee spell`: fingerspelling."""

from __future__ import annotations

import click

from azee.cli.spell_timing import evaluate, fit, timing, warp


@click.group("spell", short_help="Fingerspelling: when its letters happen.")
def spell() -> None:
    """Work on fingerspelled words."""


spell.add_command(timing)
spell.add_command(fit)
spell.add_command(evaluate)
spell.add_command(warp)
