// The body-fixed strain measure of one element: displacement and Cardan angles in the axes of frame a.
//
// The angles are (x, y, z), R = R_x(α) R_y(β) R_z(γ).
#pragma once

#include "strain.hpp"

namespace southwell::body_fixed {

// (α̇, β̇, γ̇) from the angular velocity in the fixed axes.
inline Matrix<3, 3> rate(const Vector3& angles) {
    const double sa = std::sin(angles[0]), ca = std::cos(angles[0]);
    const double sb = std::sin(angles[1]), cb = std::cos(angles[1]);
    return {{{1.0, sa * sb / cb, -ca * sb / cb}, {0.0, ca, sa}, {0.0, -sa / cb, ca / cb}}};
}

// The derivative of rate(θ)ᵀ m with respect to θ at constant m.
inline Matrix<3, 3> rate_transpose_derivative(const Vector3& angles, const Vector3& m) {
    const double sa = std::sin(angles[0]), ca = std::cos(angles[0]);
    const double sb = std::sin(angles[1]), cb = std::cos(angles[1]);
    const double lever = (m[0] * sb - m[2]) / cb;         // (Aᵀm)_y = sα lever + cα m₁, (Aᵀm)_z = −cα lever + sα m₁
    const double slope = (m[0] - m[2] * sb) / (cb * cb);  // ∂lever/∂β
    return {{{0.0, 0.0, 0.0}, {ca * lever - sa * m[1], sa * slope, 0.0}, {sa * lever + ca * m[1], -ca * slope, 0.0}}};
}

// Strain and E of an element from its undeformed pose; the columns of β are zero.
inline Strain strain(const StrainLaws& law, int k, const RelativePose& at) {
    Strain out;
    const Pose inv_undeformed = inverse(law.undeformed[k]), y = inv_undeformed * at.x;
    const Vector3 angles{std::atan2(-y[1][2], y[2][2]), std::asin(std::clamp(y[0][2], -1.0, 1.0)),
                         std::atan2(-y[0][1], y[0][0])};
    for (int i = 0; i < 3; ++i) out.strain[i] = y[i][3], out.strain[3 + i] = angles[i];
    Matrix6 by_twist = Matrix6::unit();
    put(-1.0 * skew(position(y)), 0, 3, by_twist);
    put(rate(angles), 3, 3, by_twist);
    out.rate = Matrix<6, 12>::zero();
    put(by_twist * adjoint(inv_undeformed), 0, 0, out.rate);  // the adjoint brings ρ to the undeformed frame
    return out;
}

// Add the geometric stiffness of constant forces ``s`` and ``on_eta``, conjugate to ε and η.
inline void add_curvature(const StrainLaws& law, int k, const RelativePose& at, const Strain& e, const Vector6& s,
                          const Vector6& on_eta, Matrix<12, 12>& out) {
    Matrix6 variation = Matrix6::zero();
    put(-1.0 * skew(linear(s)), 3, 0, variation);
    put(rate_transpose_derivative(angular(e.strain), angular(s)), 3, 3, variation);
    const Matrix6 local = adjoint(inverse(law.undeformed[k]));
    add(transposed_times(local, variation * block<6, 6>(e.rate, 0, 0)), 0, 0, out);
    add_tangent_variation(at, on_eta, out);
}

}  // namespace southwell::body_fixed
