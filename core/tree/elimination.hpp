// Factors of K, solutions and the count of negative pivots, from the tip inwards; see elimination.py and completeness.py.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "matrices.hpp"

namespace southwell {

// Factors of K; see elimination.Factor. d = D − 6.
template <int D>
struct Factors {
    Matrix<D - 6, D - 6>* flexibility;
    Matrix<6, D - 6>* transfer;
    Matrix<D - 6, 6>* reaction;
};

// Remove the directions of ρ that a joint clamps from a matrix.
template <int D>
void project(const Matrix6& clamped, Matrix<D, D>& out) {
    for (int pass = 0; pass < 2; ++pass) {  // of the rows, then of the columns
        for (int j = 0; j < D; ++j) {
            double part[6] = {};
            for (int i = 0; i < 6; ++i)
                for (int l = 0; l < 6; ++l) part[i] += clamped[i][l] * (pass ? out[j][6 + l] : out[6 + l][j]);
            for (int i = 0; i < 6; ++i) (pass ? out[j][6 + i] : out[6 + i][j]) -= part[i];
        }
    }
}

// Give the directions that a joint clamps the size of the stiffness of the others: they do not move, whatever their stiffness,
// and another size would cost digits of the inverse.
template <int D>
void clamp(const Matrix6& clamped, Matrix<D, D>& out) {
    project(clamped, out);
    double size = 0.0;
    for (int i = 6; i < 12; ++i) size += std::abs(out[i][i]);
    add((size > 0.0 ? size : 1.0) * clamped, 6, 6, out);
}

// Fill the factors; returns the worst result of ``invert`` over all elements.
template <int D>
int eliminate(const ElementMatrices<D>& K, const Links& links, const Factors<D>& out) {
    constexpr int d = D - 6;
    int kind = 2;
    std::vector<Matrix6> P(K.n + 1, Matrix6::zero());  // stiffness of each node and all that lies beyond
    for (int k = K.n - 1; k >= 0; --k) {
        Matrix<D, D> H = K.element[k];
        add_at_end(links.to_child[k], P[k + 1], H);
        if (links.clamped) clamp(links.clamped[k], H);
        kind = std::min(kind, invert(H, 6));
        if (kind == 0) break;
        if (links.clamped) project(links.clamped[k], H);
        add(block<6, 6>(H, 0, 0), 0, 0, P[links.parent[k]]);
        out.transfer[k] = -1.0 * transposed(block<d, 6>(H, 6, 0));
        out.reaction[k] = transposed(block<6, d>(H, 0, 6));
        out.flexibility[k] = transposed(block<d, d>(H, 6, 6));
    }
    return kind;
}

// Replace V loads by the displacements. Loads on clamped directions have no effect.
template <int D, int V>
void solve(const Factors<D>& f, const Links& links, double* const (&x)[V]) {
    constexpr int d = D - 6;
    const int n = links.n;
    std::vector<std::array<Vector6, V>> p(n + 1), xi(n + 1);
    for (int k = n - 1; k >= 0; --k) {
        auto& at_a = p[links.parent[k]];
        for (int v = 0; v < V; ++v) {
            double* q = x[v] + d * k;
            Vector6 here = transposed_times(links.to_child[k], p[k + 1][v]);
            for (int i = 0; i < 6; ++i) q[i] += here[i];
            for (int i = 0; i < d; ++i)
                for (int j = 0; j < 6; ++j) here[j] += f.reaction[k][i][j] * q[i];
            at_a[v] = at_a[v] + here;
        }
    }
    for (int k = 0; k < n; ++k) {
        const auto& at_a = xi[links.parent[k]];
        Vector<d> here[V]{};
        for (int j = 0; j < d; ++j)
            for (int v = 0; v < V; ++v)
                for (int i = 0; i < d; ++i) here[v][i] += f.flexibility[k][j][i] * x[v][d * k + j];
        for (int v = 0; v < V; ++v) {  // last, since only this step depends on the previous element
            here[v] = here[v] + transposed_times(f.transfer[k], at_a[v]);
            for (int i = 0; i < d; ++i) x[v][d * k + i] = here[v][i];
            xi[k + 1][v] = outwards(links.to_child[k], x[v] + d * k, at_a[v]);
        }
    }
}

// Replace the rows of x by the solutions.
template <int D>
void solve(const Factors<D>& f, const Links& links, Rows x) {
    int v = 0;
    for (; v + 1 < x.count; v += 2) {
        double* const two[2] = {x[v], x[v + 1]};
        solve<D, 2>(f, links, two);
    }
    if (v < x.count) {
        double* const last[1] = {x[v]};
        solve<D, 1>(f, links, last);
    }
}

// Negative pivots of K + iωC − ω²M in the same elimination, by real and imaginary parts.
template <int D>
int negative_pivots(const ElementMatrices<D>& K, const ElementMatrices<D>& C, const ElementMatrices<D>& M,
                    const Links& links, double omega) {
    int count = 0;
    std::vector<Matrix6> P(K.n + 1, Matrix6::zero()), Q(K.n + 1, Matrix6::zero());
    for (int k = K.n - 1; k >= 0; --k) {
        Matrix<D, D> re, im;
        const auto &stiffness = K.element[k], &gyroscopic = C.element[k], &mass = M.element[k];
        for (int i = 0; i < D; ++i) {
            for (int j = 0; j < D; ++j) {
                re[i][j] = 0.5 * (stiffness[i][j] + stiffness[j][i]) - omega * omega * mass[i][j];
                im[i][j] = omega * gyroscopic[i][j];
            }
        }
        add_at_end(links.to_child[k], P[k + 1], re);
        add_at_end(links.to_child[k], Q[k + 1], im);
        if (links.clamped) {
            clamp(links.clamped[k], re);
            project(links.clamped[k], im);
        }
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
        Matrix6 &at_a = P[links.parent[k]], &skew_at_a = Q[links.parent[k]];
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j <= i; ++j) {
                at_a[i][j] += re[i][j];
                skew_at_a[i][j] += im[i][j];
                if (i != j) at_a[j][i] += re[i][j], skew_at_a[j][i] -= im[i][j];
            }
        }
    }
    return count;
}

}  // namespace southwell
