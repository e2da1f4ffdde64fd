"""A rigid blade hinged to its hub, with a damper across the lag hinge, compared with closed forms.

``southwell mechanism hinged-blade`` solves the same mechanism from a TOML file.
"""

from math import sqrt

from southwell import multibody as mb

OMEGA = 30.0  # rad/s
OFFSET, LENGTH, MASS, DAMPER = 0.3, 4.0, 40.0, 600.0  # m, m, kg, N m s

ACROSS = MASS * LENGTH**2 / 12  # kg m², slender blade about its centre


def hinged_blade() -> mb.Mechanism:
    """A rotating shaft, coincident flap and lag hinges with the flap hinge inboard, and a lag damper."""
    return mb.Mechanism(
        bodies=(
            mb.Body("hub"),
            mb.Body("knuckle"),
            mb.Body("blade", mb.inertia(MASS, (0.0, ACROSS, ACROSS), centre=(LENGTH / 2, 0, 0))),
        ),
        joints=(
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint("flap", "revolute", "hub", "knuckle", mb.at(x=OFFSET, axis="-y"), mb.at(axis="-y")),
            mb.Joint("lag", "revolute", "knuckle", "blade"),
        ),
        motions=(mb.Motion("shaft.rz", rate=OMEGA),),
        coordinate_springs=(mb.CoordinateSpring("lag.rz", damping=DAMPER),),
    )


def closed_form() -> tuple[float, float, float]:
    """Flap and lag frequency and the lag mode's damping ratio (W. Johnson, *Helicopter Theory*, 1980, sec. 9-2).

    With S and I the blade's first and second moment of mass about the hinges: flap Ω √(1 + e S/I), lag Ω √(e S/I).
    """
    first, second = MASS * LENGTH / 2, MASS * LENGTH**2 / 3
    flap, lag = OMEGA * sqrt(1 + OFFSET * first / second), OMEGA * sqrt(OFFSET * first / second)
    return flap, lag, DAMPER / (2 * second * lag)


if __name__ == "__main__":
    found = mb.solve(hinged_blade())
    for frequency, ratio in zip(found.frequencies, found.damping, strict=True):
        print(f"{frequency:.6f} rad/s, damping ratio {ratio:.6f}")
    print("closed form: flap {:.6f}, lag {:.6f}, damping ratio {:.6f}".format(*closed_form()))
