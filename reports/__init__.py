"""Presentation of results: command line, notebooks, reports, figures, dashboard and the documentation site."""
