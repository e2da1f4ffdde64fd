// Strain of one element and its derivatives: what both measures of measures.py have in common.
#pragma once

#include "../space/rigid.hpp"

namespace southwell {

// Strain laws of the elements, one after the other; see measures.StrainLaw.
struct StrainLaws {
    bool body_fixed;
    const Pose* undeformed;
    const Matrix6* shortening;
    const Matrix6* mean;
    const Matrix<6, 12>* slope;
    const Vector6* eta;
};

// ε, E = ∂ε/∂(ρ, β) and, of the corotational measure only, J = ∂ε/∂(η, β) and ``inv_magnus`` = (1 + ad(A δ) B_δ/12)⁻¹.
struct Strain {
    Vector6 strain;
    Matrix<6, 12> rate, J;
    Matrix6 inv_magnus;
};

// Where an element is: the pose of b in a, its logarithm η, and the inverse of the tangent at η.
struct RelativePose {
    Pose x;
    Vector6 eta;
    Matrix6 inv_tangent;

    explicit RelativePose(const Pose& pose) : x(pose), eta(log(pose)), inv_tangent(tangent_inverse(eta)) {}
};

// Add ∂(tangent⁻ᵀ(η) f)/∂ρ of a constant force f conjugate to η to the ρ block of a stiffness.
inline void add_tangent_variation(const RelativePose& at, const Vector6& conjugate, Matrix<12, 12>& out) {
    add(transpose_derivative(INVERSE, at.eta, conjugate) * at.inv_tangent, 0, 0, out);
}

}  // namespace southwell
