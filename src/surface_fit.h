// A coarse mesh brought nearer to a fine one: samples of the fine surface pull at the coarse vertices, sides are
// flipped, and vertices go from where they are little needed to where the distance is great. After Hoppe, DeRose,
// Duchamp, McDonald, Stuetzle, "Mesh Optimization", SIGGRAPH 1993.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"
#include "ring_mesh.h"

namespace gaussmap {

/// Points of the fine surface, each with the face of the coarse one that is closest to it, as far as is known.
struct FitSamples {
    std::vector<Vec3> point;
    std::vector<double> area;  ///< that each stands for
    std::vector<std::int32_t> face;
    std::vector<Vec3> weights;  ///< of the face's corners at the closest point
    std::vector<double> squared_distance;
    std::vector<std::int32_t> anchor;  ///< of each vertex of the coarse mesh: the sample nearest to it
};

/// The samples of each face: those of f are items[begin[f]] … items[begin[f + 1] − 1].
struct FaceSamples {
    std::vector<std::int32_t> begin, items;
    template <class Body>
    void for_each(std::int32_t f, Body&& body) const {
        for (std::int32_t k = begin[f]; k < begin[f + 1]; ++k) body(items[k]);
    }
};
FaceSamples by_face(const FitSamples& samples, std::size_t faces);

/// What is made small: Σ area · distance^power, over a scale of distances.
struct FitNorm {
    double power = 2;
    double scale = 1;  ///< 1 / distance at which powers agree

    double weight(double squared_distance) const {
        return power == 2 ? 1 : std::pow(std::sqrt(squared_distance) * scale, power - 2);
    }
    double cost(double squared_distance) const { return squared_distance * weight(squared_distance); }
};

/// Samples of a surface: its vertices and its faces' centres. Vertices alone fitted 20 % worse even where there were 25
/// of them a face. \param joined  the vertex of the coarse mesh that each vertex of the fine one joined.
FitSamples samples_of(const std::vector<Vec3>& positions, const std::vector<std::int32_t>& corners,
                      const std::vector<std::int32_t>& joined, const RingMesh& coarse);

/// Find the closest faces again, walking from those that were.
void assign(const RingMesh& coarse, FitSamples& samples, const Execution& run);
/// The same for one sample, from the faces around a vertex.
void assign_around(const RingMesh& coarse, FitSamples& samples, std::size_t sample, std::int32_t vertex);

/// Move the free vertices of the coarse mesh.
void move_vertices(RingMesh& coarse, FitSamples& samples, const FitNorm& norm, const Execution& run);

/// Flip sides where that brings the samples of their faces nearer. \return the number of flips.
std::size_t flip_sides(RingMesh& coarse, FitSamples& samples, const FitNorm& norm);

/// Take vertices from where they are needed least, and put as many where they help most: at most `share` of them.
/// \return the number of vertices.
std::size_t swap_vertices(RingMesh& coarse, FitSamples& samples, const FitNorm& norm, double share);

}  // namespace gaussmap
