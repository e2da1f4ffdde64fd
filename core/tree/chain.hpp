// The chain's poses, and the assembly of its elements and nodes; see pencil.py and steady.py.
#pragma once

#include "../element/beam.hpp"
#include "matrices.hpp"

namespace southwell {

// The frame's twist, gravity and the hub's axes, in the axes of a node at ``pose`` in the hub's axes.
inline Surroundings surroundings(const Pose& pose, double omega, const Vector3& gravity) {
    const Pose back = inverse(pose);
    const Matrix6 to_node = adjoint(back);
    Surroundings out{{}, {}, block<3, 3>(back, 0, 0)};
    const Vector3 fall = out.axes * gravity;
    for (int i = 0; i < 6; ++i) out.frame[i] = omega * to_node[i][5];
    for (int i = 0; i < 3; ++i) out.fall[i] = fall[i];
    return out;
}

// A node's wrench, C and K from its lumped mass and the force on it, in its own axes.
inline Inertial node_pencil(const Matrix6& lump, const Vector3& force, const Surroundings& around, bool geometric) {
    Inertial out = carried(lump, around.frame, ad(around.frame), around.fall);
    hold_components(around.axes * force, geometric, out.g, out.K);
    return out;
}

// Add a matrix on the twist of the last node to that of the last element.
template <int D>
void add_at_tip(const Matrix6& back, const Matrix6& on_tip, Matrix<D, D>& out) {
    const Matrix6 on_sum = congruence(back, on_tip);  // on ξ_a + ρ
    for (int i = 0; i < 12; i += 6)
        for (int j = 0; j < 12; j += 6) add(on_sum, i, j, out);
}

// Loads on (ρ, β) from those of the elements on (ξ_a, ρ, β) and of the nodes, into rows of d numbers.
inline void gather(const double* of_elements, const Matrix6* back, const Vector6* of_nodes, int n, int d, double* out) {
    Vector6 beyond{};
    for (int k = n - 1; k >= 0; --k) {
        const double* f = of_elements + (d + 6) * k;
        beyond = transposed_times(back[k], beyond + of_nodes[k + 1]);
        for (int i = 0; i < d; ++i) out[d * k + i] = f[6 + i] + (i < 6 ? beyond[i] : 0.0);
        for (int i = 0; i < 6; ++i) beyond[i] += f[i];
    }
}

// Move the nodes 1 … n by twists in their axes, the first six of ``width`` numbers an element.
inline void displace(const double* step, int width, int n, Pose* nodes, Pose* relative) {
    Pose back = Pose::unit();
    for (int k = 0; k < n; ++k) {
        Vector6 twist;
        for (int i = 0; i < 6; ++i) twist[i] = step[width * k + i];
        const Pose change = exp(twist);
        nodes[k + 1] = nodes[k + 1] * change;
        relative[k] = back * relative[k] * change;
        back = inverse(change);
    }
}

}  // namespace southwell
