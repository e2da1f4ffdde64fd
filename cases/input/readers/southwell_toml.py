"""Southwell's blade files: TOML with ``name`` and a table ``blade`` of any kind of a case file; CSV of stations.

Axes are those of ``core.blade``. A CSV has the columns of ``cases.input.blades.Stations``; its length is given separately.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import msgspec
from msgspec import Meta, Struct

from ....core.blade import Blade, BladeError
from .. import atomic
from ..blades import BladeData, Dimensionless, Stations, rigid_strains
from ..errors import CaseError
from ..names import Name
from ..toml import OR_A_NAME, convert, document, finite
from .sections import describe
from .source import Mount, Reading, Source

NAME = "Southwell TOML"
AXES = "Southwell's axes: x along the blade, z the rotor axis, y the direction of motion"


class BladeFile(Struct, frozen=True, forbid_unknown_fields=True):
    """A blade file."""

    name: Name
    blade: BladeData
    title: Annotated[str, Meta(description="one line")] = ""
    source: Annotated[str, Meta(description="source of the data")] = ""


def matches_format(path: Path) -> bool:
    """Whether a TOML file describes a blade, not a case or a mechanism."""
    content = document(path, OR_A_NAME)
    return "blade" in content and "speeds" not in content and "compare" not in content


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read the blade in a TOML or CSV file.

    Args:
        path: path of the file.
        mount: hub radius, precone and pitch that override the file; for a CSV also the length.

    Raises:
        CaseError: naming the file and field, or line, at fault.
    """
    mount = mount or Mount()
    if path.suffix.lower() == ".csv":
        if mount.length is None:
            raise CaseError(
                f"{path}: length: missing: stations are fractions of the length: give --length and --hub-radius"
            )
        stations = Stations(file=path.name, length=mount.length)
        blade, *_ = stations.read(path.stem, path.parent)
        source = Source("Southwell CSV", (path,), AXES, ("shear is rigid, the axis straight", *_rigid(blade)))
        return Reading(_mounted(blade, mount), source)
    data = document(path)
    finite(data, str(path))
    _blade_only(path, data)
    text = convert(data, BladeFile, str(path))
    if isinstance(text.blade, Dimensionless):
        raise CaseError(
            f"{path}: blade.kind: 'dimensionless': has no metres and seconds: use it in a case with gamma speeds"
        )
    try:
        blade, unused_values, _ = text.blade.read(text.name, path.parent)
    except CaseError as error:
        raise error if str(error).startswith(str(path.parent)) else CaseError(f"{path}: {error}") from error
    except BladeError as error:
        raise CaseError(f"{path}: blade: {error}") from error
    notes = (*(note for note in (text.title, text.source) if note), *_rigid(blade))
    return Reading(_mounted(blade, mount), Source(NAME, (path,), AXES, notes, unused_values))


def _blade_only(path: Path, data: Mapping[str, Any]) -> None:
    """Reject the file of a turbine, which names that of its blade or of its OpenFAST model."""
    rotor = data.get("rotor")
    file = rotor.get("blade") if isinstance(rotor, dict) else data.get("openfast")
    if isinstance(file, str):
        raise CaseError(
            f"{path}: a turbine, not a blade: give {path.parent / file} for its blade; `southwell campbell` and `southwell "
            "verify` solve the turbine"
        )


def _rigid(blade: Blade) -> tuple[str, ...]:
    """A note on strains that are rigid because the file has no stiffness for them."""
    return (f"{strains} not given: treated as rigid",) if (strains := rigid_strains(blade)) else ()


def _mounted(blade: Blade, mount: Mount) -> Blade:
    values = {n: getattr(mount, n) for n in ("hub_radius", "precone", "pitch") if getattr(mount, n) is not None}
    return replace(blade, **values)


def write(blade: Blade, path: Path) -> None:
    """Write any blade completely, so that ``read`` returns the same blade."""
    data = msgspec.to_builtins(describe(blade))
    lines = [f"name = {_toml(blade.name)}", "", "[blade]"]
    tables = {key: value for key, value in data.items() if isinstance(value, dict)}
    lines += [f"{key} = {_toml(value)}" for key, value in data.items() if value is not None and key not in tables]
    for name, table in tables.items():
        lines += ["", f"[blade.{name}]", *(f"{k} = {_toml(v)}" for k, v in table.items() if v is not None)]
    atomic.write(path, "\n".join(lines) + "\n")


def _toml(value: object) -> str:
    """Format a value as TOML; nested lists are on separate lines."""
    if isinstance(value, list | tuple) and value and isinstance(value[0], list | tuple):
        return "[\n" + "".join(f"  {_toml(v)},\n" for v in value) + "]"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml, value))}]"
    return msgspec.json.encode(value).decode() if isinstance(value, str) else repr(value)
