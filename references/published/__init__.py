"""Printed tables as data, one file a source."""
