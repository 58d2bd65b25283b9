"""Coverage-guided search for files that break what must hold of any bytes.

`make fuzz` looks for texts in AZee, `make fuzz-bvh` for recorded motion. atheris mutates what has
reached new branches of our code; it starts from the rules that ship, the examples and the
regressions. One file is kept of every distinct place that raised, and the search goes on. What is
found stays in out/fuzz/…/found, what reached something new in out/fuzz/…/corpus, from where the
next search goes on. Exit code 1 means that something was found.
"""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
SLOW_S = 2.0


@dataclass(frozen=True)
class Subject:
    """What files are searched for: who examines them, where to start, how long they may be."""

    name: str
    examiner: str
    packages: tuple[str, ...]
    folders: tuple[str, ...]
    suffixes: tuple[str, ...]
    longest_bytes: int

    @property
    def found(self) -> Path:
        """Folder of what broke something."""
        return ROOT / "out" / "fuzz" / self.name / "found"

    @property
    def corpus(self) -> Path:
        """Folder of what reached something new."""
        return ROOT / "out" / "fuzz" / self.name / "corpus"

    def seeds(self) -> Iterator[bytes]:
        """Files to start from, cut where they are longer than what is tried."""
        for folder in self.folders:
            for path in sorted((ROOT / folder).rglob("*")):
                if path.suffix in self.suffixes:
                    data = path.read_bytes()
                    for start in range(0, len(data), self.longest_bytes):
                        yield data[start : start + self.longest_bytes]


TEXTS = Subject(
    "azee",
    "any_bytes",
    ("azee", "azee_grammar"),
    ("grammar/azee_grammar/rules", "examples", "tests/fuzz/regressions", "tests/grammar/cases"),
    (".azee", ".txt"),
    2048,
)
BVH = Subject(
    "bvh", "any_bvh", ("azee", "azee_rig.importing"), ("tests/fuzz/bvh",), (".bvh",), 5000
)
SUBJECTS = {subject.name: subject for subject in (TEXTS, BVH)}


def main(subject: Subject, seconds: int) -> int:
    """Search for so long; returns 1 where something was found."""
    for folder in (subject.found, subject.corpus):
        folder.mkdir(parents=True, exist_ok=True)
    for seed in subject.seeds():
        name = hashlib.sha1(seed, usedforsecurity=False).hexdigest()
        (subject.corpus / name).write_bytes(seed)
    words = sorted({word for seed in subject.seeds() for word in re.findall(rb"[!-~]{2,24}", seed)})
    escaped = ("".join(f"\\x{byte:02x}" for byte in word) for word in words)
    dictionary = subject.corpus.parent / "words.dict"
    dictionary.write_text("".join(f'"{word}"\n' for word in escaped), encoding="ascii")
    options = [
        f"-max_total_time={seconds}",
        f"-max_len={subject.longest_bytes}",
        f"-dict={dictionary}",
        f"-artifact_prefix={subject.found}/",
        "-rss_limit_mb=2048",
        "-timeout=60",
        "-report_slow_units=3600",  # by the clock; `attempt` goes by processor time
        "-print_final_stats=1",
        "-verbosity=1",
    ]
    before = set(subject.found.iterdir())
    command = [sys.executable, __file__, "--child", subject.name, *options, str(subject.corpus)]
    code = subprocess.run(command).returncode
    found = sorted(set(subject.found.iterdir()) - before)
    for path in found:
        print(f"found {path.relative_to(ROOT)}")
    print(f"{len(found)} new findings in {seconds} s; libFuzzer left with {code}")
    return 1 if found or code else 0


def search(subject: Subject, arguments: list[str]) -> None:
    """Hand files to atheris and to their examiner, with the branches of our packages counted."""
    atheris: Any = import_module("atheris")
    with atheris.instrument_imports(include=list(subject.packages)):
        examine = import_module(subject.examiner).examine

    def attempt(data: bytes) -> None:
        start = time.process_time()
        try:
            examine(data)
        except Exception as problem:
            keep(subject, data, place(problem), traceback.format_exc())
        if (spent := time.process_time() - start) > SLOW_S:
            keep(subject, data, f"slow-{spent:.0f}s", f"{spent:.2f} s of processor time")

    atheris.Setup([sys.argv[0], *arguments], attempt)
    atheris.Fuzz()


def place(problem: Exception) -> str:
    """Name the line that raised, by which findings are told apart."""
    frames = traceback.extract_tb(problem.__traceback__)
    names = [f"{Path(frame.filename).stem}-{frame.lineno}" for frame in frames]
    where = names[-1] if not isinstance(problem, RecursionError) else "somewhere"
    message = re.sub(r"\W.*", "", str(problem), flags=re.DOTALL)[:20]
    return f"{type(problem).__name__}-{where}-{message}"


def keep(subject: Subject, data: bytes, name: str, reason: str) -> None:
    """Keep the shortest file of each name, with why it was kept."""
    kept = subject.found / f"{name}{subject.suffixes[0]}"
    if not kept.exists() or kept.stat().st_size > len(data):
        kept.write_bytes(data)
        (subject.found / f"{name}.reason").write_text(reason, encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        search(SUBJECTS[sys.argv[2]], sys.argv[3:])
    else:
        sys.exit(main(SUBJECTS[sys.argv[1]], int(sys.argv[2])))
