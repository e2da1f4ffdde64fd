"""Frame3DD: subspace iteration fails for some cantilevers, whose modes Stodola's iteration finds.

Frequencies then are not numbers, and run raises "Frame3DD did not exit gracefully". In its source, jacobi (eig.c) has a
tolerance of zero: it rotates away coupling terms that are rounding, with division by zero or the root of a negative
number. Uniform cantilevers of one stiffness, hardly stretched, of 5 to 24 elements; expected: an answer, and the
textbook's, Euler and Bernoulli's (beta L)² sqrt(EI / m) / L².
Needs: wisdem (its folder pyframe3dd alone), numpy, and frame3dd_cantilever.py beside it.
"""

import numpy as np
from frame3dd_cantilever import EULER, METHODS, frequencies, output

EA, RATIO = 1e12, 1.0  # N, 1


def main():
    own = output()
    expected = np.repeat(EULER[:2], 2)
    sizes, message, lost = range(5, 25), set(), {}
    for method in METHODS:
        lost[method] = []
        for elements in sizes:
            try:
                result = frequencies(method, elements, EA, RATIO)
            except RuntimeError as error:
                lost[method].append(elements)
                message.add(str(error))
                continue
            assert np.abs(result / expected - 1).max() < 2e-3, result
        print(
            f"{method}: no answer with {lost[method] or 'none'} of {sizes[0]} to {sizes[-1]} elements (expected: none)",
            file=own,
        )
    print(f"said: {', '.join(message)}", file=own)
    print("defect:", "present" if lost["subspace iteration"] else "gone", file=own)


if __name__ == "__main__":
    main()
