"""The second reading agrees with the first on every format, and names the property that a wrong reader changes."""

import contextlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from southwell.cases.input import blades, readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount, bmodes, windio
from southwell.cases.input.readers.hawc2 import blade as hawc2
from southwell.cases.input.readers.openfast import beamdyn, elastodyn, elastodyn_table
from southwell.cases.reading.comparison import compare
from southwell.cases.reading.second import SecondReading, read_again
from southwell.cases.solve.properties import of_reading
from southwell.core.blade import Blade
from southwell.tests.support import blade_files, decks
from southwell.tests.support.blade_files import real

pytest.importorskip("weio")
pytest.importorskip("pybmodes")
pytest.importorskip("ruamel.yaml")


def again(path: Path, mount: Mount | None = None) -> SecondReading:
    reading = readers.reading(path, mount)
    return read_again(reading.blade, path, reading.source, mount or Mount())


def deck(folder: Path, name: str) -> tuple[Path, Mount | None]:
    """A deck by name, and what its user states."""
    match name:
        case "hawc2-plain":
            return decks.hawc2(folder), None
        case "hawc2-full":
            return decks.hawc2(folder, full=True), None
        case "bmodes":
            return decks.bmodes(folder), None
        case "csv":
            return decks.csv(folder), Mount(length=20.0, hub_radius=1.0)
        case "windio-1" | "windio-2":
            data = blade_files.samples()[int(name[-1]) - 1]
            return blade_files.written(folder / "blade.yaml", data), None
        case _:
            decks.openfast(folder)
            return folder / name, None


DECKS = (
    *("elastodyn_main.dat", "elastodyn_blade.dat", "fast7_main.fst", "beamdyn_main.dat", "beamdyn_blade.dat"),
    *("hawc2-plain", "hawc2-full", "bmodes", "csv", "windio-1", "windio-2"),
)


EXAMPLE = Path(__file__).parents[3] / "examples" / "nrel-5mw-blade.dat"


@pytest.mark.parametrize("name", DECKS)
def test_both_readings_agree(tmp_path: Path, name: str) -> None:
    repeated = again(*deck(tmp_path, name))
    assert not repeated.missing
    assert [p.where(repeated.reader) for p in repeated.contradictions] == []
    assert len(repeated.properties) >= 15
    assert max(p.difference for p in repeated.properties) < 1e-9


@pytest.mark.parametrize(
    ("name", "mount"),
    [
        ("nrel5mw/NRELOffshrBsline5MW_Blade.dat", Mount(length=61.5)),
        ("nrel5mw/NRELOffshrBsline5MW_BeamDyn.dat", None),
        ("iea15/IEA-15-240-RWT_BeamDyn_blade.dat", Mount(length=117.0)),
        ("iea3.4/IEA-3.4-130-RWT_BeamDyn_Blade.dat", Mount(length=63.0)),
        ("iea15/IEA_15MW_RWT_Blade_st_FPM.st", None),
        ("iea15/IEA_15MW_RWT_Blade_st_noFPM.st", Mount(subset=(1, 1))),
        ("iea3.4/blade_st.dat", Mount(subset=(1, 1))),
    ],
)
def test_both_readings_of_published_blades_agree(name: str, mount: Mount | None) -> None:
    repeated = again(real(name), mount)
    assert max(p.difference for p in repeated.properties) < 1e-12


def test_both_readings_of_the_example_agree() -> None:
    """Its description, "distributed properties of …", reads to weio like the head of BeamDyn's table."""
    repeated = again(EXAMPLE, Mount(length=61.5, hub_radius=1.5))
    assert not repeated.missing
    assert max(p.difference for p in repeated.properties) < 1e-12


def altered(patch: pytest.MonkeyPatch, module: Any, change: Callable[[dict[str, Any]], dict[str, Any]]) -> None:
    """Let a reader's module make a blade with changed fields."""
    patch.setattr(module, "Blade", lambda **fields: Blade(**{**fields, **change(fields)}))


def exchanged(function: Callable[..., Any], i: int, j: int) -> Callable[..., Any]:
    """The function with two of its positional arguments exchanged."""

    def call(*args: Any, **kwargs: Any) -> Any:
        order = list(range(len(args)))
        order[i], order[j] = order[j], order[i]
        return function(*(args[k] for k in order), **kwargs)

    return call


def product_sign(mass: np.ndarray, i: int, j: int) -> np.ndarray:
    out = mass.copy()
    out[..., i, j] *= -1
    out[..., j, i] *= -1
    return out


def upper_triangle(patch: pytest.MonkeyPatch) -> None:
    rows: dict[tuple[str, int], dict[int, list[float]]] = {}
    row = beamdyn._row

    def mirrored(text: Any, k: int, kind: str, j: int, i: int, count: int) -> list[float]:
        before = rows.setdefault((kind, i), {})
        before[j] = row(text, k, kind, j, i, count)
        return [before[c][j] if c < j else v for c, v in enumerate(before[j])]

    patch.setattr(beamdyn, "_row", mirrored)


def shear_about_the_mass_centre(patch: pytest.MonkeyPatch) -> None:
    stiffness = hawc2.stiffness_of

    def moved(p: Any) -> Any:
        columns = {**p.columns, "x_sh": p["x_cg"], "y_sh": p["y_cg"]}
        return stiffness(replace(p, columns=columns))

    patch.setattr(hawc2, "stiffness_of", moved)


def second_blades_tip_mass(patch: pytest.MonkeyPatch) -> None:
    value = elastodyn.value

    def of_blade_2(text: Any, named: Any, name: str, *others: str) -> float:
        return value(text, named, "TipMass2" if name == "TipMass1" else name, *others)

    patch.setattr(elastodyn, "value", of_blade_2)


def no_multipliers(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(elastodyn_table, "value", lambda *_: 1.0)


MISTAKES: dict[str, tuple[str, Callable[[pytest.MonkeyPatch], None], set[str]]] = {
    "ElastoDyn: FlpStff and EdgStff exchanged": (
        "elastodyn_main.dat",
        lambda patch: patch.setattr(elastodyn, "section_stiffness", exchanged(elastodyn.section_stiffness, 2, 3)),
        {"flapwise stiffness", "edgewise stiffness"},
    ),
    "ElastoDyn: twist of the other sign": (
        "elastodyn_main.dat",
        lambda patch: altered(patch, elastodyn, lambda fields: {"twist": -fields["twist"]}),
        {"twist"},
    ),
    "ElastoDyn: multipliers ignored": (
        "elastodyn_main.dat",
        no_multipliers,
        {"mass per length", "flapwise stiffness", "edgewise stiffness"},
    ),
    "ElastoDyn: precone of the other sign": (
        "elastodyn_main.dat",
        lambda patch: altered(patch, elastodyn, lambda fields: {"precone": -fields["precone"]}),
        {"precone"},
    ),
    "ElastoDyn: hub radius dropped": (
        "elastodyn_main.dat",
        lambda patch: altered(patch, elastodyn, lambda fields: {"hub_radius": 0.0}),
        {"hub radius"},
    ),
    "ElastoDyn: tip mass of blade 2": ("tip_masses.dat", second_blades_tip_mass, {"tip mass"}),
    "FAST 7: offsets about the pitch axis": (
        "fast7_main.fst",
        lambda patch: patch.setattr(elastodyn, "about", lambda mass, *centre: mass),
        {"first moments of mass", "moments of inertia"},
    ),
    "BeamDyn: upper triangle instead of the mean": ("asymmetric", upper_triangle, {"stiffness couplings"}),
    "BeamDyn: twist of the other sign": (
        "beamdyn_main.dat",
        lambda patch: altered(patch, beamdyn, lambda fields: {"twist": -fields["twist"]}),
        {"twist"},
    ),
    "BeamDyn: prebend of the other sign": (
        "beamdyn_main.dat",
        lambda patch: altered(patch, beamdyn, lambda fields: {"curve": fields["curve"] * [1, 1, -1]}),
        {"reference curve z"},
    ),
    "HAWC2: k_x and k_y exchanged": (
        "hawc2-plain",
        lambda patch: patch.setattr(hawc2, "shearing", exchanged(hawc2.shearing, 1, 2)),
        {"edgewise shear stiffness", "flapwise shear stiffness", "stiffness couplings", "torsional stiffness"},
    ),
    "HAWC2: sign of the product of inertia": (
        "hawc2-plain",
        lambda patch: patch.setattr(hawc2, "mass_of", lambda p, mass=hawc2.mass_of: product_sign(mass(p), 4, 5)),
        {"moments of inertia"},
    ),
    "HAWC2: sign of the principal axes' pitch": (
        "hawc2-plain",
        lambda patch: patch.setattr(hawc2, "rotated", lambda m, angle, old=hawc2.rotated: old(m, -angle)),
        {"stiffness couplings", "moments of inertia", "torsional stiffness"},
    ),
    "HAWC2: shear about the mass centre": (
        "hawc2-plain",
        shear_about_the_mass_centre,
        {"stiffness couplings", "torsional stiffness"},
    ),
    "HAWC2: full matrix left at the elastic centre": (
        "hawc2-full",
        lambda patch: patch.setattr(hawc2, "about", lambda m, *centre: m),
        {
            *("stiffness couplings", "torsional stiffness", "flapwise stiffness", "edgewise stiffness"),
            *("first moments of mass", "moments of inertia"),
        },
    ),
    "BModes: multipliers ignored": (
        "bmodes",
        lambda patch: patch.setattr(bmodes, "FACTORS", {}),
        {"mass per length", "first moments of mass", "moments of inertia", "edgewise stiffness"},
    ),
    "BModes: offsets of the other sign": (
        "bmodes",
        lambda patch: patch.setattr(bmodes, "about", lambda m, y, z, old=bmodes.about: old(m, -y, z)),
        {"first moments of mass", "stiffness couplings"},
    ),
    "CSV: I_flap and I_edge exchanged": (
        "csv",
        lambda patch: patch.setattr(blades, "section_mass", exchanged(blades.section_mass, 1, 2)),
        {"moments of inertia"},
    ),
    "CSV: sign of cg_edge": (
        "csv",
        lambda patch: patch.setattr(blades, "offset", lambda m, ahead, old=blades.offset: old(m, -ahead)),
        {"first moments of mass"},
    ),
    "windIO 1: twist in degrees": (
        "windio-1",
        lambda patch: patch.setattr(windio, "_layout", lambda top, old=windio._layout: old(top)._replace(degrees=1.0)),
        {"twist"},
    ),
    "windIO 2: sign of the product of inertia": (
        "windio-2",
        lambda patch: patch.setattr(
            windio, "_mass", lambda inertia, old=windio._mass: product_sign(old(inertia), 3, 4)
        ),
        {"moments of inertia"},
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_a_reader_is_found_by_the_name_of_the_property(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mistake: str
) -> None:
    name, make, expected = MISTAKES[mistake]
    if name == "tip_masses.dat":
        path, mount = deck(tmp_path, "elastodyn_main.dat")
        text = path.read_text()
        assert "TipMass(2)" in text
        path.write_text("\n".join("55 TipMass(2)" if "TipMass(2)" in line else line for line in text.splitlines()))
    elif name == "asymmetric":
        path, mount = deck(tmp_path, "beamdyn_main.dat")
        unsymmetric(tmp_path / "beamdyn_blade.dat")
    else:
        path, mount = deck(tmp_path, name)
    assert not again(path, mount).contradictions
    make(monkeypatch)
    repeated = again(path, mount)
    assert {p.name for p in repeated.contradictions} == expected


TABLES = {
    "elastodyn_main.dat": elastodyn_table,
    "fast7_main.fst": elastodyn_table,
    "hawc2-plain": hawc2,
    "hawc2-full": hawc2,
    "bmodes": bmodes,
}


@pytest.mark.parametrize("name", TABLES)
def test_neighbouring_columns_exchanged_in_a_reader_are_refused_or_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """All 835 pairs of these tables were exchanged once: 379 are refused, 455 are found, and one has no effect."""
    module, order = TABLES[name], list[str]()
    path, mount = deck(tmp_path, name)
    table, original = module.table, again(path, mount).stations
    assert original is not None

    def exchange(text: Any, first: int, count: int, columns: Any) -> Any:
        read = table(text, first, count, columns)
        order[:] = columns
        a, b = columns[k], columns[k + 1]
        return replace(read, columns={**read.columns, a: read.columns[b], b: read.columns[a]})

    monkeypatch.setattr(module, "table", exchange)
    k, accepted = 0, list[str]()
    while not order or k < len(order) - 1:
        with contextlib.suppress(CaseError):
            blade = readers.reading(path, mount).blade
            if all(p.agrees for p in compare(blade, original)):
                accepted.append(f"{order[k]}, {order[k + 1]}")
        k += 1
    assert not accepted


def unsymmetric(path: Path) -> None:
    """Change a coupling above the diagonal of the first station by 1e-4 of the diagonal's geometric mean."""
    lines = path.read_text().splitlines()
    first = next(
        k
        for k, line in enumerate(lines)
        if len(line.split()) == 6 and line.split()[0].count("E+") and float(line.split()[0]) > 1e6
    )
    row = [float(v) for v in lines[first].split()]
    second = [float(v) for v in lines[first + 1].split()]
    row[1] += 1e-4 * np.sqrt(row[0] * second[1])
    lines[first] = "  ".join(f"{v:.9E}" for v in row)
    path.write_text("\n".join(lines) + "\n")


def test_a_mount_that_the_user_states_is_not_compared(tmp_path: Path) -> None:
    path, _ = deck(tmp_path, "elastodyn_main.dat")
    repeated = again(path, Mount(hub_radius=3.0, multipliers=(1.0, 1.0, 1.1)))
    assert not repeated.contradictions
    assert "hub radius" not in {p.name for p in repeated.properties}


def test_a_file_that_the_parser_does_not_read_is_no_difference() -> None:
    repeated = again(decks.BLADES / "beamdyn_old_main.dat")
    assert repeated.missing.startswith("BeamDyn: ")
    assert not repeated.properties


def test_a_field_that_violates_windios_schema_is_named(tmp_path: Path) -> None:
    """The schema has the cone of both kinds of rotors positive; structural_damping is required, and the sample has none."""
    pytest.importorskip("windIO", reason="its package ships the schema: pip install windIO")
    _, data = blade_files.samples()
    damped = {"mu": [0.0] * 6}
    data["components"]["blade"]["structure"]["elastic_properties"]["structural_damping"] = damped
    path = blade_files.written(tmp_path / "right.yaml", data)
    reading = readers.reading(path)
    file = readers.BladeFile(path, reading.blade, reading.source, Mount())
    assert all(row.verdict == "pass" for row in of_reading("case", file, reading.blade)[0])
    data["components"]["hub"]["cone_angle"] = -4.0
    path = blade_files.written(tmp_path / "wrong.yaml", data)
    reading = readers.reading(path)
    rows, _ = of_reading("case", readers.BladeFile(path, reading.blade, reading.source, Mount()), reading.blade)
    (unsure,) = [row for row in rows if row.verdict != "pass"]
    assert unsure.verdict == "inconclusive"
    assert unsure.reason.startswith(
        "components.hub.cone_angle: -4.0 is less than the minimum of 0, by the schema of windIO"
    )
