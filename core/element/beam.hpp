// Residual, M, C and K of a beam element on (ξ_a, ρ, β): see beams.py for the theory.
#pragma once

#include <cstdint>

#include "body_fixed.hpp"
#include "corotational.hpp"
#include "inertia.hpp"

namespace southwell {

// Elements, one after the other; see beams.Beams. The points of element k are first[k] … first[k + 1] − 1; ``inner``: there are
// points, so that every element has internal coordinates.
struct Beams {
    int elements;
    bool inner;
    const std::int64_t* first;
    StrainLaws law;
    const Matrix6* stiffness;
    const Vector6* preload;
    const Vector6* inner_preload;
    const Vector6* zeta0;
    const Matrix6* shape;
    const Matrix6* bubble;
    const Matrix6* mass;
    const Vector3* force;
};

// What surrounds an element, in a's axes: the rotating frame's twist, gravity as a twist, and the frame's axes.
struct Surroundings {
    Vector6 frame, fall;
    Matrix<3, 3> axes;
};

// One element's force and matrices on (ξ_a, ρ, β); the part of K on ρ alone is ``spring``.
struct ElementPencil {
    Vector<18> f{};
    Matrix<18, 18> M = Matrix<18, 18>::zero(), C = M, K = M;
    Matrix6 spring = Matrix6::zero();
};

inline Strain strain(const StrainLaws& law, int k, const RelativePose& at, const Vector6& beta) {
    return law.body_fixed ? body_fixed::strain(law, k, at) : corotational::strain(law, k, at, beta);
}

inline void add_curvature(const StrainLaws& law, int k, const RelativePose& at, const Strain& e, const Vector6& s,
                          const Vector6& on_eta, Matrix<12, 12>& out) {
    if (law.body_fixed)
        body_fixed::add_curvature(law, k, at, e, s, on_eta, out);
    else
        corotational::add_curvature(law, k, at, e, s, on_eta, out);
}

// Add a stiffness on (ρ, β): its ρ block to ``spring``, the other blocks to K.
inline void add_on_strain(const Matrix<12, 12>& k, ElementPencil& out) {
    add(block<6, 6>(k, 0, 0), 0, 0, out.spring);
    add(block<6, 6>(k, 0, 6), 6, 12, out.K);
    add(block<6, 12>(k, 6, 0), 12, 6, out.K);
}

// Sum of Uᵀ m U over points with twists U = (1, H) from (ξ_a, ρ, β), for symmetric or skew m: its upper blocks.
struct OnTwists {
    Matrix6 m = Matrix6::zero();
    Matrix<6, 12> by_H = Matrix<6, 12>::zero();
    Matrix<12, 12> on_H = Matrix<12, 12>::zero();

    void add_point(const Matrix6& of_point, const Matrix<6, 12>& H) {
        const Matrix<6, 12> product = of_point * H;
        add(of_point, 0, 0, m);
        add(product, 0, 0, by_H);
        add_transposed_times(H, product, on_H);
    }

    // Add the sum to ``out``; ``sign`` is 1 for symmetric m, −1 for skew ones.
    void add_to(double sign, Matrix<18, 18>& out) const {
        add(m, 0, 0, out);
        add(by_H, 0, 6, out);
        add(sign * transposed(by_H), 6, 0, out);
        add(on_H, 6, 6, out);
    }
};

// Apply ``hold_components`` to g and K about a's origin, for a point at the pose ``x`` in a.
inline void hold_components_at(const Pose& x, const Matrix6& to_point, const Vector3& force, bool follow,
                               Inertial& at_a) {
    Vector6 g = transposed_times(adjoint(x), at_a.g);
    Matrix6 K = Matrix6::zero();
    hold_components(force, follow, g, K);
    at_a.g = transposed_times(to_point, g);
    add(congruence(to_point, K), 0, 0, at_a.K);
}

// Position ζ of a point in a's frame, its slope ∂ζ/∂(ρ, β), the tangent T(ζ), and H = T ∂ζ/∂(ρ, β).
struct CarriedPoint {
    Vector6 zeta;
    Matrix<6, 12> slope;
    Matrix6 T;
    Matrix<6, 12> H;

    // ζ = ζ₀ + L (η − η₀) + bubble β
    CarriedPoint(const Beams& beams, std::int64_t point, const Vector6& change, const Matrix6& inv_tangent,
                 const Vector6& beta)
        : zeta(beams.zeta0[point] + beams.shape[point] * change + beams.bubble[point] * beta) {
        put(beams.shape[point] * inv_tangent, 0, 0, slope);
        put(beams.bubble[point], 0, 6, slope);
        T = tangent(zeta);
        H = T * slope;
    }
};

// Add the inertia of the points, and the force conjugate to η to ``on_eta``.
//
// A wrench g at a point with twist ξ_a + H (ρ, β) acts as g on ξ_a and as Hᵀ g on (ρ, β). All wrenches are about a's origin in
// a's axes, where all points of an element are carried at the same twist.
inline void add_inertia(const Beams& beams, int k, const RelativePose& at, const Vector6& beta,
                        const Surroundings& around, bool geometric, bool loaded, Vector6& on_eta, ElementPencil& out) {
    const Matrix6 ad_frame = ad(around.frame);
    const Vector6 change = at.eta - beams.law.eta[k];
    OnTwists mass, coriolis;
    Matrix<12, 12> on_strain = Matrix<12, 12>::zero();  // stiffness on (ρ, β)
    for (std::int64_t p = beams.first[k]; p < beams.first[k + 1]; ++p) {
        const CarriedPoint point(beams, p, change, at.inv_tangent, beta);
        const Pose x = exp(point.zeta), from_a = inverse(x);
        const Matrix6 to_point = adjoint(from_a), M = congruence(to_point, beams.mass[p]);
        Inertial inertial = carried(M, around.frame, ad_frame, around.fall);
        if (loaded || !geometric) {
            const Vector3 load = (block<3, 3>(from_a, 0, 0) * around.axes) * beams.force[p];
            hold_components_at(x, to_point, load, geometric, inertial);
        }
        const Vector<12> force = transposed_times(point.H, inertial.g);
        for (int i = 0; i < 6; ++i) out.f[i] += inertial.g[i];
        for (int i = 0; i < 12; ++i) out.f[6 + i] += force[i];
        mass.add_point(M, point.H);
        coriolis.add_point(inertial.C, point.H);
        add(inertial.K, 0, 0, out.K);
        add(transposed_times(point.H, inertial.K), 6, 0, out.K);
        Matrix6 K = inertial.K;
        Matrix6 turning = Matrix6::zero();
        if (geometric) {
            // D_a g = D_point g − coadjoint(g) H (ρ, β), and ∂(Hᵀg)/∂(ρ, β) is a spring between the ends and β
            K = K - coadjoint(inertial.g);
            turning = transpose_derivative(TANGENT, point.zeta, inertial.g);
            on_eta = on_eta + transposed_times(beams.shape[p], transposed_times(point.T, inertial.g));
        }
        add(K * point.H, 0, 6, out.K);
        add(congruence(point.T, K), 0, 0, turning);  // H = T ∂ζ/∂(ρ, β)
        add_transposed_times(point.slope, turning * point.slope, on_strain);
    }
    mass.add_to(1.0, out.M);
    coriolis.add_to(-1.0, out.C);
    add_on_strain(on_strain, out);
    for (int i = 0; i < 6; ++i) {
        out.f[12 + i] += beams.inner_preload[k][i] + beta[i];
        out.K[12 + i][12 + i] += 1.0;
    }
}

// Add the elastic force on (ρ, β) and its material and geometric stiffness.
inline void add_elastic(const Beams& beams, int k, const RelativePose& at, const Vector6& beta, bool geometric,
                        const Vector6& on_eta, ElementPencil& out) {
    const Strain e = strain(beams.law, k, at, beta);
    const Vector6 s = beams.stiffness[k] * e.strain + beams.preload[k];
    Matrix<12, 12> K = congruence(e.rate, beams.stiffness[k]);
    if (geometric) add_curvature(beams.law, k, at, e, s, on_eta, K);
    const Vector<12> force = transposed_times(e.rate, s);
    for (int i = 0; i < 12; ++i) out.f[6 + i] += force[i];
    add_on_strain(K, out);
    if (!geometric) return;
    Vector6 on_b;
    for (int i = 0; i < 6; ++i) on_b[i] = out.f[6 + i];
    const Matrix6 crossed = coadjoint(on_b);  // −ρ ×* (wrench on b), on b alone
    add(crossed, 0, 6, out.K);
    add(crossed, 6, 6, out.K);
}

// The pencil of element k. ``loaded``: its points bear loads.
inline ElementPencil element_pencil(const Beams& beams, int k, const Pose& x, const Vector6& beta,
                                    const Surroundings& around, bool geometric, bool loaded) {
    ElementPencil out;
    Vector6 on_eta{};
    const RelativePose at(x);
    if (beams.inner) add_inertia(beams, k, at, beta, around, geometric, loaded, on_eta, out);
    add_elastic(beams, k, at, beta, geometric, on_eta, out);
    return out;
}

}  // namespace southwell
