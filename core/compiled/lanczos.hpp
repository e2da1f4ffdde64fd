// The operator of lanczos.py, with the arrays it refers to.
#pragma once

#include "../spectrum/krylov.hpp"
#include "trees.hpp"

namespace southwell {

// A⁻¹S; see krylov.Operator.
struct LanczosOperator {
    Doubles M, C, K;
    LinkArrays links;
    Doubles flexibility, transfer, reaction, massive, lever;

    template <int D>
    Operator<D> sized_as() const {
        const auto m = elements_of<D>(K, K.shape(0));
        return {elements_of<D>(M, m.n),
                elements_of<D>(C, m.n),
                m,
                links_of(links, m.n),
                factors_of<D>(flexibility, transfer, reaction, m.n),
                massive.size() ? items<Matrix6>(massive, m.n) : nullptr,
                massive.size() ? items<Matrix6>(lever, m.n) : nullptr};
    }

    // Remove the motion without inertia from y (k, n).
    void keep_massive(py::array& y) const {
        sized(K, [&](auto D) {
            const auto a = sized_as<D>();
            const Rows rows = writable_rows(y, a.size());
            const WithoutLock unlocked;
            southwell::keep_massive(a, rows);
            return 0;
        });
    }

    // A⁻¹S v for the rows of v (k, 2n).
    Doubles forward(const py::array& v) const {
        return sized(K, [&](auto D) {
            const auto a = sized_as<D>();
            const int n = a.size();
            const Rows from = rows_of(v, 2 * n);
            Doubles w({from.count, 2 * n});
            const WithoutLock unlocked;
            Block force(from.count, 2 * n), My(from.count, n);
            southwell::forward(a, from, Rows{w.mutable_data(), 2 * n, from.count}, force, My);
            return w;
        });
    }

    // See krylov.extend: w, basis and projected are changed; the Gram matrix, the new size and last_step, and exhausted.
    py::tuple extend(py::array& w, py::array& basis, py::array& projected, int size, int last_step, int look) const {
        return sized(K, [&](auto D) {
            const auto a = sized_as<D>();
            Rows rows = writable_rows(w, 2 * a.size());
            Basis grown{writable_rows(basis, 2 * a.size()), writable_rows(projected, projected.shape(0)), size,
                        last_step};
            if (rows.count < 1 || rows.count > WIDTH || last_step < 0 || size < last_step ||
                size > grown.vectors.count || grown.projected.count < std::min(look + rows.count, grown.vectors.count))
                throw std::invalid_argument("a block has at most eight vectors, and the basis and its projection room");
            bool exhausted = false;
            const Gram gram = [&] {
                const WithoutLock unlocked;
                return southwell::extend(a, rows, grown, look, exhausted);
            }();
            Doubles out({gram.count, gram.count});
            for (int i = 0; i < gram.count; ++i)
                for (int j = 0; j < gram.count; ++j) out.mutable_at(i, j) = gram.item[i][j];
            return py::make_tuple(out, grown.size, grown.last_step, exhausted);
        });
    }
};

}  // namespace southwell
