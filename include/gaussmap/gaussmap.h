// gaussmap: total curvature (k1² + k2²) of triangle meshes from the variation of their normals, and of point clouds
// from fitted surfaces or normals.
//
// The tour:
//   types.h      views in (Points, Triangles), how a call may run (Execution)
//   curvature.h  mesh_curvature, cloud_curvature: the main job, each one call
//   normals.h    unit normals of meshes and clouds, orientation
//   neighbors.h  k nearest neighbours, fans, points without repetitions
//   distance.h   exact closest points; distances of surfaces and clouds, sampled or bounded
//   decimate.h   fewer triangles for the same surface
//   sampling.h   points on a surface: at random, Poisson-disk
//   surfaces.h   analytic surfaces with exact normals and curvature
//   inspect.h    boundary, non-manifold, degenerate, duplicate: what is in a file
//   page.h       a page to look at the result, in one HTML file
//   picture.h    a picture of the result, and its PNG
//   io.h         PLY, OBJ, OFF, STL, XYZ, PCD
//
//   auto bunny  = gaussmap::read("bunny.ply");
//   auto result = gaussmap::mesh_curvature(bunny.vertices, bunny.faces);
//   // result.density[v] in 1/length², result.kappa[f] without unit
//
// Everything is double precision, throws std::invalid_argument or std::runtime_error, never prints, and gives the same
// bits for any number of threads. Undefined values are NaN and counted.
#pragma once

#include "gaussmap/curvature.h"
#include "gaussmap/decimate.h"
#include "gaussmap/distance.h"
#include "gaussmap/inspect.h"
#include "gaussmap/io.h"
#include "gaussmap/neighbors.h"
#include "gaussmap/normals.h"
#include "gaussmap/page.h"
#include "gaussmap/picture.h"
#include "gaussmap/sampling.h"
#include "gaussmap/surfaces.h"
#include "gaussmap/types.h"
