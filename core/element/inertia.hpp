// Inertial wrench of a body in steady rotation, and its linearisation.
//
// With V the frame's constant twist and M a body's 6×6 inertia, d/dt(MY) = M Ẏ + Y ×* M Y. For a small twist ξ(t) of the body
// relative to the rotating frame this gives, about the steady motion Y = V,
//
//     δg = M ξ̈ + C ξ̇ + K ξ,   C = M V× − V×ᵀ M − coadjoint(MV)  (Coriolis, skew),
//                              K = −V×ᵀ M V× − coadjoint(MV) V×   (centrifugal),
//
// in components that follow the body (Featherstone, Rigid Body Dynamics Algorithms, 2008, eq. 2.72, linearised).
#pragma once

#include "../space/rigid.hpp"

namespace southwell {

// Wrench, C and K of one inertia.
struct Inertial {
    Vector6 g;
    Matrix6 C, K;
};

// An inertia carried at the twist ``frame``, components following the body. Axes and origin are arbitrary, but the same for all.
//
// ``ad_frame`` is ad(frame), and ``fall`` the acceleration of free fall as a twist (zero angular part), turning with the frame.
inline Inertial carried(const Matrix6& mass, const Vector6& frame, const Matrix6& ad_frame, const Vector6& fall) {
    Inertial out;
    const Vector6 momentum = mass * frame, of_frame = transposed_times(ad_frame, momentum), weight = mass * fall;
    const Matrix6 by_frame = mass * ad_frame;
    Matrix6 transport = coadjoint(momentum);
    add(transposed(by_frame), 0, 0, transport);
    for (int i = 0; i < 6; ++i) out.g[i] = -of_frame[i] - weight[i];
    out.C = by_frame - transport;
    out.K = -1.0 * (transport * ad_frame);
    for (int i = 0; i < 6; ++i) {  // M fall×, whose angular part is zero
        out.K[i][3] -= mass[i][1] * fall[2] - mass[i][2] * fall[1];
        out.K[i][4] -= mass[i][2] * fall[0] - mass[i][0] * fall[2];
        out.K[i][5] -= mass[i][0] * fall[1] - mass[i][1] * fall[0];
    }
    return out;
}

// Add a steady force at the body's origin, fixed in the rotating frame, to g and K in the body's axes.
//
// Without ``follow`` all components of g stay fixed in the frame instead of turning with the body: an analysis without geometric
// stiffness.
inline void hold_components(const Vector3& force, bool follow, Vector6& g, Matrix6& K) {
    for (int i = 0; i < 3; ++i) g[i] -= force[i];
    add(-1.0 * skew(force), 0, 3, K);
    if (follow) return;
    add(-1.0 * skew(linear(g)), 0, 3, K);
    add(-1.0 * skew(angular(g)), 3, 3, K);
}

}  // namespace southwell
