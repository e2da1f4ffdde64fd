"""The report of a run: Markdown, figures, HTML, PDF and one page per code."""
