"""Seeded faults: a component made wrong on purpose, run through the real matrix; a named cell must fail or be inconclusive."""
