"""cases.faults."""
