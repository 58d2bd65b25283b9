"""Benchmarks: how long things take, how often problems are solved, how other methods do."""
