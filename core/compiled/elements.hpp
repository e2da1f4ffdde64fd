// Elements: what Python calls of core/element.
#pragma once

#include "../element/beam.hpp"
#include "arrays.hpp"

namespace southwell {

// Strain laws, with the arrays they refer to.
struct LawArrays {
    bool body_fixed;
    Doubles undeformed, shortening, mean, slope, eta;
    py::ssize_t n = eta.size() / 6;
    StrainLaws law{body_fixed,
                   items<Pose>(undeformed, n),
                   items<Matrix6>(shortening, n),
                   items<Matrix6>(mean, n),
                   items<Matrix<6, 12>>(slope, n),
                   items<Vector6>(eta, n)};
};

// Beams, with the arrays they refer to.
struct BeamArrays {
    LawArrays of_law;
    Indices first;
    Doubles stiffness, preload, inner_preload, zeta0, shape, bubble, mass, force;
    Beams beams = checked();
    bool loaded = std::any_of(force.data(), force.data() + force.size(), [](double f) { return f != 0.0; });

    Beams checked() const {
        const py::ssize_t n = of_law.n, points = zeta0.size() / 6;
        if (first.size() != n + 1 || first.at(0) != 0 || first.at(n) != points)
            throw std::invalid_argument("the points do not belong to the elements");
        return {static_cast<int>(n),
                points > 0,
                first.data(),
                of_law.law,
                items<Matrix6>(stiffness, n),
                items<Vector6>(preload, n),
                points ? items<Vector6>(inner_preload, n) : nullptr,
                items<Vector6>(zeta0, points),
                items<Matrix6>(shape, points),
                items<Matrix6>(bubble, points),
                items<Matrix6>(mass, points),
                items<Vector3>(force, points)};
    }

    int size() const { return beams.inner ? 18 : 12; }
};

// Residual (n, d), M, C and remainder (n, d, d), spring (n, 6, 6); see beams.RelativePencil.
struct RelativePencil {
    Doubles residual, M, C, remainder, spring;

    RelativePencil(int n, int d)
        : residual({n, d}), M({n, d, d}), C({n, d, d}), remainder({n, d, d}), spring({n, 6, 6}) {}

    // Store the pencil of element k, without β unless it has that.
    void set(int k, const ElementPencil& element) {
        sized(M, [&](auto D) {
            for (int i = 0; i < D; ++i) fill<Vector<D>>(residual)[k][i] = element.f[i];
            fill<Matrix<D, D>>(M)[k] = block<D, D>(element.M, 0, 0);
            fill<Matrix<D, D>>(C)[k] = block<D, D>(element.C, 0, 0);
            fill<Matrix<D, D>>(remainder)[k] = block<D, D>(element.K, 0, 0);
            return 0;
        });
        fill<Matrix6>(spring)[k] = element.spring;
    }
};

inline Vector6 coordinates(const py::array& beta, int k) {
    return beta.size() ? reinterpret_cast<const Vector6*>(beta.data())[k] : Vector6{};
}

// The pencils of all elements at poses x (n, 4, 4), β (n, 6 or 0), in frames (n, 6), under gravity (n, 6), with axes (n, 3, 3).
inline py::tuple relative_pencil(const BeamArrays& of, const py::array& x, const py::array& beta,
                                 const py::array& frame, const py::array& fall, const py::array& axes, bool geometric) {
    const Beams& beams = of.beams;
    const int n = beams.elements;
    const Pose* pose = items<Pose>(x, n);
    const Vector6 *frames = items<Vector6>(frame, n), *falls = items<Vector6>(fall, n);
    const auto* turns = items<Matrix<3, 3>>(axes, n);
    check(beta, beams.inner ? 6 * n : 0);
    RelativePencil out(n, of.size());
    {
        const WithoutLock unlocked;
        for (int k = 0; k < n; ++k)
            out.set(k, element_pencil(beams, k, pose[k], coordinates(beta, k), {frames[k], falls[k], turns[k]},
                                      geometric, of.loaded));
    }
    return py::make_tuple(out.residual, out.M, out.C, out.remainder, out.spring);
}

// Strain (n, 6), its rate (n, 6, 12) and the geometric stiffness (n, 12, 12) of forces s and on_eta (n, 6).
inline py::tuple respond(const LawArrays& of, const py::array& x, const py::array& beta, const py::array& s,
                         const py::array& on_eta) {
    const Pose* pose = items<Pose>(x, of.n);
    const Vector6 *force = items<Vector6>(s, of.n), *conjugate = items<Vector6>(on_eta, of.n);
    if (beta.size()) check(beta, 6 * of.n);
    const py::ssize_t n = of.n;
    Doubles epsilon({n, py::ssize_t{6}}), rate(Shape{n, 6, 12}), curvature(Shape{n, 12, 12});
    for (int k = 0; k < n; ++k) {
        const RelativePose at(pose[k]);
        const Strain e = strain(of.law, k, at, coordinates(beta, k));
        auto geometric = Matrix<12, 12>::zero();
        add_curvature(of.law, k, at, e, force[k], conjugate[k], geometric);
        fill<Vector6>(epsilon)[k] = e.strain, fill<Matrix<6, 12>>(rate)[k] = e.rate,
        fill<Matrix<12, 12>>(curvature)[k] = geometric;
    }
    return py::make_tuple(epsilon, rate, curvature);
}

}  // namespace southwell
