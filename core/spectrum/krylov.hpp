// The block Lanczos steps of lanczos.py. Vectors (x, y) are rows of 2n numbers; a block has at most WIDTH of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../tree/elimination.hpp"

namespace southwell {

constexpr double MAX_OVERLAP = 1e-8;  // tolerated overlap with the basis
constexpr int MAX_PASSES = 3;         // of orthogonalisation
constexpr int WIDTH = 8;              // largest number of vectors in a block

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

using Row = double[WIDTH];  // products with the vectors of a block

// Products of the vectors of a block with each other.
struct Gram {
    int count;
    Row item[WIDTH];
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

// Products a bᵀ of rows of n numbers with the rows of a block b, into ``out``; four rows of a and two of b at a time.
inline void products(Rows a, Rows b, int n, Row* out) {
    for (int v = 0; v < b.count; v += 2) {
        const bool pair = v + 1 < b.count;
        const double *first = b[v], *other = b[pair ? v + 1 : v];
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
            const double sums[4][2] = {{p0, p1}, {q0, q1}, {r0, r1}, {s0, s1}};
            for (int m = 0; m < std::min(4, a.count - i); ++m) {
                out[i + m][v] = sums[m][0];
                if (pair) out[i + m][v + 1] = sums[m][1];
            }
        }
    }
}

// w −= overlapᵀ basis for rows w of n numbers; four rows of the basis at a time.
inline void project_out(Rows w, const Row* overlap, Rows basis, int n) {
    for (int i = 0; i < basis.count; i += 4) {
        const double* b[4];
        double h[4][WIDTH];
        for (int r = 0; r < 4; ++r) {
            const bool filled = i + r < basis.count;
            b[r] = basis[filled ? i + r : i];
            for (int v = 0; v < w.count; ++v) h[r][v] = filled ? overlap[i + r][v] : 0.0;
        }
        for (int v = 0; v < w.count; ++v) {
            double* out = w[v];
            const double h0 = h[0][v], h1 = h[1][v], h2 = h[2][v], h3 = h[3][v];
#pragma omp simd
            for (int c = 0; c < n; ++c) out[c] -= h0 * b[0][c] + h1 * b[1][c] + h2 * b[2][c] + h3 * b[3][c];
        }
    }
}

// Eigenvalues, and eigenvectors, as columns, of a symmetric matrix, which is overwritten: cyclic Jacobi rotations.
inline void eigh(Gram& gram, double (&value)[WIDTH], double (&vectors)[WIDTH][WIDTH]) {
    const int n = gram.count;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) vectors[i][j] = i == j ? 1.0 : 0.0;
    for (int sweep = 0; sweep < 30; ++sweep) {
        bool rotated = false;
        for (int p = 0; p < n; ++p) {
            for (int q = p + 1; q < n; ++q) {
                const double b = gram.item[p][q];
                if (std::abs(b) <= 1e-17 * std::sqrt(std::abs(gram.item[p][p] * gram.item[q][q]))) continue;
                rotated = true;
                const double angle = 0.5 * std::atan2(2.0 * b, gram.item[q][q] - gram.item[p][p]);
                const double c = std::cos(angle), s = std::sin(angle);
                for (int i = 0; i < n; ++i) {  // of the columns
                    const double x = gram.item[i][p], y = gram.item[i][q], u = vectors[i][p], v = vectors[i][q];
                    gram.item[i][p] = c * x - s * y, gram.item[i][q] = s * x + c * y;
                    vectors[i][p] = c * u - s * v, vectors[i][q] = s * u + c * v;
                }
                for (int i = 0; i < n; ++i) {  // of the rows
                    const double x = gram.item[p][i], y = gram.item[q][i];
                    gram.item[p][i] = c * x - s * y, gram.item[q][i] = s * x + c * y;
                }
            }
        }
        if (!rotated) break;
    }
    for (int i = 0; i < n; ++i) value[i] = gram.item[i][i];
}

// A growing basis, and the operator on it.
struct Basis {
    Rows vectors;         // ``limit`` rows
    Rows projected;       // (m, m), with room for the vectors to come
    int size, last_step;  // rows that are filled, and where those of the last step begin
};

// Orthogonalise w, with M y = ``My``, against the basis in the A product; the overlaps are added to ``projected``.
//
// ``dual`` is overwritten. Returns the Gram matrix of w and, in ``largest``, the largest overlap of the last pass.
template <int D>
Gram orthogonalise(const Operator<D>& a, Rows w, Rows My, const Basis& basis, Rows dual, double& largest) {
    const int n = a.size(), step = basis.size - basis.last_step;
    const Rows filled{basis.vectors.data, basis.vectors.stride, basis.size};
    std::vector<double> memory(WIDTH * static_cast<size_t>(basis.size));
    auto* overlap = reinterpret_cast<Row*>(memory.data());
    Gram gram{w.count, {}};
    largest = 0.0;
    for (int pass = 0; pass < MAX_PASSES; ++pass) {
        if (pass > 0) times(a.M, 1.0, a.links, Rows{w.data + n, w.stride, w.count}, My);
        times(a.K, 1.0, a.links, w, dual);
        for (int m = 0; m < w.count; ++m)
            for (int i = 0; i < n; ++i) dual[m][n + i] = My[m][i];
        products(filled, dual, 2 * n, overlap);
        project_out(w, overlap, filled, 2 * n);
        largest = 0.0;
        for (int i = 0; i < basis.size; ++i) {
            for (int j = 0; j < step; ++j) {
                basis.projected[i][basis.last_step + j] += overlap[i][j];
                largest = std::max(largest, std::abs(overlap[i][j]));
            }
        }
        products(w, dual, 2 * n, gram.item);
        double smallest = gram.item[0][0];
        for (int i = 1; i < w.count; ++i) smallest = std::min(smallest, gram.item[i][i]);
        if (largest <= MAX_OVERLAP * std::sqrt(std::max(smallest, 0.0))) break;
    }
    return gram;
}

// Take block Lanczos steps until the basis has ``look`` vectors or cannot grow.
//
// w holds the result of the last step and, at the end, that of the new last one, orthogonal to the basis. Returns its Gram matrix,
// and in ``exhausted`` whether the basis cannot grow.
template <int D>
Gram extend(const Operator<D>& a, Rows& w, Basis& basis, int look, bool& exhausted) {
    const int n = a.size(), most = w.count;
    Block force(most, 2 * n), of_w(most, n), of_last(most, n), of_these(most, n);
    std::vector<double> memory(2 * WIDTH * static_cast<size_t>(most));
    auto* overlap = reinterpret_cast<Row*>(memory.data());
    of_last.count = basis.size - basis.last_step;
    times(a.M, 1.0, a.links, Rows{w.data + n, w.stride, w.count}, of_w);
    times(a.M, 1.0, a.links, Rows{basis.vectors[basis.last_step] + n, basis.vectors.stride, of_last.count}, of_last);
    while (true) {
        double largest, value[WIDTH], vectors[WIDTH][WIDTH];
        const Gram gram = orthogonalise(a, w, of_w, basis, force, largest);
        Gram diagonal = gram;
        eigh(diagonal, value, vectors);
        const double most_value = *std::max_element(value, value + gram.count);
        const double least = 1e-20 * std::max({most_value, largest * largest, 1e-300});
        const auto kept =
            static_cast<int>(std::count_if(value, value + gram.count, [&](double x) { return x > least; }));
        exhausted = kept == 0 || basis.size + most > basis.vectors.count - most;
        if (exhausted || basis.size >= look) return gram;
        for (int column = 0, row = basis.size; column < gram.count; ++column) {
            if (value[column] <= least) continue;
            const double scale = 1.0 / std::sqrt(value[column]);
            double* out = basis.vectors[row++];
            std::fill_n(out, 2 * n, 0.0);
            for (int v = 0; v < gram.count; ++v) {
                const double *from = w[v], factor = scale * vectors[v][column];
                for (int i = 0; i < 2 * n; ++i) out[i] += factor * from[i];
            }
        }
        w.count = force.count = of_w.count = of_these.count = kept;
        const Rows these{basis.vectors[basis.size], basis.vectors.stride, kept};
        const Rows both{basis.vectors[basis.last_step], basis.vectors.stride, basis.size - basis.last_step + kept};
        forward(a, these, w, force, of_these);
        products(both, force, 2 * n, overlap);
        for (int i = 0; i < both.count; ++i)
            for (int j = 0; j < kept; ++j) basis.projected[basis.last_step + i][basis.size + j] = overlap[i][j];
        project_out(w, overlap, both, 2 * n);
        for (int m = 0; m < kept; ++m)
            for (int i = 0; i < n; ++i) of_w[m][i] = force[m][n + i];  // M y = −M x is known
        project_out(of_w, overlap, of_last, n);
        project_out(of_w, overlap + of_last.count, of_these, n);
        std::swap(of_last, of_these);
        basis.last_step = basis.size;
        basis.size += kept;
    }
}

}  // namespace southwell
