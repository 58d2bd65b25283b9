"""The body that `--rig` names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from azee_rig.rig import Rig


def load_body(name: str) -> Rig:
    """Load a rig that ships, by its name, or one from its folder.

    Raises: click.BadParameter: there is none, or it cannot be read.
    """
    from azee_rig.load import RigError, load_rig

    try:
        return load_rig(name)
    except RigError as error:
        raise click.BadParameter(str(error), param_hint="'--rig'") from error
