"""Coverage-guided search for texts that break what must hold of any bytes: `make fuzz`.

atheris mutates what has reached new branches of the grammar and the language; it starts from the
rules that ship, the examples and the regressions. One text is kept of every distinct place that
raised, and the search goes on. What is found stays in out/fuzz/found, what reached something new
in out/fuzz/corpus, from where the next search goes on. Exit code 1 means that something was found.
"""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
import time
import traceback
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
WORKPLACE = ROOT / "out" / "fuzz"
FOUND, CORPUS = WORKPLACE / "found", WORKPLACE / "corpus"
SEEDS = ("grammar/azee_grammar/rules", "examples", "tests/fuzz/regressions", "tests/grammar/cases")
LONGEST_BYTES = 2048
SLOW_S = 2.0


def main(seconds: int) -> int:
    """Search for so long; returns 1 where something was found."""
    for folder in (FOUND, CORPUS):
        folder.mkdir(parents=True, exist_ok=True)
    for seed in seeds():
        name = hashlib.sha1(seed, usedforsecurity=False).hexdigest()
        (CORPUS / name).write_bytes(seed)
    words = sorted({word for seed in seeds() for word in re.findall(rb"[!-~]{2,24}", seed)})
    escaped = ("".join(f"\\x{byte:02x}" for byte in word) for word in words)
    dictionary = WORKPLACE / "words.dict"
    dictionary.write_text("".join(f'"{word}"\n' for word in escaped), encoding="ascii")
    options = [
        f"-max_total_time={seconds}",
        f"-max_len={LONGEST_BYTES}",
        f"-dict={dictionary}",
        f"-artifact_prefix={FOUND}/",
        "-rss_limit_mb=2048",
        "-timeout=60",
        "-print_final_stats=1",
        "-verbosity=1",
    ]
    before = set(FOUND.iterdir())
    code = subprocess.run([sys.executable, __file__, "--child", *options, CORPUS]).returncode
    found = sorted(set(FOUND.iterdir()) - before)
    for path in found:
        print(f"found {path.relative_to(ROOT)}")
    print(f"{len(found)} new findings in {seconds} s; libFuzzer left with {code}")
    return 1 if found or code else 0


def seeds() -> Iterator[bytes]:
    """Texts to start from, cut where they are longer than what is tried."""
    for folder in SEEDS:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".azee", ".txt"):
                data = path.read_bytes()
                for start in range(0, len(data), LONGEST_BYTES):
                    yield data[start : start + LONGEST_BYTES]


def search(arguments: list[str]) -> None:
    """Hand `examine` to atheris, with the branches of our packages counted."""
    atheris: Any = import_module("atheris")
    with atheris.instrument_imports(include=["azee", "azee_grammar"]):
        examine = import_module("any_bytes").examine

    def attempt(data: bytes) -> None:
        start = time.process_time()
        try:
            examine(data)
        except Exception as problem:
            keep(data, place(problem), traceback.format_exc())
        if (spent := time.process_time() - start) > SLOW_S:
            keep(data, f"slow-{spent:.0f}s", f"{spent:.2f} s of processor time")

    atheris.Setup([sys.argv[0], *arguments], attempt)
    atheris.Fuzz()


def place(problem: Exception) -> str:
    """Name the line that raised, by which findings are told apart."""
    frames = traceback.extract_tb(problem.__traceback__)
    names = [f"{Path(frame.filename).stem}-{frame.lineno}" for frame in frames]
    where = names[-1] if not isinstance(problem, RecursionError) else "somewhere"
    message = re.sub(r"\W.*", "", str(problem), flags=re.DOTALL)[:20]
    return f"{type(problem).__name__}-{where}-{message}"


def keep(data: bytes, name: str, reason: str) -> None:
    """Keep the shortest text of each name, with why it was kept."""
    text = FOUND / f"{name}.azee"
    if not text.exists() or text.stat().st_size > len(data):
        text.write_bytes(data)
        (FOUND / f"{name}.txt").write_text(reason, encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        search(sys.argv[2:])
    else:
        sys.exit(main(int(sys.argv[1])))
