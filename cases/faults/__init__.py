"""Seeded faults: the matrix runs with one faulty component, and named cells must fail or be inconclusive."""
