// The module that Python imports; setup.py sets MODULE, its name, and SOURCES, the digest of the sources. kernels.pyi has the signatures.
#include "elements.hpp"
#include "lanczos.hpp"
#include "trees.hpp"

namespace southwell {

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
inline bool processor_has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#else
inline bool processor_has_avx2() { return false; }
#endif

inline void define(py::module_& m) {
    m.def("sources", [] { return SOURCES; });
    m.def("processor_has_avx2", &processor_has_avx2);

    m.def("skew", each<Matrix<3, 3>, Vector3>(skew));
    m.def("inverse", each<Pose, Pose>(inverse));
    m.def("adjoint", each<Matrix6, Pose>(adjoint));
    m.def("ad", each<Matrix6, Vector6>(ad));
    m.def("coadjoint", each<Matrix6, Vector6>(coadjoint));
    m.def("exp", each<Pose, Vector6>(exp));
    m.def("log", each<Vector6, Pose>(log));
    m.def("tangent", each<Matrix6, Vector6>(tangent));
    m.def("tangent_inverse", each<Matrix6, Vector6>(tangent_inverse));

    py::class_<LawArrays>(m, "StrainLaws", py::module_local())
        .def(py::init<bool, Doubles, Doubles, Doubles, Doubles, Doubles>());
    py::class_<BeamArrays>(m, "Beams", py::module_local())
        .def(py::init<const LawArrays&, Indices, Doubles, Doubles, Doubles, Doubles, Doubles, Doubles, Doubles,
                      Doubles>());
    m.def("relative_pencil", &relative_pencil);
    m.def("respond", &respond);

    py::class_<LinkArrays>(m, "Links", py::module_local()).def(py::init<Indices, Doubles, Doubles>());
    m.def("tree_parts", &tree_parts);
    m.def("gathered", &gathered);
    m.def("tree_sum", &tree_sum);
    m.def("displaced", &displaced);
    m.def("placed", &placed);
    m.def("product", &product);
    m.def("twists", &twists);
    m.def("factor", &factor);
    m.def("solve", &solve_in_place);
    m.def("negative_pivots", &negative);
    py::class_<LanczosOperator>(m, "Operator", py::module_local())
        .def(py::init<Doubles, Doubles, Doubles, const LinkArrays&, Doubles, Doubles, Doubles, Doubles, Doubles>())
        .def("keep_massive", &LanczosOperator::keep_massive)
        .def("forward", &LanczosOperator::forward)
        .def("extend", &LanczosOperator::extend);
}

}  // namespace southwell

#define DEFINE(name) \
    PYBIND11_MODULE(name, m) { southwell::define(m); }
DEFINE(MODULE)
