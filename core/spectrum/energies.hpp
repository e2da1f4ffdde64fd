// Quadratic forms of a tree's matrices with the modes' vectors.
#pragma once

#include <vector>

#include "../tree/matrices.hpp"

namespace southwell {

// x*Kx, ½i x*Cx and x*Mx of a complex vector x.
struct Energies {
    double stiffness, gyroscopic, inertia;
};

// uᵀ e u of V modes: of the real parts, which come first, and of the imaginary parts together.
template <int V, int D>
void forms(const Matrix<D, D>& e, const Vector<D> (&u)[2 * V], double (&out)[V]) {
    Vector<D> rows[2 * V];
    rows_times(e, u, rows);
    for (int m = 0; m < V; ++m) out[m] = dot(rows[m], u[m]) + dot(rows[V + m], u[V + m]);
}

// Add the energies of element k for the V modes from m on, from the twists ξ_a; ξ_b is set.
template <int V, int D>
void add_element(const ElementMatrices<D>& M, const ElementMatrices<D>& C, const ElementMatrices<D>& K,
                 const Matrix6& to_child, int k, int m, Rows x, const Vector6* xi_a, Vector6* xi_b, Energies* out) {
    constexpr int d = D - 6;
    Vector<D> u[2 * V], real[V], of_real[V];
    for (int r = 0; r < 2 * V; ++r) {
        const int row = 2 * (m + r % V) + r / V;
        const double* own = x[row] + d * k;
        for (int i = 0; i < 6; ++i) u[r][i] = xi_a[row][i];
        for (int i = 0; i < d; ++i) u[r][6 + i] = own[i];
        xi_b[row] = outwards(to_child, own, xi_a[row]);
    }
    double stiffness[V], inertia[V];
    forms<V>(K.element[k], u, stiffness);
    forms<V>(M.element[k], u, inertia);
    for (int r = 0; r < V; ++r) real[r] = u[r];
    rows_times(C.element[k], real, of_real);
    for (int r = 0; r < V; ++r) {
        out[m + r].stiffness += stiffness[r];
        out[m + r].inertia += inertia[r];
        out[m + r].gyroscopic -= dot(u[V + r], of_real[r]);  // C is skew
    }
}

// The energies of complex vectors (m, 2, dn), by real and imaginary parts; ``out`` is zero at the start.
template <int D>
void add_energies(const ElementMatrices<D>& M, const ElementMatrices<D>& C, const ElementMatrices<D>& K,
                  const Links& links, Rows x, Energies* out) {
    std::vector<Vector6> xi(static_cast<size_t>(links.n + 1) * x.count, Vector6{});
    for (int k = 0; k < K.n; ++k) {
        const Vector6* from = xi.data() + static_cast<size_t>(x.count) * links.parent[k];
        Vector6* to = xi.data() + static_cast<size_t>(x.count) * (k + 1);
        int m = 0;
        for (; m + 1 < x.count / 2; m += 2) add_element<2>(M, C, K, links.to_child[k], k, m, x, from, to, out);
        if (m < x.count / 2) add_element<1>(M, C, K, links.to_child[k], k, m, x, from, to, out);
    }
}

}  // namespace southwell
