// Trees: what Python calls of core/tree.
#pragma once

#include <algorithm>

#include "../tree/elimination.hpp"
#include "../tree/tree.hpp"
#include "elements.hpp"

namespace southwell {

// A matrix of n elements, (n, D, D).
template <int D>
ElementMatrices<D> elements_of(const py::array& a, py::ssize_t n) {
    return {items<Matrix<D, D>>(a, n), static_cast<int>(n)};
}

// The links of a tree, with the arrays they refer to; see links.hpp.
struct LinkArrays {
    Indices parent;
    Doubles to_child, clamped;
    int n = static_cast<int>(parent.size());
    std::vector<bool> leaf = leaves();  // of the nodes
    Links links{n, parent.data(), items<Matrix6>(to_child, n), clamped.size() ? items<Matrix6>(clamped, n) : nullptr};

    std::vector<bool> leaves() const {
        std::vector<bool> out(n + 1, true);
        for (int k = 0; k < n; ++k) {
            if (parent.at(k) < 0 || parent.at(k) > k)
                throw std::invalid_argument("a parent must come before its child");
            out[parent.at(k)] = false;
        }
        return out;
    }
};

// The links of a matrix of n elements.
inline const Links& links_of(const LinkArrays& of, py::ssize_t n) {
    if (of.links.n != n) throw std::invalid_argument("the tree has another number of links than the matrix");
    return of.links;
}

// Vectors as the rows of an array (k, length).
inline Rows rows_of(const py::array& a, py::ssize_t length) {
    if (a.ndim() != 2 || a.shape(1) != length)
        throw std::invalid_argument("vectors are not of the length of the matrix");
    check(a, a.size());
    return {const_cast<double*>(reinterpret_cast<const double*>(a.data())), static_cast<long>(length),
            static_cast<int>(a.shape(0))};
}

inline Rows writable_rows(py::array& a, py::ssize_t length) {
    a.mutable_data();  // an error unless it can be written to
    return rows_of(a, length);
}

// Elements and nodes at a shape, before assembly: RelativePencil, and g, C, K of the nodes.
inline py::tuple tree_parts(const BeamArrays& of, const py::array& nodes, const py::array& relative,
                            const py::array& corner, const py::array& beta, const py::array& lumps,
                            const py::array& force, const Indices& parent, double omega, const py::array& gravity,
                            bool geometric) {
    const Beams& beams = of.beams;
    const int n = beams.elements;
    const Pose *pose = items<Pose>(nodes, n + 1), *between = items<Pose>(relative, n), *end = items<Pose>(corner, n);
    const Matrix6* lump = items<Matrix6>(lumps, n + 1);
    const Vector3 *push = items<Vector3>(force, n + 1), *g0 = items<Vector3>(gravity, 1);
    if (parent.size() != n) throw std::invalid_argument("the tree has another number of links than elements");
    check(beta, beams.inner ? 6 * n : 0);
    RelativePencil out(n, of.size());
    Doubles g({n + 1, 6}), C({n + 1, 6, 6}), K({n + 1, 6, 6});
    {
        const WithoutLock unlocked;
        std::vector<Surroundings> around(n + 1);
        for (int k = 0; k <= n; ++k) {
            around[k] = surroundings(pose[k], omega, *g0);
            const Inertial node = node_pencil(lump[k], push[k], around[k], geometric);
            fill<Vector6>(g)[k] = node.g, fill<Matrix6>(C)[k] = node.C, fill<Matrix6>(K)[k] = node.K;
        }
        for (int k = 0; k < n; ++k)
            out.set(k, element_pencil(beams, k, between[k] * end[k], coordinates(beta, k), around[parent.at(k)],
                                      geometric, of.loaded));
    }
    return py::make_tuple(out.residual, out.M, out.C, out.remainder, out.spring, g, C, K);
}

// Loads (n, d) on (ρ, β) from those of the elements (n, D) and nodes (n + 1, 6).
inline Doubles gathered(const LinkArrays& of, const py::array& f, const py::array& g) {
    const int n = of.links.n, d = static_cast<int>(f.size() / std::max(n, 1)) - 6;
    Doubles out({n, d});
    gather(of.links, items<double>(f, py::ssize_t{n} * (d + 6)), items<Vector6>(g, n + 1), d, out.mutable_data());
    return out;
}

// Add springs and nodes to the elements' M, C and K, in place. The part of a node belongs to the first element that begins
// there, or to the one that ends there if it is a leaf.
inline void tree_sum(const LinkArrays& of, py::array& M, py::array& C, py::array& K, const py::array& spring,
                     const py::array& lumps, const py::array& of_C, const py::array& of_K) {
    sized(M, [&](auto D) {
        const Links& links = links_of(of, M.shape(0));
        const int n = links.n;
        const Matrix6* springs = items<Matrix6>(spring, n);
        auto *mass = writable<Matrix<D, D>>(M, n), *gyroscopic = writable<Matrix<D, D>>(C, n);
        auto* stiffness = writable<Matrix<D, D>>(K, n);
        const Matrix6* on_nodes[3] = {items<Matrix6>(lumps, n + 1), items<Matrix6>(of_C, n + 1),
                                      items<Matrix6>(of_K, n + 1)};
        const WithoutLock unlocked;
        for (int k = 0; k < n; ++k) add(springs[k], 6, 6, stiffness[k]);
        for (auto [matrix, node] :
             {std::pair{mass, on_nodes[0]}, {gyroscopic, on_nodes[1]}, {stiffness, on_nodes[2]}}) {
            std::vector<bool> waiting(n + 1, true);
            waiting[0] = false;  // node 0 does not move
            for (int k = 0; k < n; ++k) {
                const auto a = links.parent[k];
                if (waiting[a]) add(node[a], 0, 0, matrix[k]);
                waiting[a] = false;
                if (of.leaf[k + 1]) add_at_end(links.to_child[k], node[k + 1], matrix[k]);
            }
        }
        return 0;
    });
}

// The relative poses (n, 4, 4) after a step (n, 6 or 12) of twists of the nodes 1 … n.
inline Doubles displaced(const Indices& parent, const py::array& relative, const py::array& step) {
    const int n = static_cast<int>(parent.size()), width = static_cast<int>(step.shape(1));
    Doubles out({n, 4, 4});
    std::copy_n(items<Pose>(relative, n), n, fill<Pose>(out));
    displace(parent.data(), items<double>(step, n * width), width, n, fill<Pose>(out));
    return out;
}

// The poses (n + 1, 4, 4) of the nodes from that of node 0 and the relative ones (n, 4, 4).
inline Doubles placed(const Indices& parent, const py::array& first, const py::array& relative) {
    const int n = static_cast<int>(parent.size());
    Doubles nodes({n + 1, 4, 4});
    fill<Pose>(nodes)[0] = *items<Pose>(first, 1);
    place(parent.data(), items<Pose>(relative, n), n, fill<Pose>(nodes));
    return nodes;
}

// Products (k, dn) of a symmetric (sign 1) or skew (−1) matrix with the rows of x (k, dn).
inline Doubles product(const py::array& matrix, double sign, const LinkArrays& links, const py::array& x) {
    return sized(matrix, [&](auto D) {
        const auto m = elements_of<D>(matrix, matrix.shape(0));
        const Rows from = rows_of(x, m.n * (D - 6));
        Doubles out({from.count, m.n * (D - 6)});
        const Rows to{out.mutable_data(), from.stride, from.count};
        const WithoutLock unlocked;
        times(m, sign, links_of(links, m.n), from, to);
        return out;
    });
}

// Replace ρ by ξ_b in vectors x (k, n, d), in place.
inline void twists(const LinkArrays& links, py::array& x) {
    if (x.ndim() != 3) throw std::invalid_argument("vectors must be (k, n, d)");
    const auto n = x.shape(1), d = x.shape(2);
    double* data = writable<double>(x, x.size());
    const WithoutLock unlocked;
    to_twists(links_of(links, n), static_cast<int>(d), {data, static_cast<long>(n * d), static_cast<int>(x.shape(0))});
}

// Factors of K: the worst pivot (see ``invert``), flexibility, transfer, reaction.
inline py::tuple factor(const py::array& K, const LinkArrays& links) {
    return sized(K, [&](auto D) {
        constexpr int d = D - 6;
        const auto m = elements_of<D>(K, K.shape(0));
        Doubles flexibility({m.n, d, d}), transfer({m.n, 6, d}), reaction({m.n, d, 6});
        const Factors<D> out{fill<Matrix<d, d>>(flexibility), fill<Matrix<6, d>>(transfer),
                             fill<Matrix<d, 6>>(reaction)};
        const int kind = [&] {
            const WithoutLock unlocked;
            return eliminate(m, links_of(links, m.n), out);
        }();
        return py::make_tuple(kind, flexibility, transfer, reaction);
    });
}

// Factors that lie in NumPy's arrays; they are only read.
template <int D>
Factors<D> factors_of(const py::array& flexibility, const py::array& transfer, const py::array& reaction, int n) {
    constexpr int d = D - 6;
    return {const_cast<Matrix<d, d>*>(items<Matrix<d, d>>(flexibility, n)),
            const_cast<Matrix<6, d>*>(items<Matrix<6, d>>(transfer, n)),
            const_cast<Matrix<d, 6>*>(items<Matrix<d, 6>>(reaction, n))};
}

// Replace the loads x (k, dn) by the displacements.
inline void solve_in_place(const py::array& flexibility, const py::array& transfer, const py::array& reaction,
                           const LinkArrays& of, py::array& x) {
    const auto solve_all = [&](auto D) {
        const Links& links = links_of(of, flexibility.shape(0));
        const auto factors = factors_of<D>(flexibility, transfer, reaction, links.n);
        const Rows rows = writable_rows(x, links.n * (D - 6));
        const WithoutLock unlocked;
        solve(factors, links, rows);
        return 0;
    };
    sized(flexibility, solve_all, 6);
}

inline int negative(const py::array& K, const py::array& C, const py::array& M, const LinkArrays& links, double omega) {
    return sized(K, [&](auto D) {
        const auto m = elements_of<D>(K, K.shape(0)), c = elements_of<D>(C, m.n), mass = elements_of<D>(M, m.n);
        const WithoutLock unlocked;
        return negative_pivots(m, c, mass, links_of(links, m.n), omega);
    });
}

}  // namespace southwell
