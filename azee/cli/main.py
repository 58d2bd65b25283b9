"""The `azee` command: its subcommands, and what leaves it with which exit code.

The input's faults arrive here as `AZeeError` and are shown as diagnostics. Any other exception is
a fault of ours and keeps its traceback.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence

import click

from azee.cli.check import check
from azee.cli.clip import clip
from azee.cli.compile import compile_
from azee.cli.console import DONE, FAULT, INTERRUPTED, show
from azee.cli.find import find
from azee.cli.fmt import fmt
from azee.cli.lsp import lsp
from azee.cli.render import render
from azee.cli.repl import repl
from azee.cli.retarget import retarget
from azee.cli.rig import rig
from azee.cli.rules import rules
from azee.cli.score import score
from azee_grammar.diagnostic import AZeeError


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(package_name="azee")
def azee() -> None:
    """Interpret AZee, a formal language of sign languages, and compile it to a signing body."""


azee.add_command(compile_)
azee.add_command(check)
azee.add_command(fmt)
azee.add_command(score)
azee.add_command(render)
azee.add_command(clip)
azee.add_command(find)
azee.add_command(lsp)
azee.add_command(rules)
azee.add_command(rig)
azee.add_command(retarget)
azee.add_command(repl)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and leave the process with its exit code."""
    # What a command loads stays: looking for garbage in it again and again takes a tenth of it.
    gc.set_threshold(50_000, 20, 20)
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    try:
        code = azee.main(arguments, prog_name="azee", standalone_mode=False)
        sys.stdout.flush()
    except AZeeError as error:
        show(error.diagnostics)
        return FAULT
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        return INTERRUPTED
    except BrokenPipeError:
        # Whoever read our output has gone; so that the interpreter's own flush fails silently.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAULT
    return code if isinstance(code, int) else DONE
