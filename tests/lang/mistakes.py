"""Texts with a mistake of evaluation each: its code, its place, and what is said about it."""

from __future__ import annotations

from dataclasses import dataclass


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

MISTAKES = (*NAMES, *ARGUMENTS, *TYPES, *BODY, *TIMES, *VALUES)
