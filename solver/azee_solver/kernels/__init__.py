"""The objective of one inverse-kinematics problem, its gradient and Gauss-Newton steps, compiled.

    f(x) = σ Σ_k w_k e_k² + w_o Σ overlap² + Σ_v λ_v (q_v − ref_v)² + Σ_v κ_v beyond_v²

σ is 1, but less in the first stage of a soft descent. e_k is a residual, w_k its weight,
1 / tolerance². w_o is the weight of overlaps. λ_v is the posture cost of a coordinate, κ_v its
joint-limit cost, and beyond_v = max(0, |u_v| − 0.8), where u_v is the place of q_v in its range, −1
to 1. Where a coordinate follows another, as a finger's last joint follows the one before, ref_v is
2/3 of the other's angle.

A residual e_k compares two entries a and b of a tape: a − b for places and parallels, |a − b| − d
for places at a distance, a · b for perpendiculars. The last two may have a dead zone: of what is
inside ± slack nothing is left. The gradient costs one reverse sweep: every pull
on a point or direction becomes a force F and a moment M about the world's origin on its node, both
are added up towards the root, and a coordinate that turns about axis u through o has the
derivative u · (M − o × F).

`evaluate` is what NLopt calls, through its C interface or through Python: the same machine code.
All that a problem is lies in one block of words; see `azee_solver.block`. Fast-math is off: the
same bytes on every run. Nothing here allocates, raises or calls into Python, so that
`azee_rig.machine_code` can keep and load what numba has compiled. Only that imports these modules.

numba optimises each function, and again whatever it is linked into: few levels and few variants
keep compiling short. `part` has its two types given, for it would be compiled anew for every
section; what is called from one place only is better left apart, unless it is the outermost.
"""
