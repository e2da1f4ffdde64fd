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

}  // namespace southwell
