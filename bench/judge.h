// What the programs of peers share: the shape with its truth, and the line that tells how far a peer is from it.
#pragma once

#include <string>
#include <vector>

#include "gaussmap/io.h"

/// A cloud or mesh written by `surfaces`.
struct Shape {
    gaussmap::Geometry geometry;
    std::vector<double> truth;  ///< exact density a vertex
};

/// \throw std::invalid_argument where the file has no exact_density.
Shape read_shape(const std::string& path);

/// Prints "peer,parameter,relative RMSE,relative RMSE rescaled,undefined,points,seconds" for the densities of the first
/// points (all, or a random sample of a cloud in random order). The relative RMSE is RMSE(density) / RMS(truth) over
/// the points where the density is finite; rescaled: the same after the factor that makes it smallest.
void report(const std::string& peer, const std::string& parameter, const std::vector<double>& density,
            const std::vector<double>& truth, double seconds);

/// A clock for `report`.
double now();
