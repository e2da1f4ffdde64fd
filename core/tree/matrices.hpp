// Products of a tree's matrices, element by element, with vectors; links.py has the coordinates (ξ_a, ρ, β).
//
// D is the number of coordinates of an element's matrix: 18, or 12 without internal coordinates.
#pragma once

#include <algorithm>
#include <vector>

#include "links.hpp"

namespace southwell {

// One of a tree's matrices: n elements.
template <int D>
struct ElementMatrices {
    const Matrix<D, D>* element;
    int n;
};

// Add a matrix on the twist of a node to that of the element that ends there.
template <int D>
void add_at_end(const Matrix6& to_child, const Matrix6& on_end, Matrix<D, D>& out) {
    const Matrix6 on_sum = congruence(to_child, on_end);  // on ξ_a + ρ
    for (int i = 0; i < 12; i += 6)
        for (int j = 0; j < 12; j += 6) add(on_sum, i, j, out);
}

// Columns ``first`` … first + W − 1 of the rows uᵀ e of V vectors.
template <int W, int D, int V>
void columns(const Matrix<D, D>& e, const Vector<D> (&u)[V], int first, Vector<D> (&out)[V]) {
    double sum[V][W] = {};
    for (int j = 0; j < D; ++j)
        for (int m = 0; m < V; ++m)
#pragma omp simd
            for (int i = 0; i < W; ++i) sum[m][i] += u[m][j] * e[j][first + i];
    for (int m = 0; m < V; ++m)
        for (int i = 0; i < W; ++i) out[m][first + i] = sum[m][i];
}

// Rows uᵀ e of V vectors, as many columns at a time as eight registers of four numbers can sum.
template <int D, int V>
void rows_times(const Matrix<D, D>& e, const Vector<D> (&u)[V], Vector<D> (&out)[V]) {
    constexpr int W = std::min(D, V > 2 ? 8 : 16);
    for (int first = 0; first + W <= D; first += W) columns<W>(e, u, first, out);
    if constexpr (D % W != 0) columns<D % W>(e, u, D - D % W, out);
}

// sign · (the matrix of element k) · (ξ_a, x) for the V vectors from v on: its part on x. That on ξ_a is added to ``on_a``.
template <int V, int D>
void times_element(const Matrix<D, D>& e, double sign, const Matrix6& to_child, int k, int v, Rows x, Rows out,
                   const Vector6* xi_a, Vector6* xi_b, Vector6* on_a) {
    constexpr int d = D - 6;
    Vector<D> u[V], f[V];
    for (int m = 0; m < V; ++m) {
        const double* own = x[v + m] + d * k;
        for (int i = 0; i < 6; ++i) u[m][i] = sign * xi_a[v + m][i];
        for (int i = 0; i < d; ++i) u[m][6 + i] = sign * own[i];
    }
    rows_times(e, u, f);  // a row of the matrix is a column up to the sign, as it is symmetric or skew
    for (int m = 0; m < V; ++m) {
        double* own = out[v + m] + d * k;
        for (int i = 0; i < 6; ++i) on_a[v + m][i] += f[m][i];
        xi_b[v + m] = outwards(to_child, x[v + m] + d * k, xi_a[v + m]);
        for (int i = 0; i < d; ++i) own[i] = f[m][6 + i];
    }
}

// sign · Bᵀ (the matrix) B · x for all rows of x into those of out, which is not x; four or two at a time, all for one element at a time.
template <int D>
void times(const ElementMatrices<D>& matrix, double sign, const Links& links, Rows x, Rows out) {
    constexpr int d = D - 6;
    const int count = x.count;
    std::vector<Vector6> xi(static_cast<size_t>(matrix.n + 1) * count), p(xi.size(), Vector6{});
    std::fill_n(xi.begin(), count, Vector6{});  // node 0 does not move
    for (int k = 0; k < matrix.n; ++k) {
        const size_t a = static_cast<size_t>(count) * links.parent[k];
        const Vector6* from = xi.data() + a;
        Vector6 *to = xi.data() + static_cast<size_t>(count) * (k + 1), *on_a = p.data() + a;
        const auto &e = matrix.element[k], &to_child = links.to_child[k];
        int v = 0;
        for (; v + 3 < count; v += 4) times_element<4>(e, sign, to_child, k, v, x, out, from, to, on_a);
        for (; v + 1 < count; v += 2) times_element<2>(e, sign, to_child, k, v, x, out, from, to, on_a);
        if (v < count) times_element<1>(e, sign, to_child, k, v, x, out, from, to, on_a);
    }
    for (int k = matrix.n - 1; k >= 0; --k) {
        const Vector6* at_b = p.data() + static_cast<size_t>(count) * (k + 1);
        Vector6* at_a = p.data() + static_cast<size_t>(count) * links.parent[k];
        for (int v = 0; v < count; ++v) {
            const Vector6 beyond = transposed_times(links.to_child[k], at_b[v]);
            for (int i = 0; i < 6; ++i) out[v][d * k + i] += beyond[i];
            at_a[v] = at_a[v] + beyond;
        }
    }
}

}  // namespace southwell
