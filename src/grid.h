// A grid of `around` × `across` parameters (u, v), each direction closed up or open, and the surface over it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analytic.h"
#include "random.h"

namespace gaussmap {

struct Grid {
    int around = 0, across = 0;
    bool closed_around = true, closed_across = true;
};

/// Vertex (row, column) of a grid, 0 ≤ u, v ≤ 1 being its parameters; row/around ≈ u.
struct GridPoint {
    int row = 0;
    double u = 0, v = 0;
};

/// \throw std::invalid_argument naming `function` unless around, across ≥ 3 and their product can be indexed.
void check_grid(const char* function, const Grid& grid);

/// Two triangles a cell, counterclockwise for someone who sees u to the right and v up. Vertex (i, j) is i·across + j.
std::vector<std::int32_t> grid_faces(const Grid& grid);

/// The surface of SurfacePoint point_at(GridPoint). With jitter, (u, v) move; on an open border they stay.
template <class PointAt>
Surface grid_surface(const Grid& grid, const SurfaceOptions& options, PointAt&& point_at) {
    Surface surface = blank_surface(static_cast<std::size_t>(grid.around) * grid.across, grid_faces(grid));
    Random random(options.seed, 0);
    const int steps_u = grid.closed_around ? grid.around : grid.around - 1;
    const int steps_v = grid.closed_across ? grid.across : grid.across - 1;
    std::size_t vertex = 0;
    for (int i = 0; i < grid.around; ++i) {
        const bool end_u = !grid.closed_around && (i == 0 || i == steps_u);
        for (int j = 0; j < grid.across; ++j) {
            const bool border = end_u || (!grid.closed_across && (j == 0 || j == steps_v));
            // Drawn for the border too: how an edge is closed does not change the numbers elsewhere.
            const double du = options.jitter * random.symmetric(), dv = options.jitter * random.symmetric();
            const double u = (i + (border ? 0 : du)) / steps_u, v = (j + (border ? 0 : dv)) / steps_v;
            store_point(surface, vertex++, point_at(GridPoint{i, u, v}));
        }
    }
    add_noise(surface, options);
    return surface;
}

}  // namespace gaussmap
