"""The typed input of a session as a file, which gives the same results again."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from azee.formats import writing
from azee.repl.refusal import Refusal
from azee.repl.session import LAST, Session
from azee_grammar.syntax import (
    Application,
    Expr,
    Hole,
    Named,
    Number,
    Parameter,
    SideWord,
    Symbol,
    Text,
)


def save_text(session: Session, path: Path) -> None:
    """Write the libraries, the rules and the last expression that were typed.

    Raises: Refusal: the last expression needs a result that no file contains. AZeeError:
        cannot-write.
    """
    from azee.export.files import replace_file

    last = session.last.expr if session.last else None
    if last is not None and any(name == LAST for name in _parameters(last)):
        raise Refusal("the last expression speaks of `^_`, which means nothing in a file")
    items = [use.span.text for use in session.uses.values()]
    if items and not session.files:
        items.insert(0, "use 'lsf")
    items += session.texts.values()
    items += [session.last.text] if session.last else []
    if not items:
        raise Refusal("nothing has been typed yet")
    with writing(path), replace_file(path) as file:
        file.write("\n\n".join(dict.fromkeys(items)).encode() + b"\n")


def _parameters(expr: Expr | Named) -> Iterator[str]:
    waiting: list[Expr | Named] = [expr]
    while waiting:
        match waiting.pop():
            case Parameter(name=name):
                yield name
            case Named(value=value):
                waiting.append(value)
            case Application(operands=operands):
                waiting += operands
            case Number() | Text() | Symbol() | Hole() | SideWord():
                pass
