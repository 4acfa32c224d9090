// Analytic surfaces as triangle meshes, with exact normals and curvature at every vertex: ground truth.
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// A triangulated analytic surface. Faces are counterclockwise seen from the side the normals point to.
/// k1 ≥ k2 in the convention that a sphere with outward normals has k1 = k2 = 1/r > 0.
struct Surface {
    std::vector<double> vertices;     ///< 3 a vertex
    std::vector<std::int32_t> faces;  ///< 3 a face
    std::vector<double> normals;      ///< exact unit normals, 3 a vertex
    std::vector<double> k1, k2;       ///< exact principal curvatures, 1/length
    std::vector<double> density;      ///< k1² + k2², 1/length²
};

/// What noise is relative to.
enum class NoiseUnit {
    edge,      ///< the mean side of the faces
    diagonal,  ///< the diagonal of the box of the vertices
};

struct SurfaceOptions {
    /// Vertices are moved along the surface (they stay on it, with exact normals and curvature there) by a
    /// uniformly random step of up to this fraction of the local edge length in each tangential direction (measured on
    /// a grid as a fraction of its steps, on an icosphere before it is stretched); 0.25 makes a mesh irregular without
    /// folding it. Vertices on an open border stay.
    double jitter = 0;
    /// Then all vertices are displaced by Gaussian noise of this standard deviation in each coordinate, relative to
    /// `noise_unit`. Normals and curvature stay those of the clean surface.
    double noise = 0;
    /// Same seed, same numbers drawn, on every machine and for any number of threads.
    std::uint64_t seed = 0;
    NoiseUnit noise_unit = NoiseUnit::edge;
};

/// Sphere of radius r from an icosahedron whose faces are split in four `subdivisions` times (20·4^s faces),
/// new vertices pushed to the sphere at every level.
/// \throw std::invalid_argument on a radius that is not positive and finite, subdivisions outside 0…12.
Surface sphere(int subdivisions, double radius = 1, const SurfaceOptions& options = {});

/// Torus of revolution about z: `major` from the axis to the tube's centre, `minor` the tube's radius;
/// `around` × `across` vertices, 2 triangles a cell. k = {1/r, cosθ/(R + r cosθ)}.
/// \throw std::invalid_argument unless 0 < minor < major and around, across ≥ 3 (so for all grids below).
Surface torus(double major, double minor, int around, int across, const SurfaceOptions& options = {});

/// Tube of radius `tube` around the (p, q) torus knot that winds p times about the axis of a torus of radii
/// `major`, `minor` and q times about its tube. k1 = 1/a, k2 = −c cosθ/(1 − a c cosθ) with c the curvature of the
/// curve. Strands that come nearer to each other than 2·`tube` run through each other; the values stay those of the
/// tube. \throw std::invalid_argument unless p, q ≥ 1 are coprime, 0 < minor < major and the tube is thinner than the
/// curve's smallest radius of curvature.
Surface torus_knot(int p, int q, double major, double minor, double tube, int around, int across,
                   const SurfaceOptions& options = {});

/// Tube of radius `tube` around the figure-eight knot ((2 + cos 2t) cos 3t, (2 + cos 2t) sin 3t, sin 4t) times `scale`.
Surface figure_eight_knot(double scale, double tube, int around, int across, const SurfaceOptions& options = {});

/// Ellipsoid x²/a² + y²/b² + z²/c² = 1 from the subdivided icosahedron, stretched.
Surface ellipsoid(double a, double b, double c, int subdivisions, const SurfaceOptions& options = {});

/// Sphere with smooth bumps: radius r (1 + amplitude · sin(fx) sin(fy) sin(fz)) in the direction (x, y, z), f the
/// frequency. \throw std::invalid_argument unless |amplitude| < 1.
Surface bumpy_sphere(double radius, double amplitude, double frequency, int subdivisions,
                     const SurfaceOptions& options = {});

/// Catenoid of neck radius `neck`, |z| ≤ `height` / 2, open at both ends: `across` vertices from end to end; k1 = −k2.
Surface catenoid(double neck, double height, int around, int across, const SurfaceOptions& options = {});

/// Cylinder about z, |z| ≤ `height` / 2, open at both ends: k = {1/r, 0}.
Surface cylinder(double radius, double height, int around, int across, const SurfaceOptions& options = {});

/// Rectangle width × depth in z = 0 about the origin, open, `around` vertices along x and `across` along y: k1 = k2 =
/// 0.
Surface plane(double width, double depth, int around, int across, const SurfaceOptions& options = {});

/// Height field z = amplitude · cos(2π x / wavelength) cos(2π y / wavelength) over width × depth: strongly varying,
/// open.
Surface waves(double width, double depth, double amplitude, double wavelength, int around, int across,
              const SurfaceOptions& options = {});

}  // namespace gaussmap
