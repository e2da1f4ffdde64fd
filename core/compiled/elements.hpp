// Elements: what Python calls of core/element.
#pragma once

#include "../element/beam.hpp"
#include "arrays.hpp"

namespace southwell {

// Strain laws, with the arrays they refer to.
struct LawArrays {
    Doubles undeformed, shortening, mean, slope, eta;
    py::ssize_t n;
    StrainLaws law;

    LawArrays(bool body_fixed, Doubles undeformed_, Doubles shortening_, Doubles mean_, Doubles slope_, Doubles eta_)
        : undeformed(undeformed_),
          shortening(shortening_),
          mean(mean_),
          slope(slope_),
          eta(eta_),
          n(eta_.size() / 6),
          law{body_fixed,
              items<Pose>(undeformed, n),
              items<Matrix6>(shortening, n),
              items<Matrix6>(mean, n),
              items<Matrix<6, 12>>(slope, n),
              items<Vector6>(eta, n)} {}
};

// Beams, with the arrays they refer to.
struct BeamArrays {
    LawArrays of_law;
    Indices first;
    Doubles stiffness, preload, inner_preload, zeta0, shape, bubble, mass, force;
    Beams beams;
    bool loaded;

    BeamArrays(const LawArrays& law, Indices first_, Doubles stiffness_, Doubles preload_, Doubles inner_preload_,
               Doubles zeta0_, Doubles shape_, Doubles bubble_, Doubles mass_, Doubles force_)
        : of_law(law),
          first(first_),
          stiffness(stiffness_),
          preload(preload_),
          inner_preload(inner_preload_),
          zeta0(zeta0_),
          shape(shape_),
          bubble(bubble_),
          mass(mass_),
          force(force_),
          loaded(false) {
        const py::ssize_t n = law.n, points = zeta0.size() / 6;
        if (first.size() != n + 1 || first.at(0) != 0 || first.at(n) != points)
            throw std::invalid_argument("the points do not belong to the elements");
        beams = {static_cast<int>(n),
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
        for (py::ssize_t i = 0; i < force.size(); ++i) loaded = loaded || force.data()[i] != 0.0;
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
        if (residual.shape(1) == 18)
            set_parts<18>(k, element);
        else
            set_parts<12>(k, element);
        fill<Matrix6>(spring)[k] = element.spring;
    }

    template <int D>
    void set_parts(int k, const ElementPencil& element) {
        for (int i = 0; i < D; ++i) fill<Vector<D>>(residual)[k][i] = element.f[i];
        fill<Matrix<D, D>>(M)[k] = block<D, D>(element.M, 0, 0);
        fill<Matrix<D, D>>(C)[k] = block<D, D>(element.C, 0, 0);
        fill<Matrix<D, D>>(remainder)[k] = block<D, D>(element.K, 0, 0);
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

// Strain (n,) of the reference curve at poses x (n, 4, 4) and β (n, 6 or 0), see measures.relative_strain.
inline Doubles relative_strains(const LawArrays& of, const py::array& x, const py::array& beta) {
    const Pose* pose = items<Pose>(x, of.n);
    if (beta.size()) check(beta, 6 * of.n);
    Doubles out(of.n);
    for (int k = 0; k < of.n; ++k) {
        Vector3 found = linear(strain(of.law, k, RelativePose(pose[k]), coordinates(beta, k)).strain);
        if (of.law.body_fixed) found[1] = found[2] = 0.0;
        const Vector3 along = linear(of.law.eta[k]);
        const double length = std::sqrt(dot(along, along));
        out.mutable_data()[k] = length > 0.0 ? std::sqrt(dot(found, found)) / length : 0.0;
    }
    return out;
}

// Strain (n, 6), its rate (n, 6, 12) and the geometric stiffness (n, 12, 12) of forces s and on_eta (n, 6).
inline py::tuple respond(const LawArrays& of, const py::array& x, const py::array& beta, const py::array& s,
                         const py::array& on_eta) {
    const Pose* pose = items<Pose>(x, of.n);
    const Vector6 *force = items<Vector6>(s, of.n), *conjugate = items<Vector6>(on_eta, of.n);
    if (beta.size()) check(beta, 6 * of.n);
    const py::ssize_t n = of.n;
    Doubles found({n, py::ssize_t{6}}), rate(Shape{n, 6, 12}), curvature(Shape{n, 12, 12});
    for (int k = 0; k < n; ++k) {
        const RelativePose at(pose[k]);
        const Strain e = strain(of.law, k, at, coordinates(beta, k));
        auto bent = Matrix<12, 12>::zero();
        add_curvature(of.law, k, at, e, force[k], conjugate[k], bent);
        fill<Vector6>(found)[k] = e.strain, fill<Matrix<6, 12>>(rate)[k] = e.rate,
        fill<Matrix<12, 12>>(curvature)[k] = bent;
    }
    return py::make_tuple(found, rate, curvature);
}

}  // namespace southwell
