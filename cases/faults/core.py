"""Faults in core, where Python passes geometry, sections, chains and pencils to the compiled kernels."""

from dataclasses import replace
from typing import Any

import numpy as np

from ...core import solve
from ...core.blade import BEND_Z, TORSION
from ...core.element import discretize, sections
from ...core.spectrum import mesh_solver as solution
from ..diagnosis import blade_errors as errors
from ..solve import core_solver
from .alterations import (
    at_speed,
    core_modes,
    light_tip,
    pencil,
    received,
    softening,
    swapped_coupling,
    whole_end,
    with_effects,
)
from .seeding import Fault, Trial
from .trials import AXIAL, CONED, COUPLED, CROSSED, FAST, HINGED, PARK, PITCHED, TAPERED, THICK, TIP, TORSIONAL, TWISTED


def _core(name: str, description: str, size: str, seam: Any, trial: Trial, fast: bool = False) -> Fault:
    return Fault(name, "solver", description, size, (seam,), trial, fast=fast)


BALANCE = "balance"

FAULTS = (
    _core(
        "no geometric stiffness",
        "the centrifugal tension does not stiffen",
        "first edgewise −71 %",
        (solution, BALANCE, with_effects(geometric=False)),
        PARK,
        True,
    ),
    _core(
        "softening's sign",
        "spin softening is added instead of subtracted",
        "first edgewise +57 %",
        (solution, BALANCE, softening(-1.0)),
        PARK,
        True,
    ),
    _core(
        "frozen frame",
        "linearised in a frame that does not rotate: edgewise is read as flapwise",
        "first edgewise +31 %",
        (solution, BALANCE, softening(0.0, coriolis=False)),
        PARK,
        True,
    ),
    _core(
        "axis shifted",
        "reference axis shifted by a quarter of the radius of gyration, without the coupling terms",
        "edgewise +2 to +3 %",
        core_modes(errors.shifted_axis),
        PARK,
        True,
    ),
    _core(
        "no Coriolis",
        "no Coriolis force",
        "first edgewise 1.7 % at γ = 10",
        (solution, BALANCE, with_effects(coriolis=False)),
        FAST,
        True,
    ),
    _core(
        "whole end mass",
        "the lumped mass at the tip is that of a whole element instead of a half",
        "first modes −2 % of 50 elements",
        (solve, "discretize", whole_end),
        PARK,
        True,
    ),
    _core(
        "no hub radius",
        "the root is on the rotor axis",
        "first modes −3 %",
        (sections, "root", received(lambda b: replace(b, hub_radius=0.0))),
        PARK,
        True,
    ),
    _core(
        "Coriolis' sign",
        "the gyroscopic terms have the opposite sign: the phase between stretch and bending is reversed",
        "no frequency; MAC of mixed modes below 0.8",
        (solution, BALANCE, pencil(lambda p: replace(p, C=-p.C))),
        AXIAL,
    ),
    _core(
        "half the Coriolis force",
        "a factor of 2 lost in the Coriolis terms",
        "first edgewise 1.2 % at γ = 10",
        (
            solution,
            BALANCE,
            pencil(lambda p: replace(p, C=0.5 * p.C)),
        ),
        FAST,
    ),
    _core(
        "no prestretch",
        "the steady state is that of the undeformed blade",
        "first edgewise 10 % at γ = 50",
        (solution, BALANCE, with_effects(prestretch=False)),
        AXIAL,
    ),
    _core(
        "half the softening",
        "spin softening of half the size",
        "first edgewise +17 %",
        (solution, BALANCE, softening(0.5)),
        PARK,
    ),
    _core(
        "no rotary inertia",
        "sections have no moments of inertia",
        "second flapwise +1.3 %",
        core_modes(lambda b: replace(b, mass=b.mass * np.pad(np.ones((3, 3)), (0, 3)))),
        THICK,
    ),
    _core(
        "twist's sense",
        "twist rotates the sections in the opposite sense",
        "shapes mirrored; MAC below 0.8",
        (sections, "twist_at", lambda original: lambda blade, s: -original(blade, s)),
        TWISTED,
    ),
    _core(
        "twist across ±180°",
        "the twist jumps by a turn between two stations if its sign changes there",
        "shapes and frequencies by tens of percent",
        (sections, "twist_at", lambda original: lambda blade, s: original(replace(blade, twist=blade.twist % (2 * np.pi)), s)),
        CROSSED,
    ),
    _core(
        "no twist",
        "twist is dropped",
        "second mode by several percent",
        (sections, "twist_at", lambda original: lambda blade, s: 0.0 * original(blade, s)),
        TWISTED,
    ),
    _core(
        "precone's sense",
        "precone has the opposite sense",
        "lowest modes ±0.5 %",
        (sections, "root", received(lambda b: replace(b, precone=-b.precone))),
        CONED,
    ),
    _core(
        "no precone",
        "precone is dropped",
        "lowest modes ±0.5 %",
        (sections, "root", received(lambda b: replace(b, precone=0.0))),
        CONED,
    ),
    _core(
        "pitch's sense",
        "pitch has the opposite sense",
        "lowest modes ±0.5 %",
        (sections, "root", received(lambda b: replace(b, pitch=-b.pitch))),
        PITCHED,
    ),
    _core(
        "no pitch",
        "pitch is dropped",
        "lowest modes by several percent",
        (sections, "root", received(lambda b: replace(b, pitch=0.0))),
        PITCHED,
    ),
    _core(
        "last element's mass",
        "the last tenth of the blade has no mass",
        "first modes +23 %",
        (discretize, "mass_at", light_tip),
        PARK,
    ),
    _core(
        "mass per length",
        "mass one half of a percent too large",
        "all modes at rest −0.25 %",
        (discretize, "mass_at", received(errors.scaled_mass(1.005))),
        Trial("park-cantilever", (0.0,), ("exact-beam",)),
    ),
    _core(
        "no taper",
        "the stiffness of the root along the whole blade",
        "first modes +10 %",
        (sections, "stiffness_at", lambda original: lambda blade, s: original(blade, 0.0 * np.asarray(s))),
        TAPERED,
    ),
    _core("tip mass in grams", "a unit error: a thousand times the tip mass", "first modes by −80 %",
          (solve, "discretize", received(lambda b: replace(b, tip_mass=1000.0 * b.tip_mass))), TIP),
    _core("no tip mass", "the tip mass is dropped", "first modes by tens of percent",
          (solve, "discretize", received(lambda b: replace(b, tip_mass=0.0 * b.tip_mass))), TIP),
    _core("offset's sign", "the mass centre of the tip body is behind the axis instead of ahead of it", "lowest modes ±0.5 %",
          (solve, "discretize", received(errors.mirrored_tip)), CONED),
    _core("axes swapped", "flapwise and edgewise bending stiffness are exchanged", "factor 2",
          (sections, "stiffness_at", received(errors.exchanged_bending)), Trial("pretwisted-beam", (0.0,), ("assumed-modes",))),
    _core("bending stiffness", "EI_z half a percent too large", "edgewise at rest +0.25 %",
          (sections, "stiffness_at", received(errors.scaled_strain(1.005, BEND_Z))),
          Trial("park-cantilever", (0.0,), ("exact-beam",))),
    _core("torsional stiffness", "GJ one percent too large", "first torsion +0.5 %",
          (sections, "stiffness_at", received(errors.scaled_strain(1.01, TORSION))), TORSIONAL),
    _core("speed in revolutions", "the speed in rad/s is read as revolutions per second", "flapwise by factors",
          (core_solver, "mesh_sweep", at_speed(lambda omega: 2 * np.pi * omega)), PARK),
    _core("transposed coupling", "torsion is coupled with the other bending: two indices exchanged", "shapes; percents",
          (sections, "stiffness_at", received(swapped_coupling)), COUPLED),
    _core("coupling's sign", "the coupling of bending and torsion has the opposite sign", "lowest modes by several percent",
          (sections, "stiffness_at", received(errors.scaled_coupling(-1.0))), COUPLED),
    _core("no coupling", "the sections' off-diagonal stiffness is dropped", "percents",
          (sections, "stiffness_at", received(errors.scaled_coupling(0.0))), COUPLED),
    _core("one Gauss point", "the flexibility of an element is integrated with one point and is singular", "no answer",
          (sections, "GAUSS", lambda _: 1), PARK),
    _core("root spring", "the spring in the root's hinge is dropped", "first modes by tens of percent",
          core_modes(lambda b: replace(b, root=np.where(np.isinf(b.root), b.root, 0.0))), HINGED),
)  # fmt: skip
