"""The schema of windIO 2, which comes with its package: what a file violates in the fields that are read.

The package imports netCDF4 and xarray; its schema alone is read here. ``pip install '.[windio]'`` installs it and jsonschema.
"""

from collections.abc import Mapping
from importlib import import_module, metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Any

READ = (
    ("components", "blade", "reference_axis"),
    ("components", "blade", "outer_shape", "twist"),
    ("components", "blade", "structure", "elastic_properties"),
    ("components", "hub", "diameter"),
    ("components", "hub", "cone_angle"),
)
"""Fields that are read."""


def violations(turbine: Mapping[str, Any]) -> tuple[str, ...]:
    """What a turbine violates, one line for each field; empty if nothing, or if the package is not installed."""
    package = find_spec("windIO")
    if package is None or package.origin is None:
        return ()
    validator, yaml = import_module("jsonschema").Draft202012Validator, import_module("ruamel.yaml").YAML
    schema = Path(package.origin).parent / "schemas" / "turbine" / "turbine_schema.yaml"
    parts = {name: part for name, part in turbine["components"].items() if name in ("blade", "hub")}
    errors = validator(yaml(typ="safe", pure=True).load(schema)).iter_errors({"components": parts})
    version = metadata.version("windIO")
    out: dict[str, str] = {}
    for error in errors:
        path = tuple(error.absolute_path)
        if any(path[: len(field)] == field for field in READ):
            name = ".".join(str(part) for part in path if isinstance(part, str))
            out.setdefault(name, f"{name}: {error.message[:100]}, by the schema of windIO {version}")
    return tuple(out.values())
