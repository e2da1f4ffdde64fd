// Quadratic forms of a chain's matrices with the modes' vectors.
#pragma once

#include "matrices.hpp"

namespace southwell {

// x*Kx, ½i x*Cx and x*Mx of a complex vector x.
struct Energies {
    double stiffness, gyroscopic, inertia;
};

// uᵀ e u, of the real and the imaginary part of u together.
template <int D>
double form(const Matrix<D, D>& e, const Vector<D>& re, const Vector<D>& im) {
    Vector<D> f{}, g{};
    for (int j = 0; j < D; ++j)
        for (int i = 0; i < D; ++i) f[i] += re[j] * e[j][i], g[i] += im[j] * e[j][i];
    return dot(re, f) + dot(im, g);
}

// The energies of the vector with real part ``re`` and imaginary part ``im``.
template <int D>
Energies energies(const ElementMatrices<D>& M, const ElementMatrices<D>& C, const ElementMatrices<D>& K,
                  const Matrix6* back, const double* re, const double* im) {
    constexpr int d = D - 6;
    Energies out{0.0, 0.0, 0.0};
    Vector6 xi{}, eta{};  // twist of end a: real and imaginary part
    for (int k = 0; k < K.n; ++k) {
        Vector<D> u, w;
        for (int i = 0; i < 6; ++i) u[i] = xi[i], w[i] = eta[i];
        for (int i = 0; i < d; ++i) u[6 + i] = re[d * k + i], w[6 + i] = im[d * k + i];
        out.stiffness += form(K.element[k], u, w);
        out.inertia += form(M.element[k], u, w);
        out.gyroscopic -= dot(w, transposed_times(C.element[k], u));  // C is skew
        xi = outwards(back[k], re + d * k, xi);
        eta = outwards(back[k], im + d * k, eta);
    }
    return out;
}

}  // namespace southwell
