// The block Lanczos steps of lanczos.py. Vectors (x, y) are rows of 2n numbers; a block has one or two of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../tree/elimination.hpp"

namespace southwell {

constexpr double MAX_OVERLAP = 1e-8;  // tolerated overlap with the basis
constexpr int MAX_PASSES = 3;         // of orthogonalisation

// The operator A⁻¹S with A = diag(K, M) and S = [[C, M], [−M, 0]].
//
// ``massive``: projectors of the nodes' twists on directions with mass, null for a consistent mass; ``lever``: Ad.
template <int D>
struct Operator {
    ElementMatrices<D> M, C, K;
    Links links;
    Factors<D> factor;
    const Matrix6* massive;
    const Matrix6* lever;

    int elements() const { return K.n; }
    int size() const { return K.n * (D - 6); }
};

// A block of vectors in memory of its own.
struct Block {
    std::vector<double> items;
    int width, count;

    Block(int most, int size) : items(static_cast<size_t>(most) * size), width(size), count(most) {}
    operator Rows() { return {items.data(), width, count}; }
    double* operator[](int v) { return items.data() + static_cast<size_t>(v) * width; }
};

// Two by two numbers, for blocks of one or two vectors.
struct Pairs {
    int count;
    double item[2][2];
};

// Remove the motion of nodes without inertia from vectors y.
//
// It has no part in M y, but is amplified by every orthogonalisation, and its rounding errors do carry mass.
template <int D>
void keep_massive(const Operator<D>& a, Rows y) {
    if (!a.massive) return;
    constexpr int d = D - 6;
    for (int v = 0; v < y.count; ++v) {
        std::vector<Vector6> xi(a.elements() + 1, Vector6{}),
            kept(xi);  // twists of the nodes, and their part with mass
        for (int k = 0; k < a.elements(); ++k) {
            double* rho = y[v] + d * k;
            const auto from = a.links.parent[k];
            xi[k + 1] = outwards(a.links.to_child[k], rho, xi[from]);
            kept[k + 1] = a.massive[k] * xi[k + 1];
            const Vector6 at_a = a.lever[k] * kept[k + 1];
            for (int i = 0; i < 6; ++i) rho[i] = at_a[i] - kept[from][i];
        }
    }
}

// w = A⁻¹S v, the force A w = S v, and M y, for each of the rows v = (x, y).
template <int D>
void forward(const Operator<D>& a, Rows v, Rows w, Rows force, Rows My) {
    const int n = a.size();
    const Rows solved{w.data, w.stride, v.count};
    Block both(2 * v.count, n);  // M x and M y in turn
    for (int m = 0; m < v.count; ++m)
        for (int i = 0; i < n; ++i) w[m][n + i] = v[m][i];
    keep_massive(a, {w.data + n, w.stride, v.count});
    times(a.C, -1.0, a.links, v, solved);  // skew
    times(a.M, 1.0, a.links, {v.data, n, 2 * v.count}, both);
    for (int m = 0; m < v.count; ++m) {
        const double *of_x = both[2 * m], *of_y = both[2 * m + 1];
        for (int i = 0; i < n; ++i) {
            w[m][n + i] = -w[m][n + i];
            My[m][i] = of_y[i];
            force[m][i] = w[m][i] = w[m][i] + of_y[i];  // C x + M y
            force[m][n + i] = -of_x[i];
        }
    }
    solve(a.factor, a.links, solved);
}

// Products a bᵀ of rows of n numbers with the one or two rows of b, into ``out`` (rows of two); four rows of a at a time.
inline void products(Rows a, Rows b, int n, double (*out)[2]) {
    const double *first = b[0], *other = b[b.count - 1];
    for (int i = 0; i < a.count; i += 4) {
        const int last = a.count - 1;
        const double *p = a[i], *q = a[std::min(i + 1, last)], *r = a[std::min(i + 2, last)],
                     *s = a[std::min(i + 3, last)];
        double p0 = 0.0, p1 = 0.0, q0 = 0.0, q1 = 0.0, r0 = 0.0, r1 = 0.0, s0 = 0.0, s1 = 0.0;
#pragma omp simd reduction(+ : p0, p1, q0, q1, r0, r1, s0, s1)
        for (int c = 0; c < n; ++c) {
            p0 += p[c] * first[c], p1 += p[c] * other[c];
            q0 += q[c] * first[c], q1 += q[c] * other[c];
            r0 += r[c] * first[c], r1 += r[c] * other[c];
            s0 += s[c] * first[c], s1 += s[c] * other[c];
        }
        const double found[4][2] = {{p0, p1}, {q0, q1}, {r0, r1}, {s0, s1}};
        for (int m = 0; m < std::min(4, a.count - i); ++m)
            for (int v = 0; v < b.count; ++v) out[i + m][v] = found[m][v];
    }
}

// w −= overlapᵀ basis for rows w of n numbers; four rows of the basis at a time.
inline void project_out(Rows w, const double (*overlap)[2], Rows basis, int n) {
    for (int i = 0; i < basis.count; i += 4) {
        const double* b[4];
        double h[4][2];
        for (int r = 0; r < 4; ++r) {
            const bool there = i + r < basis.count;
            b[r] = basis[there ? i + r : i];
            for (int v = 0; v < w.count; ++v) h[r][v] = there ? overlap[i + r][v] : 0.0;
        }
        for (int v = 0; v < w.count; ++v) {
            double* out = w[v];
            const double h0 = h[0][v], h1 = h[1][v], h2 = h[2][v], h3 = h[3][v];
#pragma omp simd
            for (int c = 0; c < n; ++c) out[c] -= h0 * b[0][c] + h1 * b[1][c] + h2 * b[2][c] + h3 * b[3][c];
        }
    }
}

// Eigenvalues, ascending, and eigenvectors, as columns, of a symmetric matrix (1, 1) or (2, 2).
inline void axes(const Pairs& gram, double (&value)[2], double (&turn)[2][2]) {
    if (gram.count == 1) {
        value[0] = gram.item[0][0], turn[0][0] = 1.0;
        return;
    }
    const double a = gram.item[0][0], b = gram.item[0][1], c = gram.item[1][1];
    const double angle = 0.5 * std::atan2(2.0 * b, a - c), cosine = std::cos(angle), sine = std::sin(angle);
    turn[0][0] = -sine, turn[1][0] = cosine, turn[0][1] = cosine, turn[1][1] = sine;
    value[0] = a * sine * sine - 2.0 * b * sine * cosine + c * cosine * cosine;
    value[1] = a * cosine * cosine + 2.0 * b * sine * cosine + c * sine * sine;
}

// A growing basis, and the operator on it.
struct Basis {
    Rows vectors;      // ``limit`` rows
    Rows projected;    // (m, m), with room for the vectors to come
    int size, before;  // rows that are filled, and where those of the last step begin
};

// Orthogonalise w, with M y = ``My``, against the basis in the A product; the overlaps are added to ``projected``.
//
// ``dual`` is overwritten. Returns the Gram matrix of w and, in ``largest``, the largest overlap of the last pass.
template <int D>
Pairs orthogonalise(const Operator<D>& a, Rows w, Rows My, const Basis& basis, Rows dual, double& largest) {
    const int n = a.size(), latest = basis.size - basis.before;
    const Rows filled{basis.vectors.data, basis.vectors.stride, basis.size};
    std::vector<double> memory(2 * static_cast<size_t>(basis.size));
    auto* overlap = reinterpret_cast<double (*)[2]>(memory.data());
    Pairs gram{w.count, {}};
    largest = 0.0;
    for (int turn = 0; turn < MAX_PASSES; ++turn) {
        if (turn > 0) times(a.M, 1.0, a.links, Rows{w.data + n, w.stride, w.count}, My);
        times(a.K, 1.0, a.links, w, dual);
        for (int m = 0; m < w.count; ++m)
            for (int i = 0; i < n; ++i) dual[m][n + i] = My[m][i];
        products(filled, dual, 2 * n, overlap);
        project_out(w, overlap, filled, 2 * n);
        largest = 0.0;
        for (int i = 0; i < basis.size; ++i) {
            for (int j = 0; j < latest; ++j) {
                basis.projected[i][basis.before + j] += overlap[i][j];
                largest = std::max(largest, std::abs(overlap[i][j]));
            }
        }
        products(w, dual, 2 * n, gram.item);
        const double smallest = std::min(gram.item[0][0], gram.item[w.count - 1][w.count - 1]);
        if (largest <= MAX_OVERLAP * std::sqrt(std::max(smallest, 0.0))) break;
    }
    return gram;
}

// Take block Lanczos steps until the basis has ``look`` vectors or cannot grow.
//
// w holds the result of the last step and, at the end, that of the new last one, orthogonal to the basis. Returns its Gram matrix,
// and in ``exhausted`` whether the basis cannot grow.
template <int D>
Pairs extend(const Operator<D>& a, Rows& w, Basis& basis, int look, bool& exhausted) {
    const int n = a.size(), most = w.count;
    Block force(most, 2 * n), of_w(most, n), of_last(most, n), of_these(most, n);
    std::vector<double> memory(8 * static_cast<size_t>(most));
    auto* overlap = reinterpret_cast<double (*)[2]>(memory.data());
    of_last.count = basis.size - basis.before;
    times(a.M, 1.0, a.links, Rows{w.data + n, w.stride, w.count}, of_w);
    times(a.M, 1.0, a.links, Rows{basis.vectors[basis.before] + n, basis.vectors.stride, of_last.count}, of_last);
    while (true) {
        double largest, value[2], turn[2][2];
        const Pairs gram = orthogonalise(a, w, of_w, basis, force, largest);
        axes(gram, value, turn);
        const double least = 1e-20 * std::max({value[gram.count - 1], largest * largest, 1e-300});
        int kept = 0;
        for (int i = 0; i < gram.count; ++i) kept += value[i] > least;
        exhausted = kept == 0 || basis.size + 2 > basis.vectors.count - 2;
        if (exhausted || basis.size >= look) return gram;
        for (int m = 0; m < kept; ++m) {
            const int column = gram.count - kept + m;
            const double scale = 1.0 / std::sqrt(value[column]);
            double* out = basis.vectors[basis.size + m];
            for (int i = 0; i < 2 * n; ++i) out[i] = scale * turn[0][column] * w[0][i];
            if (gram.count == 2)
                for (int i = 0; i < 2 * n; ++i) out[i] += scale * turn[1][column] * w[1][i];
        }
        w.count = force.count = of_w.count = of_these.count = kept;
        const Rows these{basis.vectors[basis.size], basis.vectors.stride, kept};
        const Rows both{basis.vectors[basis.before], basis.vectors.stride, basis.size - basis.before + kept};
        forward(a, these, w, force, of_these);
        products(both, force, 2 * n, overlap);
        for (int i = 0; i < both.count; ++i)
            for (int j = 0; j < kept; ++j) basis.projected[basis.before + i][basis.size + j] = overlap[i][j];
        project_out(w, overlap, both, 2 * n);
        for (int m = 0; m < kept; ++m)
            for (int i = 0; i < n; ++i) of_w[m][i] = force[m][n + i];  // M y = −M x is known
        project_out(of_w, overlap, of_last, n);
        project_out(of_w, overlap + of_last.count, of_these, n);
        std::swap(of_last, of_these);
        basis.before = basis.size;
        basis.size += kept;
    }
}

}  // namespace southwell
