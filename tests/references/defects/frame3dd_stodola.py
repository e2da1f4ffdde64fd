"""Frame3DD: Stodola's iteration misses all modes of one plane, without a message.

stodola (eig.c) starts every mode with one degree of freedom and a ten-thousandth of the next. Where the two planes of
bending do not couple, starts that all lie in the softer plane find only its modes; the Sturm check that follows is not
reported. A uniform cantilever, four times as stiff in one plane as in the other; expected: Euler and Bernoulli, (beta
L)² sqrt(EI / m) / L².
Needs: wisdem (its folder pyframe3dd alone), numpy, and frame3dd_cantilever.py beside it.
"""

import numpy as np
from frame3dd_cantilever import EULER, METHODS, frequencies, output

EA, RATIO = 1e8, 4.0  # N, 1


def main():
    own = output()
    expected = np.sort(np.append(EULER, np.sqrt(RATIO) * EULER))[:4]
    print(f"expected:           {np.round(expected, 3)} rad/s", file=own)
    for method in METHODS:
        result = frequencies(method, 40, EA, RATIO)
        print(f"{method:19} {np.round(result, 3)} rad/s", file=own)
    print("defect:", "present" if np.abs(result / expected - 1).max() > 0.01 else "gone", file=own)


if __name__ == "__main__":
    main()
