"""A condensed model as figures and Markdown."""
