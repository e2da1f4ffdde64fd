"""Rotors on towers by formula, linearised in the coordinates of OpenFAST's ``.lin`` files.

Lagrange's function of second order, L = ½ q̇ᵀ M q̇ + q̇ᵀ H q − ½ qᵀ K q with M, H and K that depend on the azimuth, gives
M q̈ + (Ṁ + H − Hᵀ + C) q̇ + (K + Ḣ) q = 0. In the plane of rotation the blade at azimuth ψ (0: up) points to cos ψ upwards
and sin ψ sideways.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

XI = (np.arange(400) + 0.5) / 400
FLAP, FLAP_2, EDGE = XI**2, XI**2 * (4 * XI - 3), XI**2
SLOPE_FLAP, SLOPE_FLAP_2, SLOPE_EDGE = 2 * XI, 12 * XI**2 - 6 * XI, 2 * XI


@dataclass(frozen=True)
class Machine:
    """Three blades with flap and edge modes on a tower with yaw, generator and drivetrain.

    Stiffnesses are given by frequencies in Hz of the isolated motions; ``pitch`` turns the blade's principal axes.
    ``flap_factor`` and ``pitch_sign`` are per blade, so that blades can differ; ``generator_factor`` multiplies the
    generator's inertia and no spring.
    """

    omega: float = 1.0
    radius: float = 60.0
    mass: float = 250.0
    nacelle: float = 350e3
    yaw_inertia: float = 4e6
    generator: float = 4.5e6
    generator_factor: float = 1.0
    tower: tuple[float, float] = (0.34, 0.33)
    yaw: float = 1.6
    drivetrain: float = 1.9
    flap: float = 0.68
    edge: float = 1.08
    flap_2: float = 2.1
    pitch: float = 0.15
    damping: float = 0.004
    aerodynamic: float = 0.0
    gravity: float = 9.81
    flap_factor: tuple[float, float, float] = (1.0, 1.0, 1.0)
    pitch_sign: tuple[float, float, float] = (1.0, 1.0, 1.0)

    def matrices(self, psi: float) -> tuple[Array, Array, Array]:
        """M, the factor of q̇ and the factor of q at azimuth ``psi``."""
        o = self.omega
        r, dr = XI * self.radius, self.radius / len(XI)

        def integral(*factors: Array) -> float:
            return float(self.mass * np.sum(np.prod(factors, axis=0)) * dr)

        ones = np.ones_like(r)
        n = 14
        x, y, yaw, gen, drt = range(5)
        M, dM, H, dH, K, C = (np.zeros((n, n)) for _ in range(6))
        I = integral(r, r)
        rotor = 3 * integral(ones)
        M[x, x] = M[y, y] = self.nacelle + rotor
        M[yaw, yaw] = self.yaw_inertia + 1.5 * I
        M[gen, gen] = self.generator_factor * self.generator + 3 * I
        M[gen, drt] = M[drt, gen] = M[drt, drt] = 3 * I

        def spring(i: int, hertz: float, inertia: float) -> None:
            K[i, i] += (2 * np.pi * hertz) ** 2 * inertia
            C[i, i] += 2 * self.damping * 2 * np.pi * hertz * inertia

        spring(x, self.tower[0], M[x, x])
        spring(y, self.tower[1], M[y, y])
        spring(yaw, self.yaw, M[yaw, yaw])
        spring(drt, self.drivetrain, 3 * I * self.generator / (3 * I + self.generator))
        for b in range(3):
            a = psi + 2 * np.pi * b / 3
            c, s = np.cos(a), np.sin(a)
            f, e, g = 5 + b, 8 + b, 11 + b
            flaps = ((f, FLAP, SLOPE_FLAP), (g, FLAP_2, SLOPE_FLAP_2))
            for i, p, slope in flaps:
                _pair(M, x, i, integral(p))
                _pair(M, yaw, i, integral(r, p) * s)
                _pair(dM, yaw, i, integral(r, p) * c)
                H[yaw, i] = -o * integral(r, p) * c
                dH[yaw, i] = o * integral(r, p) * s
                for j, q, slope_2 in flaps:
                    M[i, j] = integral(p, q)
                    tension = _tension(self.mass, r, dr)
                    K[i, j] += o**2 * float(np.sum(tension * slope * slope_2) * dr) / self.radius**2
                    weight = self.mass * (self.radius - r) * self.gravity
                    K[i, j] -= c * float(np.sum(weight * slope * slope_2) * dr) / self.radius**2
            M[e, e] = integral(EDGE, EDGE)
            _pair(M, y, e, integral(EDGE) * c)
            _pair(dM, y, e, -integral(EDGE) * s)
            for k in (gen, drt):
                _pair(M, e, k, integral(r, EDGE))
                _pair(K, e, k, -self.gravity * integral(EDGE) * c)
            H[y, e] = -o * integral(EDGE) * s
            dH[y, e] = -o * integral(EDGE) * c
            tension = _tension(self.mass, r, dr)
            K[e, e] += o**2 * (float(np.sum(tension * SLOPE_EDGE**2) * dr) / self.radius**2 - M[e, e])
            K[e, e] -= (
                c * self.gravity * float(np.sum(self.mass * (self.radius - r) * SLOPE_EDGE**2) * dr) / self.radius**2
            )
            stiff = np.diag([(2 * np.pi * self.flap) ** 2 * M[f, f], (2 * np.pi * self.edge) ** 2 * M[e, e]])
            stiff[0, 0] *= self.flap_factor[b]
            turn = self.pitch * self.pitch_sign[b]
            R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
            beta = self.damping / (np.pi * self.flap)
            both = np.ix_([f, e], [f, e])
            K[both] += R @ stiff @ R.T
            C[both] += beta * R @ stiff @ R.T
            K[g, g] += (2 * np.pi * self.flap_2) ** 2 * M[g, g]
            C[g, g] += beta * (2 * np.pi * self.flap_2) ** 2 * M[g, g]
            C[f, f] += self.aerodynamic * M[f, f]
        return M, o * dM + H - H.T + C, K + o * dH

    def A(self, psi: float) -> Array:
        """State matrix of displacements and rates."""
        return state_matrix(*self.matrices(psi))

    def locked(self) -> Callable[[float], Array]:
        """State matrices of the machine with a locked generator: without its states."""
        keep = [k for k in range(14) if k != 3]
        return lambda psi: state_matrix(*(each[np.ix_(keep, keep)] for each in self.matrices(psi)))


def _pair(matrix: Array, i: int, j: int, value: float) -> None:
    matrix[i, j] += value
    matrix[j, i] += value


def _tension(mass: float, r: Array, dr: float) -> Array:
    """∫ from r to the tip of m r dr."""
    return np.asarray(mass * np.cumsum((r * dr)[::-1])[::-1], dtype=np.float64)


def state_matrix(M: Array, D: Array, K: Array) -> Array:
    """[[0, 1], [−M⁻¹K, −M⁻¹D]]."""
    n = len(M)
    lower = np.hstack([-np.linalg.solve(M, K), -np.linalg.solve(M, D)])
    return np.asarray(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]), dtype=np.float64)


NAMES = (
    ("1st tower fore-aft bending mode DOF", "DOF_TFA1", "m"),
    ("1st tower side-to-side bending mode DOF", "DOF_TSS1", "m"),
    ("Nacelle yaw DOF", "DOF_Yaw", "rad"),
    ("Variable speed generator DOF", "DOF_GeAz", "rad"),
    ("Drivetrain rotational-flexibility DOF", "DOF_DrTr", "rad"),
    *((f"1st flapwise bending-mode DOF of blade {b}", f"DOF_BF({b},1)", "m") for b in (1, 2, 3)),
    *((f"1st edgewise bending-mode DOF of blade {b}", f"DOF_BE({b},1)", "m") for b in (1, 2, 3)),
    *((f"2nd flapwise bending-mode DOF of blade {b}", f"DOF_BF({b},2)", "m") for b in (1, 2, 3)),
)


@dataclass(frozen=True)
class Row:
    """A row of the table of states: description, flag, operating point and its derivative."""

    text: str
    rotating: bool
    value: float = 0.0
    slope: float = 0.0


@dataclass(frozen=True)
class Lin:
    """What is printed in a ``.lin`` file."""

    azimuth: float
    omega: float
    rows: tuple[Row, ...]
    A: Array = field(repr=False)
    version: str = "v3.5.3"
    wind: float = 0.0
    decimals: int = 3
    derivative_texts: tuple[str, ...] | None = None
    states: str | None = None

    def text(self) -> str:
        """The text of the file."""
        n = len(self.rows)
        number = f"{{:{self.decimals + 10}.{self.decimals}E}}".format
        head = [
            "",
            "Linearized model: Predictions were generated on 01-Jan-2025 at 00:00:00 using OpenFAST, compiled as a 64-bit "
            f"application using double precision at commit {self.version}",
            " linked with  NWTC Subroutine Library; ElastoDyn; BeamDyn",
            "",
            "Description from the FAST input file: a machine by formula",
            "",
            "Simulation information:",
            "   Simulation time:                   100.0000 s",
            f"   Rotor Speed:                      {self.omega:9.4f} rad/s",
            f"   Azimuth:                          {self.azimuth:9.4f} rad",
            f"   Wind Speed:                       {self.wind:9.4f} m/s",
            f"   Number of continuous states:      {self.states or n:>5}",
            "   Number of discrete states:           0",
            "   Number of constraint states:         0",
            "   Number of inputs:                    0",
            "   Number of outputs:                   0",
            "   Jacobians included in this file?    No",
            "",
        ]
        columns = (
            "   Row/Column Operating Point                     Rotating Frame? Derivative Order Description",
            "   ---------- ---------------                     --------------- ---------------- -----------",
        )

        def table(values: list[float], texts: list[str]) -> list[str]:
            return [
                f"   {k + 1:8d} {value:12.3E}                                 {'T' if row.rotating else 'F'}"
                f"               2         {text}"
                for k, (value, row, text) in enumerate(zip(values, self.rows, texts, strict=True))
            ]

        texts = [row.text for row in self.rows]
        derivatives = list(self.derivative_texts or (f"First time derivative of {t}/s" for t in texts))
        return "\n".join(
            [
                *head,
                "Order of continuous states:",
                *columns,
                *table([row.value for row in self.rows], texts),
                "",
                "Order of continuous state derivatives:",
                *columns,
                *table([row.slope for row in self.rows], derivatives),
                "",
                "",
                "Linearized state matrices:",
                "",
                f"A: {n} x {n}",
                *("".join(number(value) for value in row) for row in self.A),
                "",
            ]
        )


def elastodyn(machine: Machine, psi: float, **options: object) -> Lin:
    """The file of a machine at an azimuth, about a periodic operating point."""
    o = machine.omega
    value, slope, acceleration = (np.zeros(14) for _ in range(3))
    value[3], slope[3] = psi + 1.5 * np.pi, o
    value[0] = 0.2
    for b in range(3):
        a = psi + 2 * np.pi * b / 3
        for k, (mean, wave) in {5: (3.0, 0.1), 8: (0.1, 0.4), 11: (0.05, 0.02)}.items():
            value[k + b] = mean + wave * np.cos(a)
            slope[k + b] = -wave * o * np.sin(a)
            acceleration[k + b] = -wave * o**2 * np.cos(a)
    rows = [
        Row(f"ED {name} (internal DOF index = {dof}), {unit}", "blade" in name, float(value[k]), float(slope[k]))
        for k, (name, dof, unit) in enumerate(NAMES)
    ]
    rates = [
        Row(
            f"ED First time derivative of {name} (internal DOF index = {dof}), {unit}/s",
            "blade" in name,
            float(slope[k]),
            float(acceleration[k]),
        )
        for k, (name, dof, unit) in enumerate(NAMES)
    ]
    out = Lin(psi % (2 * np.pi), o, (*rows, *rates), machine.A(psi))
    return replace(out, **options)  # pyright: ignore[reportArgumentType]


def without(lin: Lin, *words: str) -> Lin:
    """The file without the states whose descriptions contain one of the words."""
    keep = [k for k, row in enumerate(lin.rows) if not any(word in row.text for word in words)]
    return replace(lin, rows=tuple(lin.rows[k] for k in keep), A=lin.A[np.ix_(keep, keep)])


@dataclass(frozen=True)
class NodeMachine:
    """Three blades of point masses at beam nodes, as BeamDyn's, on a tower; the generator is locked.

    The X axis of a blade is downwind, Z along the blade; the rotor turns about X, so that nodes move along −Y.
    """

    omega: float = 1.2
    radius: float = 60.0
    nodes: int = 3
    mass: float = 250.0
    rotary: float = 50.0
    EI: tuple[float, float] = (1.5e9, 4e9)
    EA: float = 3e9
    GJ: float = 1e9
    nacelle: float = 350e3
    tower: tuple[float, float] = (0.34, 0.33)
    damping: float = 0.002

    def matrices(self, psi: float) -> tuple[Array, Array, Array]:
        """M, the factor of q̇ and the factor of q; two tower displacements, then six for each node of each blade."""
        o, n = self.omega, self.nodes
        size = 2 + 18 * n
        M, dM, H, dH, K = (np.zeros((size, size)) for _ in range(5))
        length = self.radius / n
        node_mass = np.full(n, self.mass * length)
        node_mass[-1] /= 2
        r = length * np.arange(1, n + 1)
        total = self.nacelle + 3 * float(node_mass.sum())
        M[0, 0] = M[1, 1] = total
        K[0, 0], K[1, 1] = ((2 * np.pi * f) ** 2 * total for f in self.tower)
        beam = self._beam(length)
        tension = np.array([o**2 * float((node_mass * r)[k:].sum()) for k in range(n)])
        spin = np.array([[0.0, 0, 0], [0, 0, -o], [0, o, 0]])
        for b in range(3):
            a = psi + 2 * np.pi * b / 3
            side = np.array([0.0, -np.cos(a), np.sin(a)])
            turned = np.array([0.0, np.sin(a), np.cos(a)])
            first = 2 + 6 * n * b
            for k in range(n):
                i = first + 6 * k
                u, t = slice(i, i + 3), slice(i + 3, i + 6)
                m = node_mass[k]
                M[u, u], M[t, t] = m * np.eye(3), self.rotary * m * np.eye(3)
                M[0, i] = M[i, 0] = m
                M[1, u] = M[u, 1] = m * side
                dM[1, u] = dM[u, 1] = m * turned
                H[u, u] = m * spin
                H[1, u] = m * side @ spin
                dH[1, u] = m * turned @ spin
                K[u, u] -= m * spin.T @ spin
                # the element from the node below, of which the first is the root
                where = [i - 6 + j for j in range(12)] if k else [*range(first - 6, first), *range(i, i + 6)]
                part = beam.copy()
                for axis in (0, 1):
                    stretch = np.zeros(12)
                    stretch[axis], stretch[6 + axis] = -1.0, 1.0
                    part += tension[k] / length * np.outer(stretch, stretch)
                use = slice(0 if k else 6, 12)
                K[np.ix_(where[use], where[use])] += part[use, use]
        C = self.damping * np.diag(np.diag(K))
        C[2:, 2:] = self.damping * 0.5 * (K + K.T)[2:, 2:]
        return M, o * dM + H - H.T + C, K + o * dH

    def _beam(self, length: float) -> Array:
        """Stiffness of an Euler–Bernoulli element; displacements X, Y, Z and rotations of both ends, axis Z."""
        K = np.zeros((12, 12))
        for axis, turn, EI, sign in ((0, 4, self.EI[0], 1.0), (1, 3, self.EI[1], -1.0)):
            k = (
                EI
                / length**3
                * np.array(
                    [
                        [12, 6 * length, -12, 6 * length],
                        [6 * length, 4 * length**2, -6 * length, 2 * length**2],
                        [-12, -6 * length, 12, -6 * length],
                        [6 * length, 2 * length**2, -6 * length, 4 * length**2],
                    ]
                )
            )
            signs = np.diag([1, sign, 1, sign])
            at = [axis, turn, 6 + axis, 6 + turn]
            K[np.ix_(at, at)] += signs @ k @ signs
        for axis, stiff in ((2, self.EA), (5, self.GJ)):
            at = [axis, 6 + axis]
            K[np.ix_(at, at)] += stiff / length * np.array([[1, -1], [-1, 1]])
        return K

    def A(self, psi: float, frozen: bool = False) -> Array:
        """State matrix; with ``frozen`` the nodes' states are in the frame that the blade has at this instant."""
        A = state_matrix(*self.matrices(psi))
        if not frozen:
            return A
        half = len(A) // 2
        spin = np.array([[0.0, 0, 0], [0, 0, -self.omega], [0, self.omega, 0]])
        S, turning = np.eye(len(A)), np.zeros_like(A)
        for i in range(2, half, 3):
            q, v = slice(i, i + 3), slice(half + i, half + i + 3)
            S[v, q] = spin
            turning[q, q] = turning[v, v] = spin
        return S @ (A) @ np.linalg.inv(S) + turning


def beamdyn(machine: NodeMachine, psi: float, frozen: bool = False, **options: object) -> Lin:
    """The file of a machine with BeamDyn's nodes at an azimuth."""
    o, n = machine.omega, machine.nodes
    names = [(f"ED {name} (internal DOF index = {dof}), ", "m", False, 0.0) for name, dof, _ in NAMES[:2]]
    rates = [
        (f"ED First time derivative of {name} (internal DOF index = {dof}), ", "m/s", False, 0.0)
        for name, dof, _ in NAMES[:2]
    ]
    order = f"(number of elements = 1; element order = {n})"
    for b in (1, 2, 3):
        for node in range(n):
            speed = {"translational Y": -o * machine.radius * (node + 1) / n, "rotational X": o}
            for kind, unit in (("translational", "m"), ("rotational", "rad")):
                for axis in "XYZ":
                    tail = f"finite element node {node + 2} {order} {kind} displacement in {axis}, "
                    names.append((f"BD_{b} {tail}", unit, True, 0.0))
                    rates.append(
                        (f"BD_{b} First time derivative of {tail}", f"{unit}/s", True, speed.get(f"{kind} {axis}", 0.0))
                    )
    rows = tuple(Row(text + unit, flag, value) for text, unit, flag, value in (*names, *rates))
    out = Lin(psi % (2 * np.pi), o, rows, machine.A(psi, frozen), decimals=6)
    return replace(out, **options)  # pyright: ignore[reportArgumentType]
