"""What is checked again after an edit tells the same as checking everything."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from azee.lsp.document import Document
from azee.lsp.texts import Texts

ITEMS = (
    "def a\n    :chat\n",
    "def a\n    :b\n",
    "def a\n    blank 1\n",
    "def b\n    :a\n",
    "def b\n    azop\n        'x 'nodefault\n        seq(^x, :a)\n",
    "def b\n    :nobody\n",
    "def c\n    :#wrong\n",
    ":a\n",
    ":b\n",
    ":b('x = :a)\n",
    ":chat\n",
    ":chat(\n",
    'apply rule("a")\n',
    'def c\n    if has-rule(concat("a")) :chat nobody()\n',
    ":c\n",
    "places 'p ^Rssp\n",
    "places 'p @CH 'q ^p\n",
    "key .1 (lookat ^p)\n",
    "def a\n    'refers \"x\"\n    azop 'x 'nodefault :chat\n",
    ":a 'x ^Rssp\n",
    "seq(:a, .b)\n",
    "use 'core\n",
)


@given(st.lists(st.lists(st.sampled_from(ITEMS), max_size=6), min_size=2, max_size=5))
def test_incremental_messages_are_those_of_a_fresh_check(versions: list[list[str]]) -> None:
    texts = Texts()
    for number, items in enumerate(versions):
        document = Document("untitled:a", "".join(items), number)
        texts.put(document)
        fresh = Texts()
        fresh.put(document)
        assert texts.check(document) == fresh.check(document)
