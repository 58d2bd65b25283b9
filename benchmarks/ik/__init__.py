"""Comparison of inverse kinematics: bodies, problems, methods of `benchmarks/solver_bench.py`."""
