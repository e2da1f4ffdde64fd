"""Stored answers: in the user's cache for later runs, and in the output folder until the run is finished.

Both are files of ``references.protocol.store``. ``digest`` makes the key of a task, ``codec`` converts its answer to bytes,
``stored`` is the executor that looks answers up, and ``unfinished`` is the file from which a stopped run continues.
"""
