"""Frame3DD: subspace iteration fails for some cantilevers, whose modes Stodola's iteration finds.

Frequencies then are not numbers, and run raises "Frame3DD did not exit gracefully". In its source, jacobi (eig.c) has a
tolerance of zero: it rotates away coupling terms that are rounding, with division by zero or the root of a negative
number. Uniform cantilevers of one stiffness, hardly stretched, of 5 to 24 elements; expected: an answer, and the
textbook's, Euler and Bernoulli's (beta L)² sqrt(EI / m) / L².
Needs: wisdem (its folder pyframe3dd alone), numpy.
"""

import importlib.util
import os
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(str(importlib.util.find_spec("wisdem").origin)).parent))  # pyright: ignore
from pyframe3dd import pyframe3dd as f3  # pyright: ignore[reportMissingImports]

LENGTH, EI, RATIO, MASS, EA = 6.0, 14e3, 1.0, 1.2, 1e12  # m, N m², 1, kg/m, N
SUBSPACE, STODOLA = 1, 2


def frequencies(method, elements):
    """The four lowest, rad/s."""
    node, none, one = np.arange(1, elements + 2), np.zeros(elements + 1), np.ones(elements)
    clamped = [np.array([1]), *[np.array([1e30])] * 6]
    section = (one, one, one, 1e-4 * one, EI / EA * one, RATIO * EI / EA * one, EA * one, EA * one, 0 * one, MASS * one)
    frame = f3.Frame(
        f3.NodeData(node, np.linspace(0, LENGTH, elements + 1), none, none, none),
        f3.ReactionData(*clamped, rigid=1e30),
        f3.ElementData(node[:-1], node[:-1], node[1:], *section),
        f3.Options(False, True, -1.0),
    )
    frame.addLoadCase(f3.StaticLoadCase(0.0, 0.0, 0.0))
    frame.enableDynamics(4, method, 0, 1e-9, 0.0)
    return 2 * np.pi * np.array(frame.run()[-1].freq)


def main():
    own = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # Frame3DD writes escape codes
    print(f"wisdem {version('wisdem')}", file=own)
    expected = np.repeat(np.square([1.875104, 4.694091]) * np.sqrt(EI / MASS) / LENGTH**2, 2)
    sizes, said, lost = range(5, 25), set(), {}
    for name, method in (("subspace iteration", SUBSPACE), ("Stodola's iteration", STODOLA)):
        lost[method] = []
        for elements in sizes:
            try:
                found = frequencies(method, elements)
            except RuntimeError as error:
                lost[method].append(elements)
                said.add(str(error))
                continue
            assert np.abs(found / expected - 1).max() < 2e-3, found
        print(
            f"{name}: no answer with {lost[method] or 'none'} of {sizes[0]} to {sizes[-1]} elements (expected: none)",
            file=own,
        )
    print(f"said: {', '.join(said)}", file=own)
    print("defect:", "present" if lost[SUBSPACE] else "gone", file=own)


if __name__ == "__main__":
    main()
