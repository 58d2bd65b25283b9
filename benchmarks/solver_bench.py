"""How fast moments are solved, and how surely: `python benchmarks/solver_bench.py`.

The sign tree at one place and at 36, touches of the face, and a target out of reach, on the
signer that ships; then what a process pays before it can solve. Evaluations do not depend on the
machine, times do: run it on one that does nothing else.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import BoneAxis, Constraint, Orient, Place, Relation
from azee_solver.demand import Demand
from azee_solver.geometry import Bone, Dir, FreePoint, Side, Site, SitePoint, Vec, Vector
from azee_solver.options import SolveOptions
from azee_solver.report import SolveReport
from azee_solver.solve import solve

S, W = Side.STRONG, Side.WEAK
UP = Vec(0.0, 1.0, 0.0)
RUNS = 9


def along(axis: BoneAxis, bone: Bone, vector: Vector) -> Orient:
    return Orient(axis, bone, Relation.ALONG, vector)


def tree(place: FreePoint) -> list[Constraint]:
    """The paper's eleven problems, without the thumb that its joints cannot follow."""
    palm = Bone("palm", S)
    fingers: list[Constraint] = []
    for name in ("index", "middle", "ring", "little"):
        first, second = Bone(name, S, 1), Bone(name, S, 2)
        fingers += [
            along(BoneAxis.DIR, first, Dir(palm)),
            along(BoneAxis.DIR, second, Dir(first)),
        ]
    return [
        Place(Site("H_BACK", W), place),
        along(BoneAxis.NRM, Bone("palm", W), UP),
        along(BoneAxis.DIR, Bone("palm", W), Dir(Bone("f_arm", W))),
        Place(Site("EL", S), SitePoint(Site("PA", W)), contact=True),
        along(BoneAxis.DIR, Bone("f_arm", S), UP),
        along(BoneAxis.DIR, palm, UP),
        *fingers,
    ]


def run(rig: Rig, constraints: Sequence[Constraint], options: SolveOptions) -> SolveReport:
    demands = [Demand(c, rank=i) for i, c in enumerate(constraints)]
    idle = rig.coordinates.idle
    return solve(rig, demands, dominant=Side.RIGHT, start=idle, reference=idle, options=options)


def show(what: str, reports: Sequence[SolveReport]) -> None:
    met = sum(report.met for report in reports)
    clear = sum(
        report.met and all(o.depth_m <= 3e-3 for o in report.penetration) for report in reports
    )
    times = sorted(1000 * report.solve_s for report in reports)
    evaluations = [report.evaluations for report in reports]
    print(
        f"{what:<38}{len(reports):>4}{met:>6}{clear:>7}{statistics.median(times):>10.1f}"
        f"{times[-1]:>9.1f}{statistics.median(evaluations):>10.0f}{max(evaluations):>9}"
    )


def touch(site: Site) -> list[Constraint]:
    return [Place(Site("I_TIP", S), SitePoint(site), contact=True)]


def before_solving() -> None:
    """What a process pays: compiling once on a machine, loading the compiled each time."""
    code = (
        "import time, numba, nlopt, numpy; t = time.perf_counter(); "
        "import azee_solver.kernels; print(time.perf_counter() - t)"
    )
    with tempfile.TemporaryDirectory() as cache:
        for what in ("compiling the kernels, once", "loading the compiled kernels"):
            done = subprocess.run(
                [sys.executable, "-c", code],
                env={"NUMBA_CACHE_DIR": cache, "PYTHONPATH": ":".join(p for p in sys.path if p)},
                capture_output=True,
                text=True,
                check=True,
            )
            print(f"{what:<38}{float(done.stdout):>10.2f} s")
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", "import numba, nlopt, numpy"], check=True)
    print(f"{'starting Python with numba':<38}{time.perf_counter() - began:>10.2f} s")


def main() -> None:
    rig = load_rig()
    options = SolveOptions()
    beside = FreePoint(-0.14, -0.24, 0.25)
    run(rig, tree(beside), options)
    print(f"{'':<38}{'':>4}{'met':>6}{'clear':>7}{'ms':>10}{'worst':>9}{'evals':>10}{'worst':>9}")
    show("tree", [run(rig, tree(beside), options) for _ in range(RUNS)])
    apart = replace(options, overlap=0.0, overlap_m=1.0)
    show("tree, capsules off", [run(rig, tree(beside), apart) for _ in range(RUNS)])
    grid = product((0.0, -0.08, -0.14, -0.2), (-0.2, -0.24, -0.28), (0.2, 0.24, 0.28))
    show("tree at 36 places", [run(rig, tree(FreePoint(*p)), options) for p in grid])
    face = [Site("CH"), Site("FH"), Site("NO"), Site("CK", S), Site("CK", W), Site("EAR", S)]
    show("fingertip on the face", [run(rig, touch(site), options) for site in face])
    far = [Place(Site("I_TIP", S), FreePoint(-0.5, 0.3, 1.2))]
    show("out of reach, with the reason", [run(rig, far, options) for _ in range(3)])
    before_solving()


if __name__ == "__main__":
    main()
