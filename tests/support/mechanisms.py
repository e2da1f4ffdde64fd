"""Every mechanism there is, with a guess near its steady state."""

from collections.abc import Callable

from southwell import multibody as mb
from southwell.cases.input import library
from southwell.cases.plan import mechanism
from southwell.core.mechanism.description import at_rate
from southwell.tests.support import five_bar, four_bar
from southwell.tests.support import linkages as loops
from southwell.tests.support.closed_forms import linkages, pendulums

Case = tuple[mb.Mechanism, dict[str, float]]


def of_case(name: str) -> Case:
    described = library.mechanism(name)
    highest = mechanism.subject(described).points[-1]
    return at_rate(described.mechanism, described.text.rotor, highest), described.guess


def assembled() -> dict[str, float]:
    """The five-bar's coordinates, those of a joint that is cut included."""
    return mb.solve(five_bar.five_bar("C"), five_bar.GUESS).steady


CASES: dict[str, Callable[[], Case]] = {
    "turntable, unstable": lambda: (pendulums.turntable(6.0), {}),
    "pendulum, hanging": lambda: (pendulums.pendulum(2.0, True), {}),
    "pendulum, conical": lambda: (pendulums.pendulum(4.0, True), {"swing.rz": -1.0}),
    "pendulum, conical and free": lambda: (pendulums.pendulum(4.0, False), {"swing.rz": -1.0}),
    "top": lambda: (pendulums.top(5.0), {"nutation.rz": pendulums.TILT}),
    "double pendulum": lambda: (pendulums.double_pendulum(2.0), {}),
    "slider-crank": lambda: (linkages.slider_crank(3.0), {"guide.z": linkages.CRANK + linkages.CONNECTING}),
    "parallelogram": lambda: (linkages.parallelogram(3.0), {"A.rz": 1.2, "B.rz": -1.2, "C.rz": 1.2, "D.rz": 1.2}),
    "four-bar": lambda: (four_bar.four_bar("C", table_rate=1.5), four_bar.guess()),
    "four-bar in gravity": lambda: (loops.four_bar("C"), loops.FOUR),
    "five-bar that moves": lambda: (five_bar.five_bar(), five_bar.GUESS),
    **{f"five-bar cut at {cut}": lambda cut=cut: (five_bar.five_bar(cut), assembled()) for cut in "BDE"},
    "five-bar, undamped": lambda: (five_bar.undamped(), five_bar.GUESS),
    "ring": lambda: (linkages.ring(1.5, 4), {}),
    **{name: lambda name=name: of_case(name) for name in library.mechanisms()},
}
