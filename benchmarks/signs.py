"""How long a sign takes from score to clip in a running process: `benchmarks/run.py signs`.

The five examples and sequences of signs are performed at 30 frames/s on one core, without report
and files, a few times in turn; the least time of each counts, for other programs only ever add to
it. `--against DIR` measures another checkout of azee in the same run, in turns with this one, and
prints how many times longer it takes.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from itertools import cycle, islice
from pathlib import Path

from azee.compilation import score_of
from azee.lang.program import load
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.signs import signs
from azee.score.score import Score
from azee_grammar.files import read_source
from azee_grammar.source import Source

ROOT = Path(__file__).parents[1]
EXAMPLES = ("cinema-good", "iraq-there", "not-but", "person-aged-52", "tree")
WORDS = ("arbre", "bien", "pays", "chat", "cinéma", "personne", "Irak", "âge")
CHILD = """
import json, sys, time
from azee.compilation import perform, score_of
from azee.lang.program import load
from azee_grammar.source import Source
from azee_rig.load import load_rig
rig, out = load_rig(), []
texts = json.load(sys.stdin)
perform(score_of(load(Source("first", texts[0])), None, None), rig, fps=30)
for text in texts:
    score = score_of(load(Source("text", text)), None, None)
    began = time.process_time()
    perform(score, rig, fps=30)
    out.append(time.process_time() - began)
print(json.dumps(out))
"""


def sequence(count: int) -> str:
    """Return a text of so many signs."""
    return "seq\n    list\n" + "".join(f"        :{n}\n" for n in islice(cycle(WORDS), count))


def count_signs(text: str) -> int:
    """Return how many signs a text has."""
    score: Score = score_of(load(Source("text", text)), None, None)
    return max(1, len(signs(score, (r.path for r in flatten(score).requirements))))


def times_s(tree: Path, texts: Sequence[str]) -> list[float]:
    """Perform texts in a process of a checkout; return the processor time of each."""
    packages = (tree, *(tree / name for name in ("rig", "solver", "grammar")))
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(map(str, packages)),
        "OPENBLAS_NUM_THREADS": "1",
    }
    done = subprocess.run(
        [sys.executable, "-c", CHILD],
        input=json.dumps(texts),
        env=environment,
        cwd=tree,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        sys.exit(done.stderr)
    found: list[float] = json.loads(done.stdout)
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="run.py signs", description=__doc__)
    parser.add_argument("--signs", type=int, nargs="*", default=[100], help="sequences, as long")
    parser.add_argument("--against", type=Path, metavar="DIR", help="another checkout of azee")
    parser.add_argument("--turns", type=int, default=3, metavar="N", help="how often each runs")
    options = parser.parse_args(arguments)
    texts = {name: read_source(ROOT / "examples" / name / f"{name}.azee").text for name in EXAMPLES}
    texts |= {f"{n} signs": sequence(n) for n in options.signs}
    trees = [ROOT, *([options.against.resolve()] if options.against else [])]
    least = [[float("inf")] * len(texts) for _ in trees]
    for _ in range(options.turns):
        for row, tree in zip(least, trees, strict=True):
            now = times_s(tree, [*texts.values()])
            row[:] = map(min, row, now)
    print("text              signs   ms a sign" + ("   other   times" if options.against else ""))
    for i, (name, text) in enumerate(texts.items()):
        count = count_signs(text)
        line = f"{name:16s} {count:6d} {1e3 * least[0][i] / count:11.1f}"
        if options.against:
            line += f" {1e3 * least[1][i] / count:7.1f} {least[1][i] / least[0][i]:7.1f}"
        print(line)


if __name__ == "__main__":
    main()
