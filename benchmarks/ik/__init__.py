"""Inverse kinematics compared: bodies, problems and methods of `benchmarks/solver_bench.py`."""
