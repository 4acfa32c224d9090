// The shape operator dn/dx from normals interpolated linearly over triangles (docs/method.md, eq. (9) and (10)).
#pragma once

#include "eigen2.h"
#include "gaussmap/curvature.h"
#include "neighborhood.h"

namespace gaussmap {

/// Room for `count` elements, all undefined.
PrincipalCurvatures undefined_tensor(std::size_t count);
void store(PrincipalCurvatures& tensor, std::size_t i, const Principal& value);
/// Element `to` becomes what element `from` is.
void copy(PrincipalCurvatures& tensor, std::size_t from, std::size_t to);

/// Of every face, in its plane. NaN where it has no area, a non-finite corner or an undefined normal.
/// \param faces         checked.
/// \param unit_normals  one a vertex, NaN where undefined.
PrincipalCurvatures face_tensor(Points vertices, Triangles faces, Points unit_normals, const Execution& run);

/// Of every vertex, in the plane across its normal: the mean of its defined faces by area. NaN where there is none.
PrincipalCurvatures vertex_tensor(Points vertices, Triangles faces, Points unit_normals, const Execution& run);

/// Of a point of a cloud: the mean of the triangles of its fan by area, in 1/length of the cloud. With `align`, normals
/// that look away from the centre's are turned round.
/// \param corners  of the fan, in turn; `closed`: the last and the first make a triangle too.
/// \param normals  unit, one a point, NaN where undefined; `normal` that of the centre.
Principal fan_tensor(const Neighborhood& corners, bool closed, const double* normals, Vec3 normal, bool align);

}  // namespace gaussmap
