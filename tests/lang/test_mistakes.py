"""Every mistake of evaluation: its code, its place, and what is said about it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
from evaluations import found, place, problems, program

import azee.lang
import azee.score
from azee.lang import values
from azee.lang.machine import Limits
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Application, Hole, OperatorName
from azee_solver.geometry import Side


@dataclass(frozen=True)
class Mistake:
    """A text, what is found in it, and words of the message or the help of the first."""

    text: str
    found: tuple[str, ...]
    words: str = ""
    help: str = ""


def _mistake(text: str, *places: str, words: str = "", hint: str = "") -> Mistake:
    return Mistake(text, places, words, hint)


NAMES = (
    _mistake(":arbr", "unknown-rule 1:1", words="`:arbr`", hint="`:arbre`"),
    _mistake(":bien x", "unknown-rule 1:1", hint="`:bien(x)`"),
    _mistake(":sync", "unknown-rule 1:1", hint="without `:`"),
    _mistake("seq (list :gret :arbr)", "unknown-rule 1:11", "unknown-rule 1:17"),
    _mistake("kye .1 (look ^up)", "unknown-operator 1:1", hint="`key`"),
    _mistake("tree", "unknown-operator 1:1", hint="`:tree`"),
    _mistake("blank palm", "unknown-operator 1:7", hint="`!palm`"),
    _mistake("key 1 (lookat FH)", "unknown-operator 1:15", hint="`@FH`"),
    _mistake("key 1 (lookat Mssp)", "unknown-operator 1:15", hint="`^Mssp`"),
    _mistake("blank(def(1))", "unknown-operator 1:7", words="beginning of a line", hint="let"),
    _mistake("key 1 (lookat ^Msp)", "unknown-name 1:15", hint="`^Mssp`"),
    _mistake("key 1 (look ^vec)", "unknown-name 1:13", hint="without `^`"),
    _mistake("seq(list(^arbre))", "unknown-name 1:10", hint="`:arbre`"),
    _mistake("def f\n    azop 'loc ^Mssp lookat(^lok)", "unknown-name 2:28", hint="`^loc`"),
    _mistake("key 1 (look dir(!plam(s)))", "unknown-bone 1:17", hint="`!palm`"),
    _mistake("key 1 (look dir(!palm_L))", "unknown-bone 1:17", hint="`!palm(L)`"),
    _mistake("key 1 (lookat @CHIN_TIP)", "unknown-site 1:15", hint="`@CH`"),
    _mistake("key 1 (lookat @I_TIP_R)", "unknown-site 1:15", hint="`@I_TIP(R)`"),
    _mistake("key 1 (morph 'smil 1)", "unknown-morph 1:14", hint="`'smile`"),
    _mistake("key 1 (morph 'AU45 1)", "unknown-morph 1:14", hint="AU43"),
    _mistake(
        "def f\n    azop 'w 1 morph('smil, ^w)", "unknown-morph 2:21", words="AZee has no morph"
    ),
)

ARGUMENTS = (
    _mistake(":info-about 'topic :bien", "missing-argument 1:1", words="`'info`"),
    _mistake("info-about()", "missing-argument 1:1", words="`'topic` and `'info`"),
    _mistake(":info-about 'topic :bien 'inf :bien", "unknown-argument 1:26", hint="`'info`"),
    _mistake(":arbre('lok = ^Mssp)", "unknown-argument 1:8", hint="`'loc`"),
    _mistake(":Irak 'loc ^Mssp", "too-many-arguments 1:7", words="takes no arguments"),
    _mistake("arbre(^Mssp, ^Rssp)", "too-many-arguments 1:14", words="takes 1 argument: `'loc`"),
    _mistake("arbre(^Mssp, 'loc = ^Rssp)", "duplicate-argument 1:14", words="`'loc`"),
    _mistake("arbre('loc = ^Mssp, ^Rssp)", "positional-after-named 1:21"),
    _mistake(":info-about 'topic 'info :bien", "missing-value 1:13", words="`'topic`"),
    _mistake(":info-about 'topic :bien 'info", "missing-value 1:26", words="`'info`"),
    _mistake(":arbre ^Mssp", "expected-argument-name 1:8", hint="`'loc`"),
    _mistake(
        ":tens-units\n    'tens list :bien :chat\n    'units .nb-5",
        "expected-argument-name 2:16",
        hint="list(:bien, :chat)",
    ),
    _mistake(
        ":tens-units 'tens list :bien 'b 'units .nb-5",
        "expected-argument-name 1:24",
        hint="list(:bien, 'b)",
    ),
    _mistake(
        ":arbre\n    'loc list :bien :arbre\n        'loc ^Mssp",
        "expected-argument-name 2:15",
        hint="`list(…)`",
    ),
    _mistake("blank", "missing-argument 1:1", hint="`blank DURATION`"),
    _mistake("key 1 (look)", "missing-argument 1:8", words="lacks its vector"),
    _mistake("blank 1 2", "too-many-arguments 1:9", words="takes 1 operand"),
    _mistake("key 1 (lookat vtranslate(^Mssp))", "missing-argument 1:15"),
    _mistake("blank add(1)", "missing-argument 1:7", words="at least 2"),
    _mistake("key 1 (transpath @CH straight(1))", "too-many-arguments 1:31", words="no operands"),
    _mistake("key 1 (place @CH ^Mssp 'dits 1)", "unknown-keyword 1:24", hint="`'dist`"),
    _mistake("key 1 (place @CH ^Mssp 'dist)", "missing-value 1:24", words="a number"),
    _mistake("key 1 (place @CH ^Mssp 'dist 1 'dist 2)", "duplicate-argument 1:32"),
    _mistake("key 1 (orient 'dri !head 'along ^up)", "unknown-keyword 1:15", hint="`'dir`"),
    _mistake("key 1 (orient 'dir !head 'near ^up)", "unknown-keyword 1:26", hint="`'across`"),
    _mistake("seq (list) 'gap", "missing-value 1:12"),
    _mistake("hold (blank 1) 1 'only 'feet", "unknown-keyword 1:24", hint="`'hands`"),
    _mistake("let 'x 1", "missing-argument 1:1", hint="let 'NAME VALUE BODY"),
    _mistake("let x 1 2", "expected-argument-name 1:5"),
    _mistake("if (lt 1 2) (blank 1)", "missing-argument 1:1"),
    _mistake("if (lt 1 2) :bien :bien :bien", "too-many-arguments 1:25"),
    _mistake("if and() :bien :bien", "missing-argument 1:4"),
    _mistake("apply()", "missing-argument 1:1"),
    _mistake("azop 'x 1", "missing-argument 1:1", words="no body"),
    _mistake("azop 'x 1 'x 2 :bien", "duplicate-argument 1:11"),
    _mistake("azop x 1 :bien", "expected-argument-name 1:6"),
    _mistake("key 1 (morph 'AU1 'AU2 1)", "missing-value 1:14", words="has no weight"),
)

TYPES = (
    _mistake(
        "key 1 (place 3 ^Mssp)",
        "wrong-type 1:14",
        words="`place` wants a site as its first operand, not a number",
    ),
    _mistake("key 1 (place 3 4)", "wrong-type 1:14", "wrong-type 1:16"),
    _mistake("key 1 (lookat 'Mssp)", "wrong-type 1:15", hint="`^Mssp`"),
    _mistake("key 1 (vec 0 0 1)", "wrong-type 1:8", words="not a vector"),
    _mistake("key 1 :bien", "wrong-type 1:7", words="not a score"),
    _mistake("key (look ^up) 1", "wrong-type 1:6", "wrong-type 1:16"),
    _mistake("key 1 (place @CH ^Mssp 'dist ^up)", "wrong-type 1:30", words="as its `'dist`"),
    _mistake("key 1 (cstr 1)", "wrong-type 1:13", words="`cstr`"),
    _mistake("key 1 (cstr (list (look ^up) 1))", "wrong-type 1:14"),
    _mistake("key 1 (look vsum(^up, ^fwd, 3))", "wrong-type 1:29", words="third operand"),
    _mistake("seq (list (blank 1) 2)", "wrong-type 1:6", words="element 2 of the list is a number"),
    _mistake("seq :bien", "wrong-type 1:5", words="not a score"),
    _mistake("sync 'A ^up", "wrong-type 1:9", words="block `A` wants a score"),
    _mistake("sync 'A (look ^up)", "wrong-type 1:10", hint="key D CSTR"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'start 3", "wrong-type 1:39", words="a ref such as"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'with 3", "wrong-type 1:38", words="a block"),
    _mistake(
        "sync 'A (blank 1) 'B (blank 1) 'start/dur 'A:end 'x", "wrong-type 1:50", words="seconds"
    ),
    _mistake("if 1 :bien :bien", "wrong-type 1:4", hint="`eq`"),
    _mistake("if (and 1 2) :bien :bien", "wrong-type 1:9", "wrong-type 1:11"),
    _mistake("blank eq(^up, ^up)", "wrong-type 1:15", words="vectors"),
    _mistake("blank eq(s, L)", "wrong-type 1:13", words="dominant hand"),
    _mistake("blank lt(1, 'a)", "wrong-type 1:13"),
    _mistake("apply :bien", "wrong-type 1:7", hint="`.name`"),
    _mistake("seq map(:bien, list(1))", "wrong-type 1:9"),
    _mistake("mirror 1", "wrong-type 1:8", words="a score or constraints"),
    _mistake("hold (blank 1) 1 'only (list 1)", "wrong-type 1:25"),
    _mistake("key 1 (morph 1 2)", "wrong-type 1:14"),
    _mistake("key 1 :#bien", "wrong-type 1:7", words="posture rule"),
    _mistake("fixed :#fist", "wrong-type 1:7", words="constraints"),
)

BODY = (
    _mistake("key 1 (look dir(!palm))", "bad-side 1:17", words="lacks its side"),
    _mistake("key 1 (lookat @I_TIP)", "bad-side 1:15", hint="`@I_TIP(s)`"),
    _mistake("key 1 (look dir(!head(s)))", "bad-side 1:23", words="middle of the body"),
    _mistake("key 1 (look dir(!palm(1)))", "bad-side 1:23", words="a number is no side"),
    _mistake("key 1 (look dir(!index(s)))", "bad-phalanx 1:17", words="lacks its phalanx"),
    _mistake("key 1 (look dir(!index(s, 4)))", "bad-phalanx 1:27", words="1, 2 and 3, not 4"),
    _mistake("key 1 (look dir(!index(s, 1.5)))", "bad-phalanx 1:27", words="not 1.5"),
    _mistake("key 1 (lookat @I_BACK(s, 3))", "bad-phalanx 1:26", words="1 and 2, not 3"),
    _mistake("key 1 (look dir(!palm(s, 2)))", "too-many-arguments 1:26"),
    _mistake("key 1 (look dir(!head(1)))", "too-many-arguments 1:23"),
    _mistake("key 1 (morph 'index_bend 1)", "bad-side 1:14", hint="`'index_bend s 1`"),
    _mistake("key 1 (morph 'AU4 s 1)", "bad-side 1:19", words="takes no side"),
    _mistake("key 1 (trill !palm(s) ^up w)", "bad-side 1:27", hint="leave it out"),
)

TIMES = (
    _mistake("sync", "missing-argument 1:1"),
    _mistake("sync (blank 1)", "bad-block-name 1:7"),
    _mistake("sync 'A", "missing-value 1:6"),
    _mistake("sync 'A:B (blank 1)", "bad-block-name 1:6", words="`:` and `/`"),
    _mistake("sync 'A (blank 1) 'start 'A:end", "bad-block-name 1:19", words="no rule"),
    _mistake("sync 'A (blank 1) 'B (blank 1)", "missing-argument 1:19", hint="`'start/end`"),
    _mistake(
        "sync 'A (blank 1) 'B (blank 1) 'strat 'A:end", "unknown-sync-rule 1:32", hint="start"
    ),
    _mistake(
        "sync 'A (blank 1) 'B (blank 1) :bien",
        "unknown-sync-rule 1:32",
        words="the rule of the block `B` is expected here",
    ),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'start/end 'A:end", "missing-argument 1:19"),
    _mistake(
        "sync\n    'A (blank 1)\n    'B key .1 (look ^up)\n    'start 'A:end",
        "unknown-sync-rule 3:12",
        words="does not belong to `key`",
        hint="`key(…)`",
    ),
    _mistake("sync 'A (blank 1) 'A (blank 1) 'with 'A", "duplicate-block 1:19"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'start 'a:end", "unknown-block 1:39", hint="`'A`"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'with 'C", "unknown-block 1:38"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'with 'A/C", "unknown-block 1:38"),
    _mistake(
        "sync 'A (blank 1) 'H (hold 'B 1) 'start 'A:end",
        "unknown-block 1:23",
        hint="is `A`",
    ),
    _mistake("hold 'A 1", "unknown-block 1:1", words="stands alone"),
    _mistake("seq (list (hold 'A 1))", "unknown-block 1:6"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'start 'A", "bad-ref 1:39", words="but not when"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'start 'A:soon", "bad-ref 1:39", words="`soon`"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'with 'A:end", "bad-ref 1:38", hint="`'A`"),
    _mistake(
        "sync 'A (blank 1) 'B (blank 1) 'start 'C:end 'C (blank 1) 'end 'B:start",
        "cyclic-sync 1:19",
        words="`B:start` needs `C:end` needs `B:start`",
    ),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'start/end 'A:end 'A:start", "negative-duration 1:19"),
    _mistake("blank -1", "negative-duration 1:7"),
    _mistake("key neg(1) (look ^up)", "negative-duration 1:5"),
    _mistake("seq (list) 'gap -1", "negative-duration 1:17"),
    _mistake("sync 'A (blank 1) 'B (blank 1) 'start/dur 'A:end -1", "negative-duration 1:50"),
    _mistake("sync 'A (blank 1) 'B (seq (list)) 'with 'A", "cannot-stretch 1:19"),
    _mistake("sync 'A (blank 1) 'B (fixed (blank 2)) 'with 'A", "cannot-stretch 1:19"),
    _mistake("key 1 (transpath @CH straight)", "transpath-ends 1:8", words="before or after"),
    _mistake(
        "seq (list (key 1 (place @I_TIP(s) ^Mssp)) (key 1 (transpath @I_TIP(s) straight)))",
        "transpath-ends 1:51",
        words="no block places `@I_TIP(s)` after",
    ),
    _mistake(
        "seq (list (key 1 (cstr (place @CH ^Mssp) (transpath @CH straight))) "
        "(key 1 (place @CH ^Mssp)))",
        "transpath-ends 1:43",
        words="before this path",
    ),
    _mistake(
        "key 1 (cstr (orient 'dir !head 'along ^up) (orient 'dir !head 'along ^up))",
        "orient-conflict 1:45",
        words="the dir of `!head`",
    ),
    _mistake(
        "key 1 (cstr (orient 'nrm !palm(s) 'along ^up) (orient 'nrm !palm(R) 'along ^up))",
        "orient-conflict 1:48",
        words="when the dominant hand is the right one",
    ),
    _mistake(
        "key 1 (with-dominant R (cstr (orient 'nrm !palm(s) 'along ^up) "
        "(orient 'nrm !palm(R) 'along ^up)))",
        "orient-conflict 1:25",
    ),
    _mistake("mirror (key 1 (morph 'palm_l_closed 1))", "unknown-morph 1:9", words="mirror image"),
)

VALUES = (
    _mistake("blank div(1, 0)", "division-by-zero 1:14"),
    _mistake("blank nth(list(1), 2)", "index-range 1:20", words="elements 1 to 1"),
    _mistake("blank nth(list(), 1)", "index-range 1:19", words="empty"),
    _mistake("blank nth(list(1, 2), 1.5)", "index-range 1:23"),
    _mistake(
        "let 'h 99999999999999999 let('h, mul(^h, ^h, ^h, ^h, ^h), blank(mul(^h, ^h, ^h, ^h, ^h)))",
        "number-range 1:65",
    ),
    _mistake("key 1 (trill !head ^up 'freq 0)", "number-range 1:30"),
    _mistake("key 1 (transpath @CH circle(^up, 0))", "number-range 1:34"),
    _mistake("blank 100000", "size-limit 1:7", words="a day"),
    _mistake("seq map(.nb-5, range(1, 1000000))", "size-limit 1:16"),
    _mistake("3", "not-a-score 1:1", words="a number"),
    _mistake("look ^up", "not-a-score 1:1", hint="key D CSTR"),
    _mistake(".bien", "not-a-score 1:1", hint="`:name`"),
    _mistake("list :bien", "not-a-score 1:1", hint="`seq`"),
    _mistake(
        "def f\n    :bien\ndef f\n    :bien\n:f", "duplicate-definition 3:5", words="two rules `f`"
    ),
    _mistake("use 'lfs\n:bien", "library-not-found 1:5", "unknown-rule 2:1", hint="`'lsf`"),
    _mistake("use '../secret\n", "library-not-found 1:5", hint="--library"),
    _mistake("def f\n    :f\n:f", "recursion-limit 2:5", hint="without end"),
)


@pytest.mark.parametrize(
    "mistake",
    [*NAMES, *ARGUMENTS, *TYPES, *BODY, *TIMES, *VALUES],
    ids=lambda mistake: mistake.text.replace("\n", "⏎"),
)
def test_a_mistake_is_found_where_it_is(mistake: Mistake) -> None:
    reported = problems(mistake.text)
    assert tuple(place(problem) for problem in reported) == mistake.found
    assert mistake.words in reported[0].message
    assert mistake.help in (reported[0].help or "")


def test_every_mistake_of_evaluation_is_among_them() -> None:
    codes = {
        entry.partition(" ")[0]
        for mistake in (*NAMES, *ARGUMENTS, *TYPES, *BODY, *TIMES, *VALUES)
        for entry in mistake.found
    }
    elsewhere = {"step-limit", "template-hole", "ambiguous-rule", "no-utterance"}
    sources = "\n".join(
        path.read_text(encoding="utf-8")
        for package in (azee.lang, azee.score)
        for path in Path(package.__path__[0]).rglob("*.py")
    )
    assert sorted(code for code in codes if f'"{code}"' not in sources) == []
    for code in elsewhere:
        assert f'"{code}"' in sources


def test_a_hole_is_for_templates_only() -> None:
    loaded = program("")
    span = Span(Source("template", "blank ?x"), 6, 8)
    diagnostics: list[Diagnostic] = []
    hole = Application(span, OperatorName(span, "blank"), (Hole(span, "x"),), called=False)
    loaded.resolving.resolver(loaded.scope, None, diagnostics).resolve(hole)
    assert [place(d) for d in diagnostics] == ["template-hole 1:7"]


def test_one_utterance_does_not_hide_the_mistakes_of_another() -> None:
    text = "blank div(1, 0)\nkey 1 (place 3 ^Mssp)\n:arbr\nblank 1\nblank div(2, 0)\n"
    assert found(text) == [
        "division-by-zero 1:14",
        "wrong-type 2:14",
        "unknown-rule 3:1",
        "division-by-zero 5:14",
    ]


def test_independent_mistakes_of_one_utterance_are_all_reported() -> None:
    text = "let 'z 0 seq(list(blank(div(1, ^z)), blank(neg(1)), key(1, look(^upp))))\n"
    assert found(text) == ["unknown-name 1:65"]
    text = text.replace("^upp", "^up")
    assert found(text) == ["division-by-zero 1:32", "negative-duration 1:44"]


def test_rules_that_nobody_calls_are_checked() -> None:
    text = (
        "def f\n    azop 'x 'nodefault key(1, place(@I_TIP(^x), ^Msp))\n"
        "def g\n    :info-about 'topic :f 'info :nope\n"
        "def h\n    key(1, morph('smil, 1))\n"
    )
    assert found(text) == [
        "unknown-name 2:49",
        "missing-argument 4:24",
        "unknown-rule 4:33",
        "unknown-morph 6:18",
    ]


def test_a_mistake_in_a_rule_is_reported_once_however_often_it_is_called() -> None:
    text = "def f\n    azop 'x 0 blank(div(1, ^x))\n:f\n:f\n:f 'x 2\n"
    assert found(text) == ["division-by-zero 2:28"]


def test_the_rule_call_stack_is_shown_innermost_first() -> None:
    text = "def f\n    azop 'x 0 blank(div(1, ^x))\ndef g\n    :f 'x 0\n\n:g\n"
    (problem,) = problems(text)
    assert [(r.message, r.span.line, r.span.column) for r in problem.related] == [
        ("while evaluating `:f`, called", 4, 5),
        ("while evaluating `:g`, called", 6, 1),
    ]


def test_a_mistake_in_an_argument_is_not_inside_the_rule() -> None:
    (problem,) = problems("tree(vtranslate(^Mssp, scale(^up, div(1, 0))))")
    assert problem.related == ()


def test_a_long_call_stack_is_shortened() -> None:
    (problem,) = problems("def f\n    :f\n:f")
    assert len(problem.related) == 12
    assert "more calls in between are left out" in problem.notes[0]
    assert problem.related[-1].span.line == 3


def test_a_broken_definition_spoils_nothing_else() -> None:
    text = "def f\n    azop 'x ((\n:f 'x 1\n:f\n"
    assert {entry.partition(" ")[2].partition(":")[0] for entry in found(text)} == {"2"}


def test_the_other_dominant_hand_is_checked_when_it_is_asked_for() -> None:
    text = "key 1 (cstr (orient 'nrm !palm(s) 'along ^up) (orient 'nrm !palm(L) 'along ^up))"
    assert found(text) == []
    assert [place(p) for p in program(text).check(Side.LEFT)] == ["orient-conflict 1:48"]


@pytest.mark.parametrize(
    ("text", "utterance", "words"),
    [
        ("", None, "is empty"),
        ("# nothing\n", None, "is empty"),
        ("def f\n    :bien\n", None, "only definitions"),
        (":bien\n", 2, "no utterance 2"),
    ],
)
def test_a_score_needs_an_utterance(text: str, utterance: int | None, words: str) -> None:
    with pytest.raises(AZeeError) as caught:
        program(text).score(utterance)
    (problem,) = caught.value.diagnostics
    assert problem.code == "no-utterance"
    assert words in problem.message


DOUBLING = """
def f
    azop 'n 0
        if
            lt ^n 30
            seq(list(f(add(^n, 1)), f(add(^n, 1))))
            blank .1
:f
"""
TRIPLING = """
def f
    azop 'n 0 seq(list(g(^n), g(^n), g(^n)))
def g
    azop 'n 0 seq(list(h(^n), h(^n), h(^n)))
def h
    azop 'n 0 blank(^n)
:f
"""
HOSTILE = {
    "a rule that applies itself": "def f\n    :f\n:f",
    "two rules that apply each other": "def f\n    :g\ndef g\n    seq(list(:f))\n:f",
    "a rule that doubles itself": DOUBLING,
    "names that double a value": "let 'a (list 1 1)\n    "
    + "\n    ".join("    " * k + "let 'a (list ^a ^a)" for k in range(40))
    + "\n    "
    + "    " * 40
    + "^a",
    "a large range": "seq(map(.nb-5, range(1, 99999999)))",
    "a large range of ranges": "seq(map(azop('x, 0, range(1, 100000)), range(1, 100000)))",
    "a fold that grows": "seq(fold(azop('a, 0, 'b, 0, list(^a, ^a)), 1, range(1, 100)))",
    "a chain of vectors": "key(1, look(fold(azop('a, 0, 'b, 0, oppvect(^a)), ^up, range(1, 999))))",
    "a default that applies its rule": "def f\n    azop 'x f() ^x\n:f",
    "an operator applied to itself": "let 'f azop('g, 0, apply(^g, ^g)) apply(^f, ^f)",
    "deep text": "blank " + "add(1, " * 300 + "1" + ")" * 300,
}
ENDS = {"recursion-limit", "step-limit", "size-limit"}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_text_ends_in_its_diagnostic(name: str) -> None:
    reported = problems(HOSTILE[name])
    assert reported
    assert {p.code for p in reported} <= ENDS


DEEP = {
    "let('x, 1, ": ")",
    "if(lt(1, 2), ": ", blank(1))",
    "sync('A, ": ")",
    "apply(azop('x, 1, ": "))",
    "nth(list(": "), 1)",
    "mirror(": ")",
    "nth(map(azop('x, 1, ": "), list(1)), 1)",
    "info-about(blank(1), ": ")",
    "fixed(seq(list(": ")))",
}


@pytest.mark.parametrize("opening", DEEP)
@pytest.mark.parametrize("times", [40, 95, 150, 199, 400])
def test_deep_texts_are_evaluated_or_refused(opening: str, times: int) -> None:
    reported = found(opening * times + "blank(1)" + DEEP[opening] * times)
    codes = {entry.partition(" ")[0] for entry in reported}
    assert codes <= {"recursion-limit"}
    if times == 40:
        assert not codes


def test_a_deep_value_can_be_mirrored() -> None:
    opposite = "fold(azop('v, ^up, 'n, 0, oppvect(^v)), ^up, range(1, 195))"
    assert found(f"key(1, mirror(look({opposite})))") == []


def test_depth_is_that_of_nesting_not_of_length() -> None:
    assert found("seq map(azop('n, 0, blank(mul(^n, .01))), range(1, 500))") == []
    text = "let 'n 1 seq(list(" + ", ".join(["blank(add(^n, 1))"] * 500) + "))"
    assert found(text) == []


@pytest.mark.parametrize(
    "text",
    ["blank {}", "sync 'A (blank 0) 'B (blank 1) 'start/dur 'A:end {}"],
    ids=["alone", "block"],
)
def test_a_score_lasts_a_day_and_no_longer(text: str) -> None:
    assert found(text.format(86400)) == []
    (code,) = found(text.format("86400.1"))
    assert code.startswith("size-limit")


def test_steps_are_counted_and_limited() -> None:
    assert program(TRIPLING).check() == ()
    limited = program(TRIPLING, limits=Limits(steps=100))
    assert [p.code for p in limited.check()] == ["step-limit"]


def test_each_ref_of_a_sync_rule_that_names_no_block_is_reported() -> None:
    found = program("sync 'A (blank 1) 'B (blank 1) 'start/end 'X:start 'Y:end").check()
    assert [(d.code, d.message[-3:], str(d.span)) for d in found] == [
        ("unknown-block", "`X`", "text.azee:1:43"),
        ("unknown-block", "`Y`", "text.azee:1:52"),
    ]
    found = program(
        "sync 'A (blank 1) 'A (blank 2) 'start 'A:end 'A (blank 3) 'start 'A:end"
    ).check()
    assert [(d.code, str(d.span)) for d in found] == [
        ("duplicate-block", "text.azee:1:19"),
        ("duplicate-block", "text.azee:1:46"),
    ]


@pytest.mark.parametrize("path", ["'A:start", "'A/", "'/A"])
def test_what_a_block_is_within_is_a_block_and_no_moment(path: str) -> None:
    """Whatever is wrong with the path, a colon or a part without a name."""
    (problem,) = problems(f"sync 'A (key .5 (look ^up)) 'B (key .1 (look ^up)) 'with {path}")
    assert problem.code == "bad-ref"
    assert problem.message == "`'with` wants the name of a block alone"


def test_a_broken_block_brings_no_mistake_about_its_sync() -> None:
    text = "key (sync 'A :arbr 'B (key .1 (look ^up)) 'start 'A:end) (look ^up)"
    assert found(text) == ["unknown-rule 1:14"]


@pytest.mark.parametrize(
    ("bone", "taken"),
    [("!palm", "a side"), ("!head", "no side"), ("!index", "a side, then a phalanx")],
)
def test_too_many_operands_are_told_with_those_that_a_bone_takes(bone: str, taken: str) -> None:
    told = problems(f"key 1 (look dir({bone}(s, 1, 1)))")
    (problem,) = (p for p in told if p.code == "too-many-arguments")
    assert f"`{bone}` takes {taken}" in problem.message


def test_values_without_parts_are_one_deep_and_one_large() -> None:
    """So that the limits of depth and size count what people write."""
    kinds = [v for v in vars(values).values() if isinstance(getattr(v, "depth", None), int)]
    assert len(kinds) > 5
    assert {(kind.depth, kind.size) for kind in kinds} == {(1, 1)}
