"""Condensation tasks: the files of ``southwell condense`` and the worked example."""
