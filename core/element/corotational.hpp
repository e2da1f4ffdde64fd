// The corotational strain measure of one element; see measures.py.
#pragma once

#include "strain.hpp"

namespace southwell::corotational {

// Strain and J of element k, from (1 + ad(A δ) B_δ/12) ε = δ − ad(A δ) B_β β/12.
inline Strain strain(const StrainLaws& law, int k, const RelativePose& at, const Vector6& beta) {
    Strain out;
    const auto& slope = law.slope[k];
    const Vector6 delta = at.eta - law.eta[k], bow = law.shortening[k] * delta;
    const Matrix<6, 12> across = ad(law.mean[k] * delta) * slope;
    Vector6 r = delta;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            r[i] -= across[i][6 + j] / 12.0 * beta[j];
            out.inv_magnus[i][j] = (i == j ? 1.0 : 0.0) + across[i][j] / 12.0;
        }
    }
    for (int j = 0; j < 6; ++j) {  // G contains the axial part of Magnus' term, except that of β
        out.inv_magnus[0][j] = j == 0 ? 1.0 : 0.0;
        r[0] += delta[j] * bow[j];
    }
    invert(out.inv_magnus, 0);  // near the unit matrix
    out.strain = out.inv_magnus * r;
    Vector6 of_strain{}, of_beta{};
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            of_strain[i] += slope[i][j] * out.strain[j];
            of_beta[i] += slope[i][6 + j] * beta[j];
        }
    }
    Matrix6 ad_slope = ad(of_strain);
    for (int j = 0; j < 6; ++j) ad_slope[0][j] = 0.0;
    add(ad(of_beta), 0, 0, ad_slope);
    Matrix<6, 12> by = Matrix<6, 12>::zero();
    put(1.0 / 12.0 * (ad_slope * law.mean[k]), 0, 0, by);
    put(-1.0 / 12.0 * block<6, 6>(across, 0, 6), 0, 6, by);
    for (int i = 0; i < 6; ++i) {
        by[i][i] += 1.0;
        by[0][i] += 2.0 * bow[i];
    }
    out.J = out.inv_magnus * by;
    out.rate = out.J;
    put(block<6, 6>(out.J, 0, 0) * at.inv_tangent, 0, 0, out.rate);
    return out;
}

// Add the geometric stiffness of constant forces ``s`` and ``on_eta``, conjugate to ε and η.
inline void add_curvature(const StrainLaws& law, int k, const RelativePose& at, const Strain& e, const Vector6& s,
                          const Vector6& on_eta, Matrix<12, 12>& out) {
    const auto& slope = law.slope[k];
    const Vector6 force = transposed_times(e.inv_magnus, s), of_s = transposed_times(block<6, 6>(e.J, 0, 0), s);
    Vector6 bending = force;  // Magnus' term of the axial strain is in G, except that of β
    bending[0] = 0.0;
    Matrix<6, 12> on_slope = transposed_times(coadjoint(bending), block<6, 6>(slope, 0, 0)) * e.J;
    add(block<6, 6>(transposed_times(coadjoint(force), slope), 0, 6), 0, 6, on_slope);
    const Matrix<6, 12> half = transposed_times(law.mean[k], on_slope);
    Matrix<6, 12> both;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            both[i][j] = 2.0 * force[0] * law.shortening[k][i][j] - (half[i][j] + half[j][i]) / 12.0;
            both[i][6 + j] = -half[i][6 + j] / 12.0;
        }
    }
    const Matrix<6, 12> left = transposed_times(at.inv_tangent, both);
    add(block<6, 6>(left, 0, 0) * at.inv_tangent, 0, 0, out);
    add(block<6, 6>(left, 0, 6), 0, 6, out);
    add(transposed(block<6, 6>(left, 0, 6)), 6, 0, out);
    add_tangent_variation(at, on_eta + of_s, out);
}

}  // namespace southwell::corotational
