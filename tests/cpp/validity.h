// A checker of meshes that shares nothing with the library: maps and union-find, slow and plain.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace validity {

struct Counts {
    std::size_t faces = 0, crowded_sides = 0, border_sides = 0, degenerate = 0, duplicates = 0, unused = 0, parts = 0;
    std::size_t unoriented = 0;  ///< sides of two faces that run the same way
    long euler = 0;
    double volume = 0, area = 0;
};

inline bool usable(const std::vector<double>& xyz, const std::int32_t* f) {
    for (int k = 0; k < 9; ++k)
        if (!std::isfinite(xyz[3 * f[k / 3] + k % 3])) return false;
    return f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
}

/// Of the faces of three distinct finite corners.
inline Counts counts_of(const std::vector<double>& xyz, const std::vector<std::int32_t>& faces) {
    Counts out;
    std::map<std::array<std::int32_t, 2>, std::array<int, 2>> sides;  // uses either way
    std::set<std::array<std::int32_t, 3>> seen;
    std::vector<std::int32_t> root(xyz.size() / 3);
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](std::int32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    std::vector<bool> used(root.size(), false);
    for (std::size_t i = 0; i < faces.size(); i += 3) {
        const std::int32_t* f = &faces[i];
        if (!usable(xyz, f)) continue;
        ++out.faces;
        double e[2][3], n[3], p[3];
        for (int j = 0; j < 3; ++j) {
            p[j] = xyz[3 * f[0] + j];
            e[0][j] = xyz[3 * f[1] + j] - p[j], e[1][j] = xyz[3 * f[2] + j] - p[j];
        }
        for (int j = 0; j < 3; ++j)
            n[j] = e[0][(j + 1) % 3] * e[1][(j + 2) % 3] - e[0][(j + 2) % 3] * e[1][(j + 1) % 3];
        const double area = std::hypot(n[0], n[1], n[2]) / 2;
        out.area += area;
        out.volume += (p[0] * n[0] + p[1] * n[1] + p[2] * n[2]) / 6;
        out.degenerate += area <= 1e-12 * (std::pow(std::hypot(e[0][0], e[0][1], e[0][2]), 2) +
                                           std::pow(std::hypot(e[1][0], e[1][1], e[1][2]), 2));
        std::array<std::int32_t, 3> key{f[0], f[1], f[2]};
        std::sort(key.begin(), key.end());
        out.duplicates += !seen.insert(key).second;
        for (int k = 0; k < 3; ++k) {
            const std::int32_t a = f[k], b = f[(k + 1) % 3];
            ++sides[{std::min(a, b), std::max(a, b)}][a < b];
            root[find(a)] = find(b);
            used[a] = true;
        }
    }
    for (const auto& [_, uses] : sides) {
        out.crowded_sides += uses[0] + uses[1] > 2;
        out.border_sides += uses[0] + uses[1] == 1;
        out.unoriented += uses[0] == 2 || uses[1] == 2;
    }
    for (std::size_t v = 0; v < used.size(); ++v) {
        out.unused += !used[v];
        out.parts += used[v] && find(static_cast<std::int32_t>(v)) == static_cast<std::int32_t>(v);
    }
    out.euler =
        static_cast<long>(used.size() - out.unused) - static_cast<long>(sides.size()) + static_cast<long>(out.faces);
    return out;
}

}  // namespace validity
