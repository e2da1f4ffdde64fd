// Quadratic forms of a chain's matrices with the modes' vectors.
#pragma once

#include <vector>

#include "matrices.hpp"

namespace southwell {

// x*Kx, ½i x*Cx and x*Mx of a complex vector x.
struct Energies {
    double stiffness, gyroscopic, inertia;
};

// uᵀ e u, of the real and the imaginary part of u together.
template <int D>
double form(const Matrix<D, D>& e, const Vector<D> (&u)[2]) {
    Vector<D> rows[2];
    rows_times(e, u, rows);
    return dot(rows[0], u[0]) + dot(rows[1], u[1]);
}

// The energies of complex vectors (m, 2, dn), by real and imaginary parts; ``out`` is zero at the start.
template <int D>
void add_energies(const ElementMatrices<D>& M, const ElementMatrices<D>& C, const ElementMatrices<D>& K,
                  const Matrix6* back, Rows x, Energies* out) {
    constexpr int d = D - 6;
    std::vector<Vector6> xi(x.count, Vector6{});  // twist of end a
    for (int k = 0; k < K.n; ++k) {
        for (int m = 0; m < x.count / 2; ++m) {
            const double *re = x[2 * m] + d * k, *im = x[2 * m + 1] + d * k;
            Vector<D> u[2];
            for (int i = 0; i < 6; ++i) u[0][i] = xi[2 * m][i], u[1][i] = xi[2 * m + 1][i];
            for (int i = 0; i < d; ++i) u[0][6 + i] = re[i], u[1][6 + i] = im[i];
            out[m].stiffness += form(K.element[k], u);
            out[m].inertia += form(M.element[k], u);
            out[m].gyroscopic -= dot(u[1], transposed_times(C.element[k], u[0]));  // C is skew
            xi[2 * m] = outwards(back[k], re, xi[2 * m]);
            xi[2 * m + 1] = outwards(back[k], im, xi[2 * m + 1]);
        }
    }
}

}  // namespace southwell
