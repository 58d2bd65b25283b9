"""`azee capture`: hands from few markers."""

from __future__ import annotations

import click

from azee.cli.capture_hand import evaluate, reconstruct
from azee.cli.capture_model import choose, train


@click.group("capture", short_help="Hands from few markers.")
def capture() -> None:
    """Choose markers for hands, and make the whole hand from them (Wheatland 2016, chapter 3).

    Record a hand once with all markers, choose a few of them, train a model, and film with the few.
    """


capture.add_command(choose)
capture.add_command(train)
capture.add_command(reconstruct)
capture.add_command(evaluate)
