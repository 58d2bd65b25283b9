"""Which names of rules an item of a text may mean."""

from __future__ import annotations

from collections.abc import Iterator

from azee_grammar.syntax import (
    Application,
    Definition,
    Expr,
    Item,
    Named,
    OperatorName,
    RuleName,
    Utterance,
)


def mentions(item: Item) -> Iterator[str]:
    """Yield the names in an item that may be names of rules; a definition's own name is one."""
    waiting: list[Expr | Named] = []
    if isinstance(item, Definition):
        yield item.name
        waiting += [] if item.body is None else [item.body]
    elif isinstance(item, Utterance):
        waiting.append(item.expr)
    while waiting:
        node = waiting.pop()
        if isinstance(node, Named):
            waiting.append(node.value)
        elif isinstance(node, Application):
            if isinstance(node.head, RuleName | OperatorName):
                yield node.head.name
            waiting += node.operands
