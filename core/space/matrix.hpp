// Matrices of fixed size, by rows, and vectors. They are values: the compiler unrolls and vectorises their loops.
#pragma once

#include <cmath>

namespace southwell {

template <int N>
struct Vector {
    double item[N];

    double& operator[](int i) { return item[i]; }
    const double& operator[](int i) const { return item[i]; }
};

template <int R, int C>
struct Matrix {
    double row[R][C];

    double* operator[](int i) { return row[i]; }
    const double* operator[](int i) const { return row[i]; }

    static Matrix zero() {
        Matrix out;
        for (int i = 0; i < R; ++i)
            for (int j = 0; j < C; ++j) out[i][j] = 0.0;
        return out;
    }

    static Matrix unit() {
        Matrix out = zero();
        for (int i = 0; i < R; ++i) out[i][i] = 1.0;
        return out;
    }
};

using Vector3 = Vector<3>;
using Vector6 = Vector<6>;
using Matrix6 = Matrix<6, 6>;

template <int R, int N, int C>
Matrix<R, C> operator*(const Matrix<R, N>& a, const Matrix<N, C>& b) {
    Matrix<R, C> out;
    for (int i = 0; i < R; ++i) {
        double sum[C] = {};
        for (int k = 0; k < N; ++k)
#pragma omp simd
            for (int j = 0; j < C; ++j) sum[j] += a[i][k] * b[k][j];
        for (int j = 0; j < C; ++j) out[i][j] = sum[j];
    }
    return out;
}

// Add aᵀ b to ``out``.
template <int N, int R, int C>
void add_transposed_times(const Matrix<N, R>& a, const Matrix<N, C>& b, Matrix<R, C>& out) {
    for (int i = 0; i < R; ++i) {
        double sum[C];
        for (int j = 0; j < C; ++j) sum[j] = out[i][j];
        for (int k = 0; k < N; ++k)
#pragma omp simd
            for (int j = 0; j < C; ++j) sum[j] += a[k][i] * b[k][j];
        for (int j = 0; j < C; ++j) out[i][j] = sum[j];
    }
}

// aᵀ b
template <int N, int R, int C>
Matrix<R, C> transposed_times(const Matrix<N, R>& a, const Matrix<N, C>& b) {
    Matrix<R, C> out = Matrix<R, C>::zero();
    add_transposed_times(a, b, out);
    return out;
}

// aᵀ m a
template <int N, int C>
Matrix<C, C> congruence(const Matrix<N, C>& a, const Matrix<N, N>& m) {
    return transposed_times(a, m * a);
}

template <int R, int C>
Vector<R> operator*(const Matrix<R, C>& a, const Vector<C>& v) {
    Vector<R> out{};
    for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j) out[i] += a[i][j] * v[j];
    return out;
}

// aᵀ v
template <int R, int C>
Vector<C> transposed_times(const Matrix<R, C>& a, const Vector<R>& v) {
    Vector<C> out{};
    for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j) out[j] += a[i][j] * v[i];
    return out;
}

template <int N>
Vector<N> operator+(Vector<N> a, const Vector<N>& b) {
    for (int i = 0; i < N; ++i) a[i] += b[i];
    return a;
}

template <int N>
Vector<N> operator-(Vector<N> a, const Vector<N>& b) {
    for (int i = 0; i < N; ++i) a[i] -= b[i];
    return a;
}

template <int R, int C>
Matrix<R, C> operator-(const Matrix<R, C>& a, const Matrix<R, C>& b) {
    Matrix<R, C> out;
    for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j) out[i][j] = a[i][j] - b[i][j];
    return out;
}

template <int R, int C>
Matrix<R, C> operator*(double factor, const Matrix<R, C>& a) {
    Matrix<R, C> out;
    for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j) out[i][j] = factor * a[i][j];
    return out;
}

template <int R, int C>
Matrix<C, R> transposed(const Matrix<R, C>& a) {
    Matrix<C, R> out;
    for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j) out[j][i] = a[i][j];
    return out;
}

template <int N>
double dot(const Vector<N>& a, const Vector<N>& b) {
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < N; ++i) sum += a[i] * b[i];
    return sum;
}

// The block of m at row i, column j.
template <int R, int C, int N, int K>
Matrix<R, C> block(const Matrix<N, K>& m, int i, int j) {
    Matrix<R, C> out;
    for (int r = 0; r < R; ++r)
        for (int c = 0; c < C; ++c) out[r][c] = m[i + r][j + c];
    return out;
}

// Add m to the block of ``out`` at row i, column j.
template <int R, int C, int N, int K>
void add(const Matrix<R, C>& m, int i, int j, Matrix<N, K>& out) {
    for (int r = 0; r < R; ++r)
        for (int c = 0; c < C; ++c) out[i + r][j + c] += m[r][c];
}

// Copy m to the block of ``out`` at row i, column j.
template <int R, int C, int N, int K>
void put(const Matrix<R, C>& m, int i, int j, Matrix<N, K>& out) {
    for (int r = 0; r < R; ++r)
        for (int c = 0; c < C; ++c) out[i + r][j + c] = m[r][c];
}

// Invert the part of a small matrix from row and column ``first`` on in place, by Gauss–Jordan elimination, no pivoting.
//
// Of [[X, Y], [W, Z]], Z the part to invert, remains [[X − Y Z⁻¹ W, −Y Z⁻¹], [Z⁻¹ W, Z⁻¹]]. Returns 2 if all pivots are
// positive, 1 if some are negative, and 0, with the inversion incomplete, if one is zero or not finite.
template <int N>
int invert(Matrix<N, N>& a, int first) {
    int kind = 2;
    for (int p = first; p < N; ++p) {
        const double pivot = a[p][p];
        if (pivot == 0.0 || !std::isfinite(pivot)) return 0;
        if (pivot < 0.0) kind = 1;
        const double inverse = 1.0 / pivot;
        double row[N];  // of the pivot, scaled
        for (int j = 0; j < N; ++j) row[j] = inverse * a[p][j];
        row[p] = inverse;
        for (int i = 0; i < N; ++i) {
            const double factor = a[i][p];
#pragma omp simd
            for (int j = 0; j < N; ++j) a[i][j] -= factor * row[j];
            a[i][p] = -factor * inverse;
        }
        for (int j = 0; j < N; ++j) a[p][j] = row[j];
    }
    return kind;
}

}  // namespace southwell
