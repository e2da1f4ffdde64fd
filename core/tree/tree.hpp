// The assembly of a tree's elements and nodes; see pencil.py.
#pragma once

#include "../element/beam.hpp"
#include "matrices.hpp"

namespace southwell {

// The frame's twist, gravity and the hub's axes, in the axes of a node at ``pose`` in the hub's axes.
inline Surroundings surroundings(const Pose& pose, double omega, const Vector3& gravity) {
    const Pose to_node = inverse(pose);
    const Matrix6 twist_to_node = adjoint(to_node);
    Surroundings out{{}, {}, block<3, 3>(to_node, 0, 0)};
    const Vector3 fall = out.axes * gravity;
    for (int i = 0; i < 6; ++i) out.frame[i] = omega * twist_to_node[i][5];
    for (int i = 0; i < 3; ++i) out.fall[i] = fall[i];
    return out;
}

// A node's wrench, C and K from its lumped mass and the force on it, in its own axes.
inline Inertial node_pencil(const Matrix6& lump, const Vector3& force, const Surroundings& around, bool geometric) {
    Inertial out = carried(lump, around.frame, ad(around.frame), around.fall);
    hold_components(around.axes * force, geometric, out.g, out.K);
    return out;
}

// Add a matrix on the twist of a node to that of the element that ends there.
template <int D>
void add_at_end(const Matrix6& to_child, const Matrix6& on_end, Matrix<D, D>& out) {
    const Matrix6 on_sum = congruence(to_child, on_end);  // on ξ_a + ρ
    for (int i = 0; i < 12; i += 6)
        for (int j = 0; j < 12; j += 6) add(on_sum, i, j, out);
}

}  // namespace southwell
