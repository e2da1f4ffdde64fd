// Extrapolation of values, each of ``width`` numbers, given at a few abscissae x, to x = 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../tree/matrices.hpp"

namespace southwell {

// Degree of the polynomial to extrapolate with; the latest values are the last.
//
// The terms of Newton's interpolation through the latest values, and the next to latest, and so on, decrease up to the degree at
// which rounding errors dominate. The polynomial ends before the smallest term.
inline int degree_of(const double* x, Rows values) {
    const int k = values.count, width = static_cast<int>(values.stride);
    std::vector<double> of(values.data, values.data + static_cast<size_t>(k) * width);  // divided differences
    double reach = 1.0, smallest = 0.0;
    int found = 0;
    for (int order = 1; order < k; ++order) {
        reach *= -x[k - order];  // the product of 0 − x over the points before
        double largest = 0.0;
        for (int i = k - 1; i >= order; --i) {
            double *here = of.data() + static_cast<size_t>(i) * width, *before = here - width;
            const double scale = 1.0 / (x[i] - x[i - order]);
            for (int c = 0; c < width; ++c) here[c] = scale * (here[c] - before[c]);
        }
        const double* last = of.data() + static_cast<size_t>(k - 1) * width;
        for (int c = 0; c < width; ++c) largest = std::max(largest, std::abs(last[c]));
        const double term = std::abs(reach) * largest;
        if (order == 1 || term < smallest) smallest = term, found = order - 1;
    }
    return k > 1 ? std::max(found, 1) : 0;
}

// The polynomial of this degree, fitted by least squares, at zero: Σ p_j(0) Σ p_j(x_i) y_i over polynomials p_j that are
// orthonormal on the abscissae (Forsythe, J. SIAM 5, 1957, 74).
inline void at_zero(const double* x, Rows values, int degree, double* out) {
    const int k = values.count, width = static_cast<int>(values.stride);
    std::vector<std::vector<double>> p;  // of each polynomial: its values on the abscissae, then at zero
    std::vector<double> next(k + 1, 1.0), weight(k, 0.0);
    double largest = 0.0;
    for (int i = 0; i < k; ++i) largest = std::max(largest, std::abs(x[i]));
    for (int j = 0; j <= degree; ++j) {
        for (int pass = 0; pass < 2; ++pass) {  // the second for rounding
            for (const auto& q : p) {
                double overlap = 0.0;
                for (int i = 0; i < k; ++i) overlap += next[i] * q[i];
                for (int i = 0; i <= k; ++i) next[i] -= overlap * q[i];
            }
        }
        double square = 0.0;
        for (int i = 0; i < k; ++i) square += next[i] * next[i];
        for (double& value : next) value /= std::sqrt(square);
        for (int i = 0; i < k; ++i) weight[i] += next[k] * next[i];
        p.push_back(next);
        for (int i = 0; i < k; ++i) next[i] *= x[i] / largest;
        next[k] = 0.0;
    }
    std::fill_n(out, width, 0.0);
    for (int i = 0; i < k; ++i)
        for (int c = 0; c < width; ++c) out[c] += weight[i] * values[i][c];
}

}  // namespace southwell
