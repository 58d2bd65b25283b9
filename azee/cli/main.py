"""The `azee` command: its subcommands, and what leaves it with which exit code.

The input's faults arrive here as `AZeeError` and are shown as diagnostics. Any other exception is
a fault of ours and keeps its traceback.
"""

from __future__ import annotations

import errno
import gc
import os
import signal
import sys
from collections.abc import Sequence
from typing import NoReturn

import click

from azee.cli.commands import Commands
from azee.cli.console import DONE, FAULT, INTERRUPTED, show
from azee_grammar.diagnostic import AZeeError, Diagnostic

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Why output cannot be written, though somebody takes it."""


@click.group(
    commands=Commands(),
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(package_name="azee")
def azee() -> None:
    """Interpret AZee, a formal language of sign languages, and compile it to a signing body."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and leave the process with its exit code."""
    # What a command loads stays: looking for garbage in it again and again takes a tenth of it.
    gc.set_threshold(50_000, 20, 20)
    signal.signal(signal.SIGTERM, _stop)
    _open_what_is_closed()
    sys.exit(run(arguments))


def _stop(_: int, __: object) -> NoReturn:
    """Leave as after Ctrl-C, so that no half-written file stays."""
    sys.exit(128 + signal.SIGTERM)


def _open_what_is_closed() -> None:
    """Give a process that was started with closed streams streams that lead nowhere.

    Otherwise the next file that is opened would be taken for standard output or error.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            nowhere = os.open(os.devnull, os.O_RDWR)
            if nowhere != number:
                os.dup2(nowhere, number)
                os.close(nowhere)
            setattr(sys, name, os.fdopen(number, "w" if number else "r", encoding="utf-8"))


def _abandon_output() -> None:
    """Let the interpreter's own flush fail silently: nobody takes our output."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    try:
        code = azee.main(arguments, prog_name="azee", standalone_mode=False)
        if not sys.stdout.closed:
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
        _abandon_output()
        return FAULT
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG and error.filename is not None:
            message = f"the name `{os.fsdecode(error.filename)}` is too long"
            show([Diagnostic("cannot-read", message, None)])
            return FAULT
        if error.errno not in FULL or error.filename is not None:
            raise
        _abandon_output()
        reason = os.strerror(error.errno or 0).lower()
        show([Diagnostic("cannot-write", f"cannot write standard output: {reason}", None)])
        return FAULT
    return code if isinstance(code, int) else DONE


if __name__ == "__main__":
    main()
