"""Read a blade's file again with the second reader of its format, and compare."""

from dataclasses import dataclass
from pathlib import Path

from ...core.blade import Blade
from ...references.readers import NotInstalledError, NotReadError, ReadingOptions, Stations, read
from ..input.readers import Mount, Source
from .comparison import Property, compare


@dataclass(frozen=True)
class SecondReading:
    """The comparison of a blade with the second reading of its file.

    Attributes:
        reader: the second reader and its version; its distribution, if it is not installed; else empty.
        properties: one per property, with the largest difference; empty without a second reading.
        missing: why there is no second reading, in one line; empty if there is.
        stations: as the second reader sees them; None without a second reading.
    """

    reader: str
    properties: tuple[Property, ...] = ()
    missing: str = ""
    stations: Stations | None = None

    @property
    def contradictions(self) -> tuple[Property, ...]:
        """Properties that differ."""
        return tuple(p for p in self.properties if not p.agrees)


def read_again(blade: Blade, path: Path, source: Source, mount: Mount) -> SecondReading:
    """Compare a blade with the second reading of the file ``path``.

    Args:
        blade: as the first reader returns it, before changes of its properties.
        path: the file that the user names.
        source: what the first reader states; its format selects the second reader, and it names the main file that lies
            beside a blade file.
        mount: what the user states besides the file.
    """
    files = tuple(file for file in source.files if file != path)
    multipliers, offsets = mount.multipliers, mount.offsets is not False
    try:
        stations = read(source.format, path, ReadingOptions(files, mount.length, mount.subset, multipliers, offsets))
    except NotInstalledError as error:
        return SecondReading("", missing=str(error))
    except NotReadError as error:
        return SecondReading("", missing=f"{source.format}: {error}")
    user_stated = tuple(name for name in ("hub_radius", "precone", "pitch") if getattr(mount, name) is not None)
    return SecondReading(stations.reader, compare(blade, stations, user_stated), stations=stations)
