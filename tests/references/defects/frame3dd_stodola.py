"""Frame3DD: Stodola's iteration misses all modes of one plane, without a message.

stodola (eig.c) starts every mode with one degree of freedom and a ten-thousandth of the next. Where the two planes of
bending do not couple, starts that all lie in the softer plane find only its modes; the Sturm check that follows is not
reported. A uniform cantilever, four times as stiff in one plane as in the other; expected: Euler and Bernoulli, (beta
L)² sqrt(EI / m) / L².
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

LENGTH, EI, RATIO, MASS, EA = 6.0, 14e3, 4.0, 1.2, 1e8  # m, N m², 1, kg/m, N
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
    one_way = np.square([1.875104, 4.694091, 7.854757]) * np.sqrt(EI / MASS) / LENGTH**2
    expected = np.sort(np.append(one_way, np.sqrt(RATIO) * one_way))[:4]
    print(f"expected:           {np.round(expected, 3)} rad/s", file=own)
    for name, method in (("subspace iteration", SUBSPACE), ("Stodola's iteration", STODOLA)):
        found = frequencies(method, 40)
        print(f"{name:19} {np.round(found, 3)} rad/s", file=own)
    print("defect:", "present" if np.abs(found / expected - 1).max() > 0.01 else "gone", file=own)


if __name__ == "__main__":
    main()
