"""Presents the results of ``cases``: Markdown, figures, command line; imports cases, core."""
