// Values of a mesh's vertices, faces and corners, handed on to a decimated one.
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/decimate.h"
#include "gaussmap/io.h"

namespace cli {

/// Sides at which the corners' texture coordinates of two faces differ: a byte a corner, the side opposite to it. Empty
/// where there are none, or no texture coordinates.
std::vector<std::uint8_t> texture_seams(const gaussmap::Geometry& geometry);

/// Values that are interpolated: normals, properties of vertices, texture coordinates of corners.
bool has_values_to_carry(const gaussmap::Geometry& geometry);

/// The decimated mesh with the values of the one it was made from: those of vertices and corners interpolated where
/// they came from, those of faces taken from the face that each descends from. Lists of vertices are left out, with a
/// note.
gaussmap::Geometry carried_over(const gaussmap::Geometry& from, const gaussmap::Decimation& made);

}  // namespace cli
