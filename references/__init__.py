"""Reference solutions: foreign codes, closed forms and published tables."""
