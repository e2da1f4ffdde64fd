"""A uniform cantilever in Frame3DD, for the scripts beside this file."""

import importlib.util
import os
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(str(importlib.util.find_spec("wisdem").origin)).parent))  # pyright: ignore
from pyframe3dd import pyframe3dd as f3  # pyright: ignore[reportMissingImports]

LENGTH, EI, MASS = 6.0, 14e3, 1.2  # m, N m², kg/m
METHODS = {"subspace iteration": 1, "Stodola's iteration": 2}
EULER = np.square([1.875104, 4.694091, 7.854757]) * np.sqrt(EI / MASS) / LENGTH**2
"""Frequencies in one plane, rad/s."""


def output():
    """Standard output, and the version on its first line; Frame3DD's own prints, with escape codes, go elsewhere."""
    own = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    print(f"wisdem {version('wisdem')}", file=own)
    return own


def frequencies(method, elements, EA, ratio):
    """The four lowest, rad/s; ``ratio`` of the stiffness in one plane to that in the other."""
    node, none, ones = np.arange(1, elements + 2), np.zeros(elements + 1), np.ones(elements)
    clamped = [np.array([1]), *[np.array([1e30])] * 6]
    section = (
        ones,
        ones,
        ones,
        1e-4 * ones,
        EI / EA * ones,
        ratio * EI / EA * ones,
        EA * ones,
        EA * ones,
        0 * ones,
        MASS * ones,
    )
    frame = f3.Frame(
        f3.NodeData(node, np.linspace(0, LENGTH, elements + 1), none, none, none),
        f3.ReactionData(*clamped, rigid=1e30),
        f3.ElementData(node[:-1], node[:-1], node[1:], *section),
        f3.Options(False, True, -1.0),
    )
    frame.addLoadCase(f3.StaticLoadCase(0.0, 0.0, 0.0))
    frame.enableDynamics(4, METHODS[method], 0, 1e-9, 0.0)
    return 2 * np.pi * np.array(frame.run()[-1].freq)
