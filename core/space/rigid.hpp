// Rigid motions one at a time; spatial.py has the conventions, and the same for batches.
//
// A twist (v, w) is the dual vector w + εv, ε² = 0, and a function of its ``ad`` is that function of the cross-product matrix W
// of w, continued to dual numbers: with f(W) = 1 + α W + β W², α and β power series in z = w·w, its matrix is [[P, Q], [0, P]],
// P = f(W) and Q the derivative of P as w moves along v. So derivatives of the tangents need no more than those of α and β.
// (Selig, Geometric Fundamentals of Robotics, 2005, ch. 7 and 9.)
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "matrix.hpp"

namespace southwell {

using Pose = Matrix<4, 4>;

// A power series in z with coefficients c[0], c[1], …, and its first and second derivatives, at one z.
struct Series {
    double value, slope, second;
};

constexpr int TERMS = 30;  // (π/2π)^(2·28) = 1e-17: enough for the inverse tangent at a half turn
constexpr double SMALL = 1e-18;

using Coefficients = std::array<double, TERMS>;

// Two power series, α and β.
struct Pair {
    Coefficients alpha, beta;
};

// Coefficients of (−1)ⁿ φ²ⁿ/(2n + order + 1)!: sin φ/φ, (1 − cos φ)/φ² and (φ − sin φ)/φ³ for order 0, 1, 2, with φ² = z.
inline Coefficients sine_like(int order) {
    Coefficients out{};
    double factorial = 1.0;
    for (int k = 2; k <= order + 1; ++k) factorial *= k;
    for (int n = 0; n < TERMS; ++n) {
        out[n] = (n % 2 ? -1.0 : 1.0) / factorial;
        factorial *= (2.0 * n + order + 2.0) * (2.0 * n + order + 3.0);
    }
    return out;
}

// Coefficients b₁, b₂, … of (1 − (φ/2) cot(φ/2))/φ², |B₂ₙ|/(2n)!, from ζ(2n) (n + ½) = Σ ζ(2k) ζ(2n − 2k), k = 1 … n − 1.
inline Coefficients cotangent() {
    Coefficients b{};
    b[0] = 1.0 / 12.0;
    for (int n = 2; n <= TERMS; ++n) {
        for (int k = 1; k < n; ++k) b[n - 1] += b[k - 1] * b[n - k - 1];
        b[n - 1] /= 2.0 * n + 1.0;
    }
    return b;
}

// α and β of the left tangent, and of its inverse.
inline const Pair TANGENT{sine_like(1), sine_like(2)};
inline const Pair INVERSE{Coefficients{-0.5}, cotangent()};
inline const Coefficients SINE = sine_like(0);

// The sum of a power series and of its derivatives, to rounding.
inline Series sum(const Coefficients& c, double z) {
    Series out{0.0, 0.0, 0.0};
    double power = 1.0;
    for (int n = 0; n + 2 < TERMS; ++n) {
        const double value = c[n] * power, slope = (n + 1) * c[n + 1] * power;
        const double second = (n + 1) * (n + 2) * c[n + 2] * power;
        out.value += value, out.slope += slope, out.second += second;
        if (n > 1 && std::max({std::abs(value), std::abs(slope), std::abs(second)}) < SMALL) break;
        power *= z;
    }
    return out;
}

inline Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Vector3 operator*(double factor, const Vector3& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }

inline Vector3 linear(const Vector6& a) { return {a[0], a[1], a[2]}; }

inline Vector3 angular(const Vector6& a) { return {a[3], a[4], a[5]}; }

inline Vector3 position(const Pose& x) { return {x[0][3], x[1][3], x[2][3]}; }

// The cross-product matrix of a.
inline Matrix<3, 3> skew(const Vector3& a) { return {{{0.0, -a[2], a[1]}, {a[2], 0.0, -a[0]}, {-a[1], a[0], 0.0}}}; }

// ad(a) b = a × b
inline Matrix6 ad(const Vector6& twist) {
    Matrix6 out = Matrix6::zero();
    put(skew(angular(twist)), 0, 0, out);
    put(skew(angular(twist)), 3, 3, out);
    put(skew(linear(twist)), 0, 3, out);
    return out;
}

// ad(a)ᵀ f = coadjoint(f) a
inline Matrix6 coadjoint(const Vector6& wrench) {
    Matrix6 out = Matrix6::zero();
    put(skew(linear(wrench)), 0, 3, out);
    put(skew(linear(wrench)), 3, 0, out);
    put(skew(angular(wrench)), 3, 3, out);
    return out;
}

inline Matrix6 adjoint(const Pose& x) {
    Matrix6 out = Matrix6::zero();
    const auto rotation = block<3, 3>(x, 0, 0);
    put(rotation, 0, 0, out);
    put(rotation, 3, 3, out);
    put(skew(position(x)) * rotation, 0, 3, out);
    return out;
}

inline Pose inverse(const Pose& x) {
    Pose out;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) out[i][j] = x[j][i];
        out[i][3] = -(x[0][i] * x[0][3] + x[1][i] * x[1][3] + x[2][i] * x[2][3]);
        out[3][i] = 0.0;
    }
    out[3][3] = 1.0;
    return out;
}

// The pose reached by moving along a twist for unit time.
inline Pose exp(const Vector6& twist) {
    const Vector3 v = linear(twist), w = angular(twist);
    const double z = dot(w, w), s = dot(w, v);
    const double a = sum(SINE, z).value, b = sum(TANGENT.alpha, z).value, c = sum(TANGENT.beta, z).value;
    const Vector3 across = cross(w, v);
    Pose out = Pose::zero();
    put(skew(a * w), 0, 0, out);
    for (int i = 0; i < 3; ++i) {
        out[i][3] = v[i] + b * across[i] + c * (s * w[i] - z * v[i]);
        for (int j = 0; j < 3; ++j) out[i][j] += b * w[i] * w[j];
        out[i][i] += 1.0 - b * z;
    }
    out[3][3] = 1.0;
    return out;
}

// The rotation vector of a pose, of at most half a turn, there in either sense.
//
// The rotation is cos φ 1 + sin φ N + (1 − cos φ) n nᵀ, N the cross-product matrix of the axis n: up to a quarter turn the axis
// follows from the skew part, beyond it from the largest column of n nᵀ, which does not vanish at half a turn.
inline Vector3 rotation_vector(const Pose& x) {
    const Vector3 w{0.5 * (x[2][1] - x[1][2]), 0.5 * (x[0][2] - x[2][0]), 0.5 * (x[1][0] - x[0][1])};
    const double sine = std::sqrt(dot(w, w)), cosine = 0.5 * (x[0][0] + x[1][1] + x[2][2] - 1.0);
    const double angle = std::atan2(sine, cosine);
    if (cosine >= 0.0) return (sine < 1e-8 ? 1.0 : angle / sine) * w;
    int m = 0;
    for (int i = 1; i < 3; ++i)
        if (x[i][i] > x[m][m]) m = i;
    Vector3 n{0.5 * (x[0][m] + x[m][0]), 0.5 * (x[1][m] + x[m][1]), 0.5 * (x[2][m] + x[m][2])};
    n[m] -= cosine;
    return std::copysign(angle / std::sqrt(dot(n, n)), dot(w, n) < 0.0 ? -1.0 : 1.0) * n;
}

// The twist whose exponential is the pose.
inline Vector6 log(const Pose& x) {
    const Vector3 w = rotation_vector(x), p = position(x);
    const double z = dot(w, w), s = dot(w, p), beta = sum(INVERSE.beta, z).value;
    const Vector3 across = cross(w, p);
    Vector6 out;
    for (int i = 0; i < 3; ++i) {
        out[i] = p[i] - 0.5 * across[i] + beta * (s * w[i] - z * p[i]);
        out[3 + i] = w[i];
    }
    return out;
}

// P = 1 + α W + β W² and Q = α V + dα W + β (W V + V W) + dβ W², with W V = v wᵀ − (w·v) 1.
inline Matrix6 function(const Pair& series, const Vector6& twist) {
    const Vector3 v = linear(twist), w = angular(twist);
    const double z = dot(w, w), s = dot(w, v);
    const Series alpha = sum(series.alpha, z), beta = sum(series.beta, z);
    const double d_alpha = 2.0 * s * alpha.slope, d_beta = 2.0 * s * beta.slope;
    Matrix6 out = Matrix6::zero();
    put(skew(alpha.value * w), 0, 0, out);
    put(skew(alpha.value * v + d_alpha * w), 0, 3, out);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            out[i][j] += beta.value * w[i] * w[j];
            out[i][3 + j] += beta.value * (v[i] * w[j] + w[i] * v[j]) + d_beta * w[i] * w[j];
        }
        out[i][i] += 1.0 - beta.value * z;
        out[i][3 + i] -= 2.0 * beta.value * s + d_beta * z;
    }
    put(block<3, 3>(out, 0, 0), 3, 3, out);
    return out;
}

// The left tangent: d exp(ζ) = (tangent(ζ) dζ)^ exp(ζ).
inline Matrix6 tangent(const Vector6& twist) { return function(TANGENT, twist); }

inline Matrix6 tangent_inverse(const Vector6& twist) { return function(INVERSE, twist); }

// The derivative with respect to ζ of tangent(ζ)ᵀ f, or of tangent_inverse(ζ)ᵀ f, at constant f, for TANGENT or INVERSE.
//
// It is [[0, D], [D, dD]], where D is the derivative of Pᵀf with respect to w, and dD D's as (w, f) moves along (v, h).
//
// With u = w × f, p = w·f and q = p w − z f: Pᵀf = f − α u + β q, so
// D = α f× − 2 α' u wᵀ + β (p 1 + w fᵀ − 2 f wᵀ) + 2 β' q wᵀ.
inline Matrix6 transpose_derivative(const Pair& series, const Vector6& twist, const Vector6& wrench) {
    const Vector3 v = linear(twist), w = angular(twist), f = linear(wrench), h = angular(wrench);
    const double z = dot(w, w), s = dot(w, v), p = dot(w, f), dp = dot(v, f) + dot(w, h);
    const Series a = sum(series.alpha, z), b = sum(series.beta, z);
    const Series da{2.0 * s * a.slope, 2.0 * s * a.second, 0.0}, db{2.0 * s * b.slope, 2.0 * s * b.second, 0.0};
    const Vector3 u = cross(w, f), du = cross(v, f) + cross(w, h);
    Matrix<3, 3> D = skew(a.value * f), dD = skew(da.value * f + a.value * h);
    for (int i = 0; i < 3; ++i) {
        const double q = p * w[i] - z * f[i], dq = p * v[i] + dp * w[i] - 2.0 * s * f[i] - z * h[i];
        const double by_w = 2.0 * (b.slope * q - a.slope * u[i] - b.value * f[i]);
        const double d_by_w =
            2.0 * (db.slope * q + b.slope * dq - da.slope * u[i] - a.slope * du[i] - db.value * f[i] - b.value * h[i]);
        D[i][i] += b.value * p;
        dD[i][i] += db.value * p + b.value * dp;
        for (int j = 0; j < 3; ++j) {
            D[i][j] += by_w * w[j] + b.value * w[i] * f[j];
            dD[i][j] += d_by_w * w[j] + by_w * v[j] + (db.value * w[i] + b.value * v[i]) * f[j] + b.value * w[i] * h[j];
        }
    }
    Matrix6 out = Matrix6::zero();
    put(D, 0, 3, out);
    put(D, 3, 0, out);
    put(dD, 3, 3, out);
    return out;
}

}  // namespace southwell
