// The links of a tree, and the two sweeps over it: B outwards and Bᵀ inwards (Park et al. 2010, eq. 3 and 5).
//
// Link k leads from node parent[k] to node k + 1, so that every parent comes before its children; node 0 does not move. With the
// difference ρ of the twists of its ends, in the axes of its end a, the twist of its end b is ξ_b = Ad⁻¹ (ρ + ξ_a). This recursion
// is Y = B v; a wrench at b acts on ρ and, with all that lies beyond, on a: the same recursion inwards is Bᵀ.
#pragma once

#include <cstdint>
#include <vector>

#include "../space/rigid.hpp"

namespace southwell {

struct Links {
    int n;
    const std::int64_t* parent;  // 0 … k
    const Matrix6* to_child;     // Ad⁻¹ of the poses of the ends b in the frames of the ends a
    const Matrix6* clamped;      // projectors of ρ on the directions that joints clamp; null if there are no joints
};

// Vectors as rows of ``stride`` numbers, of which the first ones count.
struct Rows {
    double* data;
    long stride;
    int count;

    double* operator[](int v) const { return data + v * stride; }
};

// Ad⁻¹ (ρ + ξ_a), the twist of end b.
inline Vector6 outwards(const Matrix6& to_child, const double* rho, const Vector6& xi) {
    Vector6 sum;
    for (int i = 0; i < 6; ++i) sum[i] = rho[i] + xi[i];
    return to_child * sum;
}

// Replace ρ by ξ_b = B ρ in vectors of d coordinates a link.
inline void to_twists(const Links& links, int d, Rows x) {
    for (int v = 0; v < x.count; ++v) {
        for (int k = 0; k < links.n; ++k) {
            Vector6 xi{};
            if (const auto a = links.parent[k])
                for (int i = 0; i < 6; ++i) xi[i] = x[v][d * (a - 1) + i];
            xi = outwards(links.to_child[k], x[v] + d * k, xi);
            for (int i = 0; i < 6; ++i) x[v][d * k + i] = xi[i];
        }
    }
}

// Loads on (ρ, β) from those of the elements on (ξ_a, ρ, β) and of the nodes, into rows of d numbers.
inline void gather(const Links& links, const double* of_elements, const Vector6* of_nodes, int d, double* out) {
    std::vector<Vector6> at(of_nodes, of_nodes + links.n + 1);  // of each node and all that lies beyond
    for (int k = links.n - 1; k >= 0; --k) {
        const double* f = of_elements + (d + 6) * k;
        const Vector6 beyond = transposed_times(links.to_child[k], at[k + 1]);
        Vector6& a = at[links.parent[k]];
        for (int i = 0; i < d; ++i) out[d * k + i] = f[6 + i] + (i < 6 ? beyond[i] : 0.0);
        for (int i = 0; i < 6; ++i) a[i] += f[i] + beyond[i];
    }
}

// Poses of the nodes 1 … n from that of node 0 and the relative ones.
inline void place(const std::int64_t* parent, const Pose* relative, int n, Pose* nodes) {
    for (int k = 0; k < n; ++k) nodes[k + 1] = nodes[parent[k]] * relative[k];
}

// Move the ends of the links by the twists of the nodes 1 … n in their axes, the first six of ``width`` numbers a link.
inline void displace(const std::int64_t* parent, const double* step, int width, int n, Pose* relative) {
    std::vector<Pose> from(n + 1, Pose::unit());  // inverse of each node's motion
    for (int k = 0; k < n; ++k) {
        Vector6 twist;
        for (int i = 0; i < 6; ++i) twist[i] = step[width * k + i];
        const Pose motion = exp(twist);
        relative[k] = from[parent[k]] * relative[k] * motion;
        from[k + 1] = inverse(motion);
    }
}

}  // namespace southwell
