// A mode's displacement and rotation about x at points of the elements; see mode_shapes.py.
#pragma once

#include <cstdint>

#include "../element/strain.hpp"
#include "matrices.hpp"

namespace southwell {

// Points of the elements that bear no mass; see beams.Points.
struct Samples {
    int count;
    const std::int64_t* element;
    const Vector6* zeta0;
    const Matrix6* shape;
    const Matrix6* bubble;
};

// Displacement and rotation about x of a point, in the hub's axes, from (ξ_a, ξ_b, β) in the nodes'.
//
// ``a`` and ``b`` are the poses of the element's nodes, ``corner`` that of its end in the frame of b, and ``eta0`` the logarithm of the
// undeformed element.
inline Matrix<4, 18> sampling_matrix(const Samples& of, int point, const Pose& a, const Pose& b, const Pose& corner,
                                     const Vector6& eta0, const Vector6& beta) {
    const Pose between = inverse(a) * b;
    const Vector6 eta = log(between * corner);
    const Vector6 zeta = of.zeta0[point] + of.shape[point] * (eta - eta0) + of.bubble[point] * beta;
    const Matrix6 T = tangent(zeta), H = T * of.shape[point] * tangent_inverse(eta);  // see beam.hpp
    Matrix<6, 18> twist = Matrix<6, 18>::zero();
    put(Matrix6::unit() - H, 0, 0, twist);
    put(H * adjoint(between), 0, 6, twist);
    put(T * of.bubble[point], 0, 12, twist);
    const auto angular = block<3, 18>(twist, 3, 0);
    const auto velocity = block<3, 18>(twist, 0, 0) - skew(position(exp(zeta))) * angular;  // v + w × p
    Matrix<4, 18> out;
    put(block<3, 3>(a, 0, 0) * velocity, 0, 0, out);
    put(block<1, 3>(a, 0, 0) * angular, 3, 0, out);
    return out;
}

// Sample a mode's twists ξ_b and β, of d numbers an element, at a point of element k, which begins at node a; ``out`` has four
// numbers, ``step`` apart.
inline void sample(const Matrix<4, 18>& sampling, const double* twists, int d, int k, int a, double* out, int step) {
    Vector<18> u{};
    for (int i = 0; i < 6; ++i) {
        u[i] = a > 0 ? twists[d * (a - 1) + i] : 0.0;  // node 0 does not move
        u[6 + i] = twists[d * k + i];
        if (d > 6) u[12 + i] = twists[d * k + 6 + i];
    }
    const Vector<4> motion = sampling * u;
    for (int i = 0; i < 4; ++i) out[step * i] = motion[i];
}

}  // namespace southwell
