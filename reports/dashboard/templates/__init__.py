"""Pages, style and scripts of the dashboard."""
