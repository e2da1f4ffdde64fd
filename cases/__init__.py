"""Which blade, which codes, which target; runs, compares, judges; imports references, core."""
