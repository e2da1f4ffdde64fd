"""Seeded faults: one faulty component run through the real matrix; a named cell must fail or be inconclusive."""
