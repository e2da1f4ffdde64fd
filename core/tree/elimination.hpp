// Factors of K, solutions and the count of negative pivots, from the tip inwards; see elimination.py and completeness.py.
#pragma once

#include <algorithm>

#include "matrices.hpp"

namespace southwell {

// Factors of K; see elimination.Factor. d = D − 6.
template <int D>
struct Factors {
    Matrix<D - 6, D - 6>* flexibility;
    Matrix<6, D - 6>* ride;
    Matrix<D - 6, 6>* reaction;
};

// Add a stiffness on ξ_a + ρ.
template <int D>
void add_beyond(const Matrix6& beyond, Matrix<D, D>& out) {
    add(beyond, 0, 0, out);
    add(beyond, 0, 6, out);
    add(beyond, 6, 0, out);
    add(beyond, 6, 6, out);
}

// Fill the factors; returns the worst result of ``invert`` over all elements. ``clamped`` may be null.
template <int D>
int eliminate(const ElementMatrices<D>& K, const Matrix6* back, const Matrix6* clamped, const Factors<D>& out) {
    int kind = 2;
    Matrix6 P = Matrix6::zero();
    for (int k = K.n - 1; k >= 0; --k) {
        Matrix<D, D> H = K.element[k];
        add_beyond(congruence(back[k], P), H);
        if (k == 0 && clamped) add(*clamped, 6, 6, H);  // any stiffness: these directions do not move
        kind = std::min(kind, invert(H, 6));
        if (kind == 0) break;
        P = block<6, 6>(H, 0, 0);
        out.ride[k] = -1.0 * transposed(block<D - 6, 6>(H, 6, 0));
        out.reaction[k] = transposed(block<6, D - 6>(H, 0, 6));
        out.flexibility[k] = transposed(block<D - 6, D - 6>(H, 6, 6));
    }
    return kind;
}

// Replace V loads by the displacements; ``back`` as for K. Loads on clamped directions have no effect.
template <int D, int V>
void solve(const Factors<D>& f, const Matrix6* back, int n, double* const (&x)[V]) {
    constexpr int d = D - 6;
    Vector6 p[V]{}, xi[V]{};
    for (int k = n - 1; k >= 0; --k) {
        for (int v = 0; v < V; ++v) {
            double* q = x[v] + d * k;
            p[v] = transposed_times(back[k], p[v]);
            for (int i = 0; i < 6; ++i) q[i] += p[v][i];
            for (int i = 0; i < d; ++i)
                for (int j = 0; j < 6; ++j) p[v][j] += f.reaction[k][i][j] * q[i];
        }
    }
    for (int k = 0; k < n; ++k) {
        Vector<d> here[V]{};
        for (int j = 0; j < d; ++j)
            for (int v = 0; v < V; ++v)
                for (int i = 0; i < d; ++i) here[v][i] += f.flexibility[k][j][i] * x[v][d * k + j];
        for (int v = 0; v < V; ++v) {  // last, since this alone waits for the element before
            here[v] = here[v] + transposed_times(f.ride[k], xi[v]);
            for (int i = 0; i < d; ++i) x[v][d * k + i] = here[v][i];
            xi[v] = outwards(back[k], x[v] + d * k, xi[v]);
        }
    }
}

// Replace the rows of x by the solutions.
template <int D>
void solve(const Factors<D>& f, const Matrix6* back, int n, Rows x) {
    int v = 0;
    for (; v + 1 < x.count; v += 2) {
        double* const two[2] = {x[v], x[v + 1]};
        solve<D, 2>(f, back, n, two);
    }
    if (v < x.count) {
        double* const one[1] = {x[v]};
        solve<D, 1>(f, back, n, one);
    }
}

// Negative pivots of K + iωC − ω²M in the same elimination, by real and imaginary parts.
template <int D>
int negative_pivots(const ElementMatrices<D>& K, const ElementMatrices<D>& C, const ElementMatrices<D>& M,
                    const Matrix6* back, const Matrix6* clamped, double omega) {
    int count = 0;
    Matrix6 P = Matrix6::zero(), Q = Matrix6::zero();
    for (int k = K.n - 1; k >= 0; --k) {
        Matrix<D, D> re, im;
        const auto &stiffness = K.element[k], &gyroscopic = C.element[k], &mass = M.element[k];
        for (int i = 0; i < D; ++i) {
            for (int j = 0; j < D; ++j) {
                re[i][j] = 0.5 * (stiffness[i][j] + stiffness[j][i]) - omega * omega * mass[i][j];
                im[i][j] = omega * gyroscopic[i][j];
            }
        }
        add_beyond(congruence(back[k], P), re);
        add_beyond(congruence(back[k], Q), im);
        if (k == 0 && clamped) add(*clamped, 6, 6, re);
        for (int p = D - 1; p > 5; --p) {
            if (re[p][p] < 0.0) ++count;
            const double inverse = 1.0 / re[p][p];
            for (int i = 0; i < p; ++i) {
                const double a = re[p][i] * inverse, b = -im[p][i] * inverse;
                for (int j = 0; j <= i; ++j) {
                    re[i][j] -= a * re[p][j] - b * im[p][j];
                    im[i][j] -= a * im[p][j] + b * re[p][j];
                }
            }
        }
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j <= i; ++j) {
                P[i][j] = P[j][i] = re[i][j];
                Q[i][j] = im[i][j], Q[j][i] = -im[i][j];
            }
        }
    }
    return count;
}

}  // namespace southwell
