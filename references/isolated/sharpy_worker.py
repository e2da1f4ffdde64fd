"""SHARPy's beam about its steady rotating state; run by ``answer`` in SHARPy's environment.

Request: ``nodes`` (n, 3) along the beam, in axes that rotate at ``omega`` (rad/s) about z through their origin;
``rotations`` (e, 3, 3), the sections' rotation vectors at the nodes of each three-node element, in SHARPy's order (ends,
then middle); ``stiffness`` and ``mass`` (e, 6, 6); ``tip`` (6, 6). Answer: ``M``, ``C``, ``K`` (d, d) about the steady
state and its coordinates ``q`` (d,), little-endian doubles in base64: position and rotation vector of every node except
the first, which is clamped.
"""

import base64

import numpy as np

STEPS, SMALL = 60, 1e-10


def solve(request):
    """The steady state by Newton's method, with load steps if that fails, and the matrices there."""
    import sharpy.structure.utils.xbeamlib as xbeam  # pyright: ignore[reportMissingImports]

    beam = built(request)
    state = beam.timestep_info[0]
    d = beam.num_dof.value
    state.q = np.zeros(d + 10, order="F")
    state.dqdt[:] = 0.0
    state.dqddt[:] = 0.0
    xbeam.cbeam3_solv_disp2state(beam, state)
    q, reached, step = state.q[:d].copy(), 0.0, 1.0
    length = np.ptp(np.array(request["nodes"]), axis=0).max()
    size = np.tile(np.repeat([length, 1.0], 3), d // 6)
    while reached < 1.0:
        load = min(1.0, reached + step)
        balanced = newton(xbeam, beam, state, request["omega"] * load**0.5, q, size)
        if balanced is not None:
            q, reached = balanced, load
        elif step > 2.0**-6:
            step /= 2
        else:
            return {"error": f"no steady state above {reached:.0%} of the centrifugal load"}
    M, C, K, _ = assembled(xbeam, beam, state, request["omega"], q)
    return {name: packed(value) for name, value in (("M", M), ("C", C), ("K", K), ("q", q))}


def newton(xbeam, beam, state, omega, start, size):
    """Coordinates of the equilibrium; None if Newton's method does not converge."""
    q, last = start.copy(), np.inf
    for _ in range(STEPS):
        _, _, K, Q = assembled(xbeam, beam, state, omega, q)
        change = -np.linalg.solve(K, Q)
        q = q + change
        largest = np.abs(change / size).max()
        if not largest < 1.0:
            return None
        if largest < SMALL or 0.1 * last < largest < 1e-7:  # converged, or down to rounding
            return q
        last = largest
    return None


def assembled(xbeam, beam, state, omega, q):
    """M, C, K and the unbalanced forces at ``q``."""
    settings = {
        "dt": 1.0,
        "print_info": False,
        "max_iterations": 50,
        "num_load_steps": 1,
        "delta_curved": 1e-9,
        "min_delta": 1e-9,
        "abs_threshold": 1e-12,
        "newmark_damp": 0.0,
        "gravity_on": False,
        "gravity": 0.0,
        "gravity_dir": [0.0, 0.0, 1.0],
    }
    state.q[: len(q)] = q
    state.for_vel[:] = [0.0, 0.0, 0.0, 0.0, 0.0, omega]
    xbeam.cbeam3_solv_state2disp(beam, state)
    return xbeam.cbeam3_asbly_dynamic(beam, state, settings)


def built(request):
    """SHARPy's beam with its first node clamped.

    The sections' rotations are set to those of the request, because those of SHARPy 2.4 are wrong: it computes tangents
    in the order of the nodes along an element (``algebra.tangent_vector``) but reads them in the order of the
    connectivities, which exchanges middle and end of a curved element.
    """
    from sharpy.structure.models.beam import Beam  # pyright: ignore[reportMissingImports]

    nodes, rotations = np.array(request["nodes"]), np.array(request["rotations"])
    n, e = len(nodes), len(rotations)
    supports = np.zeros(n, dtype=int)
    supports[0], supports[-1] = 1, -1
    data = {
        "num_node_elem": 3,
        "num_node": n,
        "num_elem": e,
        "boundary_conditions": supports,
        "coordinates": nodes,
        "connectivities": np.array([[2 * k, 2 * k + 2, 2 * k + 1] for k in range(e)]),
        "elem_stiffness": np.arange(e),
        "stiffness_db": np.array(request["stiffness"]),
        "elem_mass": np.arange(e),
        "mass_db": np.array(request["mass"]),
        "frame_of_reference_delta": across(rotations),
        "structural_twist": np.zeros((e, 3)),
        "app_forces": np.zeros((n, 6)),
        "beam_number": np.zeros(e, dtype=int),
        "body_number": np.zeros(e, dtype=int),
        "lumped_mass_mat": np.array([request["tip"]]),
        "lumped_mass_mat_nodes": np.array([n - 1]),
    }
    beam = Beam()
    beam.generate(data, {"orientation": np.array([1.0, 0.0, 0.0, 0.0]), "for_pos": np.zeros(3), "unsteady": False})
    for info in (beam.ini_info, beam.timestep_info[0]):
        info.psi[:] = rotations
    beam.fortran["psi_ini"][:] = rotations
    return beam


def across(rotations):
    """The sections' y (e, 3, 3)."""
    from sharpy.utils.algebra import crv2rotation  # pyright: ignore[reportMissingImports]

    return np.array([[crv2rotation(psi)[:, 1] for psi in element] for element in rotations])


def packed(array):
    """Encode doubles as base64 text."""
    return base64.b64encode(np.ascontiguousarray(array, dtype="<f8").tobytes()).decode()
