"""Changes the code here and there and tells which changes no test sees: `make mutants`.

    python tests/mutants/mutation_test.py --count 150 azee.quality azee/clip/blend.py

Without modules it takes those that differ from a commit (`--since`). It works in copies of the
tree, one per worker. Results are kept in a file: a run that was interrupted goes on where it
stopped, and what was tried is tried again only if the module or its tests have changed.

Before, the tests of a module run once without a change, and it is noted which of their files run
which of its lines. For a change only those run that run its statement, or that start processes;
all of them if none does, as of loops that numba compiles.

A change of which a test only tells that it takes too long counts as seen.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from queue import SimpleQueue

from line_trace import ANSWER, TRACED
from related_tests import PACKAGES, Tree, chosen_modules
from single_changes import Change, changes, lines_of_statement

ROOT = Path(__file__).resolve().parents[2]
LEAST_S, TIMES_LONGER = 30.0, 5.0
"""Time limit of a change: so many times longer than its tests take without it, but not less."""
PASSED, FAILED, INTERRUPTED, NO_TESTS = 0, 1, 2, 5
"""Pytest's exit codes. Errors of import count as interrupted."""


class MutationError(Exception):
    """The tester cannot tell anything: modules or their tests are not as they must be."""


@dataclass(frozen=True)
class Mutant:
    """A change to one module, with the tests that should see it."""

    module: str
    path: Path
    source: str
    change: Change
    tests: tuple[Path, ...]
    digest: str

    @property
    def key(self) -> str:
        """A name under which its result is kept; it changes with the module and its tests."""
        c = self.change
        text = f"{self.module} {c.start} {c.stop} {c.text} {self.digest}"
        return hashlib.sha256(text.encode()).hexdigest()[:20]


@dataclass(frozen=True)
class Baseline:
    """Tests of a module without a change: seconds, and lines of it by file, none where unknown."""

    seconds: float
    lines: Mapping[str, frozenset[int] | None]

    def concerned(self, tests: Sequence[str], lines: range) -> list[str]:
        """Return the files that may see a change of some lines, in their order."""
        ran = {test: self.lines.get(test) for test in tests}
        if not any(found and not found.isdisjoint(lines) for found in ran.values()):
            return [*tests]
        return [t for t, found in ran.items() if found is None or not found.isdisjoint(lines)]


@dataclass
class Workplace:
    """A copy of the tree, in which one worker changes modules and runs tests."""

    root: Path
    origin: Path
    marks: str
    baselines: dict[str, Baseline] = field(default_factory=dict)

    @classmethod
    def prepared(cls, origin: Path, root: Path, marks: str) -> Workplace:
        """Copy all files that git knows or would add, and the machine code made of them."""
        made = [path.relative_to(origin) for path in origin.rglob("__pycache__/azee_*.o")]
        for name in [*map(Path, _tracked(origin)), *made]:
            source = origin / name
            if source.is_file():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, root / name)
        return cls(root, origin, marks)

    def tried(self, mutant: Mutant) -> str:
        """Return what the tests say of a change: `seen`, `too long` or `unseen`.

        Raises: MutationError: they fail, or there are none, without any change.
        """
        baseline = self.baseline(mutant)
        limit = max(LEAST_S, TIMES_LONGER * baseline.seconds)
        lines = lines_of_statement(mutant.source, mutant.change)
        tests = baseline.concerned(self._names(mutant), lines)
        target = self.root / mutant.path.relative_to(self.origin)
        try:
            _replace(target, mutant.change.applied(mutant.source))
            code = self._run(tests, limit)
        finally:
            _replace(target, mutant.source)
        if code is None:
            return "too long"
        return "unseen" if code == PASSED else "seen"

    def _names(self, mutant: Mutant) -> list[str]:
        return [test.relative_to(self.origin).as_posix() for test in mutant.tests]

    def baseline(self, mutant: Mutant) -> Baseline:
        """What the tests of a module take and run without a change."""
        if mutant.module not in self.baselines:
            names, began = self._names(mutant), time.monotonic()
            answer = self.root / "lines.json"
            path = self.root / mutant.path.relative_to(self.origin)
            code = self._run(names, None, {TRACED: str(path), ANSWER: str(answer)})
            if code == NO_TESTS or not names:
                raise MutationError(f"no test belongs to {mutant.module}")
            if code != PASSED:
                raise MutationError(f"tests fail without any change: {' '.join(names)}")
            lines = json.loads(answer.read_text(encoding="utf-8"))
            self.baselines[mutant.module] = Baseline(
                time.monotonic() - began,
                {name: None if ran is None else frozenset(ran) for name, ran in lines.items()},
            )
        return self.baselines[mutant.module]

    def _run(
        self, tests: Sequence[str], limit_s: float | None, traced: Mapping[str, str] | None = None
    ) -> int | None:
        """Return pytest's exit code, None if it took too long."""
        if not tests:
            return NO_TESTS
        folders = [self.root, *(self.root / Path(f).parent for f in PACKAGES.values())]
        searched = dict.fromkeys(str(folder) for folder in [*folders, Path(__file__).parent])
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(searched),
            "PYTHONDONTWRITEBYTECODE": "1",  # a change of the same second and size would be missed
            **(traced or {}),
        }
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider"]
        command += ["--no-header", "--tb=no", *(["-m", self.marks] if self.marks else [])]
        command += [*(["-p", "line_trace"] if traced else []), *tests]
        process = subprocess.Popen(
            command,
            cwd=self.root,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=os.name != "nt",
        )
        try:
            return process.wait(limit_s)
        except subprocess.TimeoutExpired:
            return None
        finally:
            _end(process)


def sample(tree: Tree, modules: Iterable[str], count: int, seed: int) -> list[Mutant]:
    """Return changes at random places of modules; the same seed gives the same ones."""
    found = []
    for module in modules:
        path = tree.modules[module]
        source = path.read_text(encoding="utf-8")
        tests = tuple(tree.related(module))
        digest = hashlib.sha256(source.encode())
        for test in tests:
            digest.update(test.read_bytes())
        found += [
            Mutant(module, path, source, change, tests, digest.hexdigest())
            for change in changes(source)
        ]
    chosen = random.Random(seed).sample(found, min(count, len(found)))
    return sorted(chosen, key=lambda mutant: (mutant.module, mutant.change))


def results(
    mutants: Sequence[Mutant], known: Mapping[str, str], workplaces: Sequence[Workplace]
) -> Iterator[tuple[Mutant, str]]:
    """Yield each change with what the tests say, first those that are known from before."""
    yield from ((m, known[m.key]) for m in mutants if m.key in known)
    idle: SimpleQueue[Workplace] = SimpleQueue()
    for workplace in workplaces:
        idle.put(workplace)

    def one(mutant: Mutant) -> str:
        workplace = idle.get()
        try:
            return workplace.tried(mutant)
        finally:
            idle.put(workplace)

    with ThreadPoolExecutor(len(workplaces)) as pool:
        running = {pool.submit(one, m): m for m in mutants if m.key not in known}
        try:
            for future in as_completed(running):
                yield running[future], future.result()
        finally:
            pool.shutdown(cancel_futures=True)


def changed_since(root: Path, commit: str) -> list[str]:
    """Return paths of modules that differ from a commit, or that git does not know yet."""
    listed = _git(root, "diff", "--name-only", "--diff-filter=d", commit, "--", *PACKAGES.values())
    fresh = _git(root, "ls-files", "-o", "--exclude-standard", "--", *PACKAGES.values())
    return [name for name in [*listed, *fresh] if name.endswith(".py")]


def main(arguments: Sequence[str] | None = None, root: Path = ROOT) -> int:
    """Try changes and print those that no test sees; 0 if all is well, 2 if it cannot tell."""
    options = _options().parse_args(arguments)
    tree = Tree(root)
    try:
        modules = chosen_modules(tree, options.modules or changed_since(root, options.since))
        mutants = sample(tree, modules, options.count, options.seed)
        if not mutants:
            print("no module has changed: name some, as in MODULES=azee.quality", file=sys.stderr)
            return 0
        return _report(mutants, options, root)
    except (MutationError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def _report(mutants: Sequence[Mutant], options: argparse.Namespace, root: Path) -> int:
    kept = Path(options.results)
    kept.parent.mkdir(parents=True, exist_ok=True)
    known = _known(kept)
    total, seen = Counter(m.module for m in mutants), Counter[str]()
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        places = [Path(folder, str(n)) for n in range(options.workers)]
        workplaces = [Workplace.prepared(root, place, options.marks) for place in places]
        for number, (mutant, verdict) in enumerate(results(mutants, known, workplaces), 1):
            if mutant.key not in known:
                row = {"key": mutant.key, "verdict": verdict, "module": mutant.module}
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
            seen[mutant.module] += verdict != "unseen"
            name = str(mutant.path.relative_to(root))
            place = f"{name}:{mutant.change.line}"
            print(f"{number}/{len(mutants)} {verdict}: {place}, {mutant.change.kind}", flush=True)
            if verdict == "unseen":
                print(mutant.change.diff(mutant.source, name), flush=True)
    for module, count in total.items():
        print(f"{seen[module]:4} of {count:4} seen  {module}")
    print(f"{seen.total()} of {total.total()} changes seen, {seen.total() / total.total():.0%}")
    return 0


def _options() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("modules", nargs="*", help="dotted names, paths or folders")
    parser.add_argument("--since", default="HEAD~1", help="commit that modules differ from")
    parser.add_argument("--count", type=int, default=50, help="how many changes to try")
    parser.add_argument("--seed", type=int, default=0, help="of the sample")
    parser.add_argument("-n", "--workers", type=int, default=1)
    parser.add_argument("--marks", default="not slow and not node and not browser")
    parser.add_argument("--results", default="out/mutants.jsonl", help="file that results go to")
    return parser


def _known(kept: Path) -> dict[str, str]:
    if not kept.exists():
        return {}
    rows = map(json.loads, kept.read_text(encoding="utf-8").splitlines())
    return {row["key"]: row["verdict"] for row in rows}


def _replace(target: Path, text: str) -> None:
    """Write a module and forget its bytecode, which is told by size and second alone."""
    target.write_text(text, encoding="utf-8", newline="")
    for compiled in (target.parent / "__pycache__").glob(f"{target.stem}.*.pyc"):
        compiled.unlink()


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a run of tests with all that it has started."""
    if process.poll() is None:
        if os.name == "nt":
            process.kill()
        else:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _tracked(root: Path) -> list[str]:
    return _git(root, "ls-files", "-c", "-o", "--exclude-standard")


def _git(root: Path, *arguments: str) -> list[str]:
    done = subprocess.run(
        ["git", "-c", "core.quotepath=off", *arguments], cwd=root, capture_output=True, text=True
    )
    if done.returncode:
        raise MutationError(f"git says: {done.stderr.strip()}")
    return done.stdout.splitlines()


if __name__ == "__main__":
    sys.exit(main())
