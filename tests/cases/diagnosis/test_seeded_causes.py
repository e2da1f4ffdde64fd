"""Forty causes on five blades are named first through noise of 1e-4; numbers altered at random have no known cause.

The seeded numbers come from the solver's public functions on another mesh, not from the hypotheses.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest

from southwell.cases.diagnosis import spectra
from southwell.cases.diagnosis.diagnose import Diagnosis, explain
from southwell.cases.diagnosis.spectra import Problem
from southwell.core.blade import Blade
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.solve import mesh_sweep

from .blades import problem

NOISE, MESH = 1e-4, 45
LEAST = 0.95


@dataclass(frozen=True)
class Seed:
    """A cause: its name in the diagnosis, the blade, speed and options that it stands for."""

    name: str
    blade: Callable[[Blade], Blade] = lambda blade: blade
    speed: float = 1.0
    effects: Effects = ALL_EFFECTS
    gravity: Sequence[float] = (0.0, 0.0, 0.0)
    lumped: int = 0
    count: int = MESH


def _strain(factor: float, *strains: int) -> Callable[[Blade], Blade]:
    def alter(blade: Blade) -> Blade:
        stiffness = blade.stiffness.copy()
        for k in strains:
            stiffness[:, k] *= np.sqrt(factor)
            stiffness[:, :, k] *= np.sqrt(factor)
        return replace(blade, stiffness=stiffness)

    return alter


def _tip_station_without_mass(blade: Blade) -> Blade:
    return replace(blade, mass=np.concatenate([blade.mass[:-1], 1e-6 * blade.mass[-1:]]))


HUB = Seed("without hub radius", lambda b: replace(b, hub_radius=0.0))
TWICE_HUB = Seed("with twice the hub radius", lambda b: replace(b, hub_radius=2 * b.hub_radius))
STILL = Seed("without rotation", speed=0.0)
RPM = Seed("with the speed in rad/s read as rpm", speed=np.pi / 30)
HANGING = Seed("with gravity, blade hanging down", gravity=(9.80665, 0.0, 0.0))
UPRIGHT = Seed("with gravity, blade upright", gravity=(-9.80665, 0.0, 0.0))
NO_TWIST = Seed("without twist", lambda b: replace(b, twist=0 * b.twist))
LUMPED = Seed("with lumped mass on 10 elements", lumped=10)
NO_GEOMETRIC = Seed("without geometric stiffness", effects=Effects(geometric=False))
NO_ROTARY = Seed("without rotary inertia", effects=Effects(rotary_inertia=False))
UNDEFORMED = Seed("about the undeformed blade", effects=Effects(prestretch=False))
NO_CORIOLIS = Seed("without Coriolis terms", effects=Effects(coriolis=False))
G_MIXED = Seed("with E/2·(1 + ν) for G (ν = 0.3)", _strain(1.69, 3))
HEAVY = Seed("mass", lambda b: replace(b, mass=1.04 * b.mass, tip_mass=1.04 * b.tip_mass))
SOFT_FLAP = Seed("flapwise bending stiffness", _strain(0.97, 4))
STIFF_EDGE = Seed("edgewise bending stiffness", _strain(1.05, 5))
FAST = Seed("rotor speed", speed=1.05)
EXCHANGED = Seed(
    "with flapwise and edgewise stiffness exchanged",
    lambda b: replace(b, stiffness=b.stiffness[:, [0, 1, 2, 3, 5, 4]][:, :, [0, 1, 2, 3, 5, 4]]),
)
NO_PRECONE = Seed("without precone", lambda b: replace(b, precone=0.0))
PRECONE = Seed("with precone reversed", lambda b: replace(b, precone=-b.precone))
PITCH = Seed("with pitch reversed", lambda b: replace(b, pitch=-b.pitch))
NO_PITCH = Seed("without pitch", lambda b: replace(b, pitch=0.0))
TWIST = Seed("with twist reversed", lambda b: replace(b, twist=-b.twist))
NO_TIP = Seed("without tip mass", lambda b: replace(b, tip_mass=0 * b.tip_mass))
CLAMPED = Seed("clamped at the root", lambda b: replace(b, root=np.full(6, np.inf)))
PREBEND = Seed("with prebend reversed", lambda b: replace(b, curve=b.curve * [1, 1, -1]))
TIP_STATION = Seed("without the mass of the tip station", _tip_station_without_mass)

SEEDS = {
    "NREL 5 MW": (HUB, STILL, HANGING, NO_TWIST, LUMPED, G_MIXED, HEAVY, TIP_STATION),
    "WindPACT": (TWICE_HUB, UPRIGHT, NO_GEOMETRIC, NO_ROTARY, EXCHANGED, SOFT_FLAP, STIFF_EDGE, TIP_STATION),
    "coupled": (HUB, NO_CORIOLIS, UNDEFORMED, PRECONE, PITCH, TWIST, NO_TIP, NO_PRECONE),
    "prebent": (PREBEND, PRECONE, NO_PITCH, UNDEFORMED, NO_TWIST, HANGING, RPM, FAST),
    "sprung": (HUB, TWICE_HUB, CLAMPED, HANGING, UPRIGHT, LUMPED, RPM, HEAVY),
}  # fmt: skip


def numbers(problem: Problem, seed: Seed) -> np.ndarray:
    """(S, M) frequencies, rad/s, of a program with this cause."""
    answers = mesh_sweep(
        seed.blade(problem.blade),
        [seed.speed * omega for omega in problem.speeds],
        seed.lumped or MESH,
        len(problem.labels),
        mass="half_end" if seed.lumped else "consistent",
        effects=seed.effects,
        gravity=np.array(seed.gravity),
    )
    return np.array([modes.frequencies for modes in answers])


def is_first(diagnosis: Diagnosis, name: str) -> bool:
    return diagnosis.cause is not None and diagnosis.cause.changes[0][0] == name and len(diagnosis.cause.changes) == 1


@pytest.mark.slow
def test_forty_seeded_causes_are_named_first() -> None:
    rng = np.random.default_rng(43)
    missed = []
    for name, seeds in SEEDS.items():
        for seed in seeds:
            correct = numbers(problem(name), seed)
            diagnosis = explain(problem(name), correct * (1.0 + NOISE * rng.standard_normal(correct.shape)))
            if not is_first(diagnosis, seed.name):
                missed.append((name, seed.name, diagnosis.sentence))
    total = sum(map(len, SEEDS.values()))
    assert total == 40
    assert len(missed) <= (1 - LEAST) * total, missed


@pytest.mark.slow
def test_numbers_altered_at_random_have_no_known_cause() -> None:
    rng = np.random.default_rng(44)
    names = []
    count = 0
    for name in SEEDS:
        reference = spectra.reference(problem(name))
        modes, fast = reference.shape[1], np.array(problem(name).speeds)[:, None] ** 2 / problem(name).speeds[-1] ** 2
        for size in (1e-3, 1e-2, 1e-1):
            for altered in (
                rng.standard_normal(reference.shape),
                np.tile(rng.standard_normal(modes), (len(reference), 1)),
                rng.standard_normal(modes) + fast * rng.standard_normal(modes),
                rng.uniform(-1.0, 1.0, reference.shape),
            ):
                diagnosis = explain(problem(name), reference * np.exp(size * altered))
                count += 1
                if diagnosis.cause or diagnosis.arithmetic:
                    names.append((name, size, diagnosis.sentence))
    assert count == 60
    assert len(names) <= (1 - LEAST) * count, names
