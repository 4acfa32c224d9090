// What a mesh or cloud holds: counts that tell whether a file is what one thinks it is.
#pragma once

#include <cstddef>

#include "gaussmap/types.h"

namespace gaussmap {

struct Inspection {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    std::size_t non_finite = 0;             ///< vertices with a NaN or infinite coordinate
    std::size_t duplicate_vertices = 0;     ///< finite vertices at the position of an earlier one
    std::size_t isolated_vertices = 0;      ///< vertices of no face (meshes)
    std::size_t degenerate_faces = 0;       ///< repeated index, or no area
    std::size_t duplicate_faces = 0;        ///< same three vertices as an earlier face, in any order
    std::size_t edges = 0;                  ///< distinct undirected edges
    std::size_t boundary_edges = 0;         ///< edges of one face
    std::size_t boundary_loops = 0;         ///< connected parts of the boundary
    std::size_t non_manifold_edges = 0;     ///< edges of three or more faces
    std::size_t non_manifold_vertices = 0;  ///< vertices whose faces do not form one fan, off non-manifold edges
    std::size_t inconsistent_edges = 0;     ///< edges of two faces that run through them the same way
    std::size_t components = 0;             ///< parts connected by edges (faces), isolated vertices not counted
    double minimum[3] = {0, 0, 0};          ///< box of the finite vertices; 0 where there are none
    double maximum[3] = {0, 0, 0};
    double diagonal = 0;
    double area = 0;       ///< of the defined faces
    double mean_edge = 0;  ///< mean length of the distinct finite edges
};

/// Count everything above. Pass no faces for a cloud.
/// \throw std::invalid_argument on an index outside [0, vertices.count).
/// Time O((n + m) log m), memory about 100 bytes a face.
Inspection inspect(Points vertices, Triangles faces = {});

}  // namespace gaussmap
