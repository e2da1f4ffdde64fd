"""The tower in a windIO file: a circular tube of outer diameter, wall thickness and material.

Each layer is a ring of its own material, from the outside inwards; mass is multiplied by ``outfitting_factor``. Grids are
fractions of the height; lengths vary linearly. Nacelle and rotor are not read: windIO describes their components, whose inertia
other programs compute. Source: IEA Wind Task 37, windIO, turbine schema 1 and 2.

| | windIO 1 | windIO 2 |
|---|---|---|
| diameter, height | ``outer_shape_bem`` | ``outer_shape``, ``reference_axis`` |
| layers | ``internal_structure_2d_fem`` | ``structure`` |
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....core.blade import Blade, BladeError, section_mass, section_stiffness
from ....core.turbine.tower import Tower
from ..errors import CaseError
from .source import Source
from .text import load
from .yaml_fields import Field, fields

Array = NDArray[np.float64]

NAME = "windIO tower"

PARTS = 8
"""Stations in each part between points of the grids: bending stiffness is no linear function of the diameter."""


def read(path: Path) -> tuple[Tower, Source]:
    """Read the tower of a windIO file, clamped at its base, without weight and without what it carries.

    Raises:
        CaseError: naming the file and line at fault.
    """
    top = fields(load(path))
    tower = top.get("components", "tower")
    shape = tower.find("outer_shape") or tower.get("outer_shape_bem")
    structure = tower.find("structure") or tower.get("internal_structure_2d_fem")
    axis = shape.find("reference_axis") or tower.get("reference_axis")
    z, sideways = axis.get("z"), [part for part in map(axis.find, "xy") if part]
    if (np.diff(z.get("values").numbers()) <= 0).any():
        raise CaseError(f"{z.at}: does not rise from the base to the top; correct the values")
    if inclined := next((part for part in sideways if np.ptp(part.get("values").numbers()) > 0), None):
        raise CaseError(f"{inclined.at}: the tower is not vertical, which is not supported")
    diameter, layers = shape.get("outer_diameter"), structure.get("layers").parts()
    grids = [field.get("grid").numbers() for field in (z, diameter, *(layer.get("thickness") for layer in layers))]
    points = np.unique(np.concatenate(grids).round(9))
    eta = np.unique(np.concatenate([np.linspace(a, b, PARTS + 1) for a, b in pairwise(points)]))
    heights = _at(z, eta)
    materials = {part.get("name").word(): part for part in top.get("materials").parts()}
    outer_radius = 0.5 * _at(diameter, eta)
    EI, EA, GJ, mass, rotary = (np.zeros(len(eta)) for _ in range(5))
    for layer in layers:
        name = layer.get("material").word()
        if name not in materials:
            raise CaseError(f"{layer.get('material').at}: {name}: not in materials; add it")
        E, G, rho = _material(materials[name])
        inner_radius = outer_radius - _at(layer.get("thickness"), eta)
        if (inner_radius < 0).any():
            raise CaseError(f"{layer.at}: thickness: more than the radius; check the unit, m")
        area, second = np.pi * (outer_radius**2 - inner_radius**2), 0.25 * np.pi * (outer_radius**4 - inner_radius**4)
        EA += E * area
        EI += E * second
        GJ += 2.0 * G * second
        mass += rho * area
        rotary += rho * second
        outer_radius = inner_radius
    factor_field = structure.find("outfitting_factor")
    factor = factor_field.number() if factor_field else 1.0
    try:
        beam = Blade(
            path.stem,
            heights - heights[0],
            section_stiffness(EA, GJ, EI, EI),
            section_mass(factor * mass, rotary, rotary),
            0 * eta,
        )
    except BladeError as error:
        raise CaseError(f"{tower.at}: {error}") from error
    notes = (
        "clamped at the base, without weight; nacelle and rotor are not read",
        f"outfitting_factor {factor:g} multiplies the mass",
        "diameter and thickness vary linearly between the points of their grids",
    )
    return Tower(beam), Source(NAME, (path,), "windIO: z up; here x = its z", notes)


def _at(field: Field, eta: Array) -> Array:
    grid, values = field.get("grid").numbers(), field.get("values").numbers()
    if len(grid) != len(values) or (np.diff(grid) <= 0).any() or abs(grid[0]) > 1e-9 or abs(grid[-1] - 1.0) > 1e-9:
        raise CaseError(f"{field.at}: give a grid from 0 to 1 that ascends, and one value for each point")
    return np.interp(eta, grid, values)


def _material(material: Field) -> tuple[float, float, float]:
    """E and G, Pa, and density, kg/m³, of an isotropic material."""
    E, rho = material.get("E").number(), material.get("rho").number()
    nu, shear = material.find("nu"), material.find("G")
    G = shear.number() if shear else E / (2.0 * (1.0 + (nu.number() if nu else 0.3)))
    if min(E, G, rho) <= 0:
        raise CaseError(f"{material.at}: E, G and rho must be positive")
    return E, G, rho
