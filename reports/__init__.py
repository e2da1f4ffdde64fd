"""Shows what the cases found: Markdown, figures, command line; imports cases, core."""
