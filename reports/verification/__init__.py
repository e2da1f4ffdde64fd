"""The report of a run: Markdown, figures, HTML, PDF and the pages of codes. A ``Run`` comes in; text and files go out."""
