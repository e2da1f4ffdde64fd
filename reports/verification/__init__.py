"""The report of a run: Markdown, figures, HTML, PDF and one page per code. Takes a ``Run``; returns text and files."""
