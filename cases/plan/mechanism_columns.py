"""The columns of a mechanism's case: codes that accept mechanisms, and closed forms, against core at every speed.

A mechanism has no discretisation to refine: codes solve the same equations, so the target is at rounding level, and
damping ratios must agree as closely as frequencies.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ...core import multibody as mb
from ...core.effects import ALL_EFFECTS, Effects
from ...core.mechanism.description import at_rate
from ...core.participation import numbered
from ...core.spectrum.eigen import EigenError
from ...core.tree.dynamics import reduced_mass
from ...references.protocol.description import Description
from ...references.protocol.interface import Independence, MechanismModes
from ...references.protocol.process import Failure, Limits
from ...references.protocol.worker import MechanismAnswer as Answer
from ...references.protocol.worker import mechanism_answers as answers
from ...references.theories import blade_formulae
from ..input.mechanism_schema import ClosedForm, Compare
from ..input.mechanisms import Described
from ..judge.cells import Head, Rows, empty, failed
from ..judge.pairing import LEAST_MAC
from ..judge.results import Cell
from ..judge.uncertainty import ROUNDING
from ..judge.verdict import judge, unsigned
from .column import Column, absent_work, failing_work, not_installed

_BY_HAND = Independence(
    engine="closed form",
    theory="second-order Lagrangian by hand",
    rotation="second-order Lagrangian by hand",
    sections="the case's closed_form.parameters",
    eigensolver="the adapters' own, with damping",
)

Array = NDArray[np.float64]
References = dict[Effects, list["Reference | Failure"]]
Solve = Callable[[Sequence[mb.Mechanism], Sequence[float]], list[Answer]]
Work = Callable[[Sequence[tuple[float, Any]]], Rows]


@dataclass(frozen=True)
class Reference:
    """Core's modes at one speed, named by the joint that moves most; ``weight`` (k, k): mass matrix over the coordinates."""

    modes: MechanismModes
    damping: Array
    names: tuple[str, ...]
    weight: Array


def references(described: Described, speeds: Sequence[float], count: int) -> References:
    """Core's modes at each speed; a failure where core cannot solve it, or finds fewer than the ``count`` compared modes."""
    return {ALL_EFFECTS: [_reference(described, omega, count) for omega in speeds]}


def turning(described: Described, omega: float) -> mb.Mechanism:
    """The mechanism with its rotor at ``omega`` (rad/s)."""
    return at_rate(described.mechanism, described.text.rotor, omega)


def _reference(described: Described, omega: float, count: int) -> Reference | Failure:
    independent = described.text.independent or None
    try:
        found = mb.solve(turning(described, omega), described.guess, independent=independent)
    except (mb.MechanismError, EigenError) as error:
        return Failure("no reference", f"speeds: {omega:g} rad/s: {error}")
    if len(found.values) < count:
        few = f"compare.modes: {count}: the mechanism has {len(found.values)} modes: reduce it"
        return Failure("no reference", few)
    state = found.linear.state
    weight = reduced_mass(state.kinematics, state.cartesian)
    modes = MechanismModes(found.coordinates, state.q, found.values, found.shapes)
    joints = [name.partition(".")[0] for name in found.leading]
    return Reference(modes, found.damping, numbered(joints), weight)


def columns(described: Described, compare: Compare, codes: Sequence[Description], limits: Limits) -> list[Column]:
    """A column for each code and for the closed form; ``limits`` apply to each solution by a foreign code.

    Codes that accept only blades have no column, unless there are no other codes.
    """
    name, target = described.text.name, compare.target
    out = []
    for code in [code for code in codes if code.mechanisms] or codes:
        head = Head(name, code.name, code.version or "", "same discretisation", target, code.shares)
        work = _work(head, described, compare.modes, code, limits)
        solves = code.mechanisms and not code.failure and code.version is not None
        out.append(Column(code.name, ALL_EFFECTS, head, work, code.independence, solves=solves))
    if form := described.text.closed_form:
        head = Head(name, "closed form", f"southwell {version('southwell')}", "same discretisation", target, "nothing")
        work = partial(_compared, head, described, compare.modes, partial(_formula, form))
        out.append(Column(head.code, ALL_EFFECTS, head, work, _BY_HAND))
    return out


def _work(head: Head, described: Described, count: int, code: Description, limits: Limits) -> Work:
    if code.failure:
        return failing_work(head, code.failure)
    if not code.mechanisms:
        return absent_work(head, "not applicable", "the code takes blades, not mechanisms")
    if code.version is None:
        return failing_work(head, not_installed(code))
    ask = partial(_ask, code.asked, code.version or "", described.guess, limits)
    return partial(_compared, head, described, count, ask)


def _ask(
    name: str,
    version: str,
    guess: Mapping[str, float],
    limits: Limits,
    mechanisms: Sequence[mb.Mechanism],
    _: Sequence[float],
) -> list[Answer]:
    return answers(name, mechanisms, guess, limits, version)


def _formula(form: ClosedForm, _: Sequence[mb.Mechanism], speeds: Sequence[float]) -> list[Answer]:
    try:
        return [blade_formulae.solve(form.formula, omega, form.parameters) for omega in speeds]
    except TypeError as error:
        return [Failure("refused", f"closed_form.parameters: {error}")] * len(speeds)


def _compared(
    head: Head, described: Described, count: int, solve: Solve, core: Sequence[tuple[float, Reference]]
) -> Rows:
    speeds = [omega for omega, _ in core]
    found = solve([turning(described, omega) for omega in speeds], speeds)
    rows = [cells(head, omega, r, a, count) for (omega, r), a in zip(core, found, strict=True)]
    return [cell for row in rows for cell in row], []


def cells(head: Head, omega: float, reference: Reference, answer: Answer, count: int) -> list[Cell]:
    """Cells of a code at one speed: each of core's ``count`` lowest modes with its partner by mass-weighted MAC."""
    if isinstance(answer, Failure):
        return [failed(head, omega, answer)]
    if fault := _incomplete(reference, answer):
        return [failed(head, omega, Failure("nonsense", fault))]
    likeness = alike(reference, answer)
    partners = dict(zip(*(k.tolist() for k in linear_sum_assignment(-likeness)), strict=True))
    out = []
    for i in range(count):
        mine = abs(complex(reference.modes.values[i]))
        family, _, ordinal = reference.names[i].rpartition(" ")
        which = {"mode": i + 1, "family": family, "ordinal": int(ordinal)}
        cell = replace(empty(head, omega, "fail", ""), **which, full=mine, reference=mine)
        k = partners.get(i)
        if k is None or likeness[i, k] < LEAST_MAC:
            best = f", its most similar has MAC {likeness[i].max():.2f}" if likeness.size else ""
            out.append(replace(cell, reason=f"no partner{best}"))
            continue
        value = complex(answer.values[k])
        verdict, reason = judge(abs(value) / mine - 1.0, ROUNDING, head.target)
        ratio, wanted = 0.0 - value.real / abs(value), float(reference.damping[i])
        if abs(ratio - wanted) > head.target:
            away = f"damping ratio {ratio:.9g}, core's {wanted:.9g}: more than {unsigned(head.target)} apart"
            verdict, reason = "fail", f"{reason}; {away}" if reason else away
        out.append(
            replace(
                cell,
                frequency=abs(value),
                difference=abs(value) / mine - 1.0,
                uncertainty=ROUNDING,
                verdict=verdict,
                reason=reason,
                mac=float(likeness[i, k]),
            )
        )
    return out


def _incomplete(reference: Reference, answer: MechanismModes) -> str:
    """Why an answer cannot be paired by shape or lacks modes; empty if it can be paired and is complete."""
    theirs = [reference.modes.coordinates.index(n) for n in answer.coordinates if n in reference.modes.coordinates]
    shapes, many = reference.modes.shapes, len(reference.modes.values)
    if np.linalg.matrix_rank(shapes[:, theirs]) < np.linalg.matrix_rank(shapes):
        return f"coordinates {', '.join(answer.coordinates)}: these do not distinguish the {many} modes: name all"
    highest = np.abs(reference.modes.values).max(initial=0.0)
    extra = len(answer.values) - many
    if extra > 0 and np.sum(np.abs(answer.values) <= highest * (1.0 + ROUNDING)) > many:
        return f"values: {len(answer.values)} modes, and core has {many}: are there conjugates, or spurious ones?"
    return ""


def alike(reference: Reference, answer: MechanismModes) -> Array:
    """MAC (m, k) of core's modes with a code's, over their common coordinates."""
    shared = [name for name in answer.coordinates if name in reference.modes.coordinates]
    ours = [reference.modes.coordinates.index(name) for name in shared]
    weight = reference.weight[np.ix_(ours, ours)]
    a, b = reference.modes.shapes[:, ours], answer.shapes[:, [answer.coordinates.index(name) for name in shared]]
    norms = [np.real(np.einsum("mi,ij,mj->m", x.conj(), weight, x)) for x in (a, b)]
    cross = np.abs(a.conj() @ weight @ b.T) ** 2
    size = np.outer(norms[0], norms[1])
    return np.divide(cross, size, out=np.zeros_like(size), where=size > 0)
