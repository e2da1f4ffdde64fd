// Products of a chain's matrices, element by element, with vectors; matrices.py has the coordinates (ξ_a, ρ, β).
//
// D is the number of coordinates of an element's matrix: 18, or 12 without internal coordinates.
#pragma once

#include <algorithm>
#include <vector>

#include "../space/matrix.hpp"

namespace southwell {

// Vectors as rows of ``stride`` numbers, of which the first ones count.
struct Rows {
    double* data;
    long stride;
    int count;

    double* operator[](int v) const { return data + v * stride; }
};

// One of a chain's matrices: n elements.
template <int D>
struct ElementMatrices {
    const Matrix<D, D>* element;
    int n;
};

// Ad⁻¹ (ρ + ξ_a), the twist of end b.
inline Vector6 outwards(const Matrix6& back, const double* rho, const Vector6& xi) {
    Vector6 sum;
    for (int i = 0; i < 6; ++i) sum[i] = rho[i] + xi[i];
    return back * sum;
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

// sign · (the matrix of element k) · (ξ_a, x) for the V vectors from v on: its parts on ξ_a and on x. ξ_a becomes ξ_b.
template <int V, int D>
void times_element(const Matrix<D, D>& e, double sign, const Matrix6& back, int k, int v, Rows x, Rows out, Vector6* xi,
                   Vector6* on_a) {
    constexpr int d = D - 6;
    Vector<D> u[V], f[V];
    for (int m = 0; m < V; ++m) {
        const double* own = x[v + m] + d * k;
        for (int i = 0; i < 6; ++i) u[m][i] = sign * xi[v + m][i];
        for (int i = 0; i < d; ++i) u[m][6 + i] = sign * own[i];
    }
    rows_times(e, u, f);  // a row of the matrix is a column up to the sign, as it is symmetric or skew
    for (int m = 0; m < V; ++m) {
        double* own = out[v + m] + d * k;
        for (int i = 0; i < 6; ++i) on_a[v + m][i] = f[m][i];
        xi[v + m] = outwards(back, x[v + m] + d * k, xi[v + m]);
        for (int i = 0; i < d; ++i) own[i] = f[m][6 + i];
    }
}

// sign · (the matrix) · x for all rows of x into those of out, which is not x; four or two at a time, all for one element at a time.
template <int D>
void times(const ElementMatrices<D>& matrix, double sign, const Matrix6* back, Rows x, Rows out) {
    constexpr int d = D - 6;
    const int count = x.count;
    std::vector<Vector6> on_a(static_cast<size_t>(matrix.n) * count), xi(count, Vector6{}), p(count, Vector6{});
    for (int k = 0; k < matrix.n; ++k) {
        Vector6* here = on_a.data() + static_cast<size_t>(count) * k;
        int v = 0;
        for (; v + 3 < count; v += 4) times_element<4>(matrix.element[k], sign, back[k], k, v, x, out, xi.data(), here);
        for (; v + 1 < count; v += 2) times_element<2>(matrix.element[k], sign, back[k], k, v, x, out, xi.data(), here);
        if (v < count) times_element<1>(matrix.element[k], sign, back[k], k, v, x, out, xi.data(), here);
    }
    for (int k = matrix.n - 1; k >= 0; --k) {
        for (int v = 0; v < count; ++v) {
            p[v] = transposed_times(back[k], p[v]);
            for (int i = 0; i < 6; ++i) out[v][d * k + i] += p[v][i];
            p[v] = p[v] + on_a[static_cast<size_t>(count) * k + v];
        }
    }
}

// Replace ρ by ξ_b in vectors of n elements with d coordinates each.
inline void to_twists(const Matrix6* back, int n, int d, Rows x) {
    for (int v = 0; v < x.count; ++v) {
        Vector6 xi{};
        for (int k = 0; k < n; ++k) {
            xi = outwards(back[k], x[v] + d * k, xi);
            for (int i = 0; i < 6; ++i) x[v][d * k + i] = xi[i];
        }
    }
}

}  // namespace southwell
