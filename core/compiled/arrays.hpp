// NumPy arrays as arrays of small matrices, and back.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "../space/matrix.hpp"

namespace southwell {

namespace py = pybind11;
using Shape = std::vector<py::ssize_t>;
using Doubles = py::array_t<double, py::array::c_style>;
using Indices = py::array_t<std::int64_t, py::array::c_style>;

template <class T>
constexpr py::ssize_t numbers = sizeof(T) / sizeof(double);

// Other threads run Python while this lives: only the memory of arrays may be touched, none may be made or dropped.
using WithoutLock = py::gil_scoped_release;

inline void check(const py::array& a, py::ssize_t expected) {
    if (!py::isinstance<Doubles>(a)) throw py::type_error("an array must be C-contiguous and of type float64");
    if (a.size() != expected)
        throw std::invalid_argument("an array has " + std::to_string(a.size()) + " numbers, not " +
                                    std::to_string(expected));
}

// The ``n`` items of type T in an array.
template <class T>
const T* items(const py::array& a, py::ssize_t n) {
    check(a, n * numbers<T>);
    return reinterpret_cast<const T*>(a.data());
}

// The same, to write to.
template <class T>
T* writable(py::array& a, py::ssize_t n) {
    check(a, n * numbers<T>);
    return reinterpret_cast<T*>(a.mutable_data());
}

template <class T>
T* fill(Doubles& a) {
    return reinterpret_cast<T*>(a.mutable_data());
}

// ``leading`` without its last ``drop`` dimensions, followed by ``trailing``.
inline Shape shape_of(const py::array& leading, int drop, const Shape& trailing) {
    if (leading.ndim() < drop) throw std::invalid_argument("an array has too few dimensions");
    Shape out(leading.shape(), leading.shape() + leading.ndim() - drop);
    out.insert(out.end(), trailing.begin(), trailing.end());
    return out;
}

template <int R, int C>
Shape dimensions(const Matrix<R, C>*) {
    return {R, C};
}
template <int N>
Shape dimensions(const Vector<N>*) {
    return {N};
}
template <class T>
Shape dimensions() {
    return dimensions(static_cast<const T*>(nullptr));
}

// Call f with the size of an element's matrix, 12 or 18, as a constant; ``more``: what a matrix (n, d, d) lacks of it.
template <class F>
auto sized(const py::array& matrix, F f, int more = 0) {
    const auto size = matrix.ndim() == 3 ? matrix.shape(1) + more : 0;
    if (size == 18) return f(std::integral_constant<int, 18>());
    if (size == 12) return f(std::integral_constant<int, 12>());
    throw std::invalid_argument("the matrices of elements must be (n, 12, 12) or (n, 18, 18)");
}

constexpr py::ssize_t MANY = 64;  // items that take longer than to give the lock away and to take it back

// A function of one item for arrays (..., item): the results (..., result).
template <class Out, class In>
auto each(Out (*f)(const In&)) {
    return [f](const py::array_t<double, py::array::c_style | py::array::forcecast>& given) {
        Doubles out(shape_of(given, static_cast<int>(dimensions<In>().size()), dimensions<Out>()));
        const py::ssize_t n = out.size() / numbers<Out>;
        const In* from = items<In>(given, n);
        Out* to = fill<Out>(out);
        std::optional<WithoutLock> unlocked;
        if (n >= MANY) unlocked.emplace();
        for (py::ssize_t k = 0; k < n; ++k) to[k] = f(from[k]);
        return out;
    };
}

}  // namespace southwell
