"""The rows of a study as a Parquet file, written from its JSON Lines in row groups of bounded size."""

from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO

import msgspec

from ..input import atomic
from ..input.errors import CaseError
from .journal import read
from .plan import Header
from .rows import Row

SUFFIX = ".parquet"

ROWS = 65_536
"""Largest number of rows of a row group; as many are in memory."""

TYPES = {
    "omega_rad_s": "float64",
    "mode": "int16",
    "name": "string",
    "frequency_rad_s": "float64",
    "frequency_hz": "float64",
    "relative_uncertainty": "float64",
    "steady_strain": "float64",
    "reason": "string",
}


def library(path: Path) -> Any:
    """PyArrow.

    Raises:
        CaseError: if it is not installed.
    """
    try:
        import_module("pyarrow.parquet")
        return import_module("pyarrow")
    except ImportError as error:
        raise CaseError(
            f"--out {path}: pyarrow is not installed: pip install 'southwell[cluster]', or give a .jsonl file"
        ) from error


def write(path: Path, source: Path, header: Header) -> None:
    """Write the rows in ``source`` to ``path``: one column per field and per sampled property; the header as metadata.

    Raises:
        CaseError: if PyArrow is not installed.
        OSError: if a file cannot be read or written; an existing ``path`` is then unchanged.
    """
    arrow = library(path)
    properties = dict.fromkeys(header.properties, "float64")
    types = {"blade": "string", "sample": "int64", **properties, **TYPES}
    fields = [arrow.field(name, arrow.type_for_alias(kind)) for name, kind in types.items()]
    schema = arrow.schema(fields, {"southwell.study": msgspec.json.encode(header)})

    def save(file: BinaryIO) -> None:
        rows = read(source)
        with arrow.parquet.ParquetWriter(file, schema) as writer:
            while group := list(islice(rows, ROWS)):
                writer.write_table(arrow.Table.from_pylist([_flat(row) for row in group], schema))

    atomic.through(path, save)


def _flat(row: Row) -> dict[str, Any]:
    return {**row.properties, **{name: getattr(row, name) for name in ("blade", "sample", *TYPES)}}
