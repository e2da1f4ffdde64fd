"""Executors of tasks: processes of this machine or workers of a Dask cluster."""
