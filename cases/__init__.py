"""Tasks: blades and turbines are read, solved by codes, compared and judged."""
