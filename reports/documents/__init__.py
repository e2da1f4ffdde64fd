"""A report in Markdown as a web page and as a PDF."""
