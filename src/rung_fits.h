// What one rung of the ladder of scales finds: fits over windows about the feet of elements, and averages of them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fine_spheres.h"
#include "fitted_curvature.h"
#include "gaussmap/neighbors.h"
#include "lane_averages.h"
#include "level_sets.h"
#include "pyramid.h"
#include "scale_ladder.h"
#include "window_fits.h"

namespace gaussmap {

using Field = std::vector<float>;
using FamilyFlags = std::array<std::vector<std::uint8_t>, families>;

/// What a rung found, an element each; NaN where it was not on the rung. Two of a kind: of the quadric and of the
/// quartic. Variances are for heights of unit variance on the lowest level.
struct Rung {
    Field size, half_size;                 ///< distances of the last neighbour and of the one half way
    std::array<Field, 2> variance, trace;  ///< of the density and of the shape operator
    std::array<Field, 2> residual;         ///< variance of the heights about the fit, on the lowest level
    std::array<Field, families> density;   ///< |S|², its bias by noise included
    std::array<Field, 2> spread;           ///< variance of the slopes, half and whole, relative to that of an even disc
    std::array<std::vector<Symmetric3>, families> tensor;
    std::vector<Vec3> normal;

    explicit Rung(std::size_t count = 0)
        : size(count, std::numeric_limits<float>::quiet_NaN()), half_size(size), normal(count, Vec3{NAN, NAN, NAN}) {
        for (int q = 0; q < 2; ++q) variance[q] = trace[q] = residual[q] = spread[q] = size;
        for (int f = 0; f < families; ++f) density[f] = size, tensor[f].resize(count);
    }
};

template <class T>
std::vector<T> at(const std::vector<T>& field, const std::vector<std::int32_t>& index) {
    std::vector<T> picked(index.size());
    for (std::size_t i = 0; i < index.size(); ++i) picked[i] = field[static_cast<std::size_t>(index[i])];
    return picked;
}

/// A rung's finds at the elements that represent those of the next level.
inline Rung at(const Rung& rung, const std::vector<std::int32_t>& index) {
    Rung picked;
    picked.size = at(rung.size, index), picked.half_size = at(rung.half_size, index);
    picked.normal = at(rung.normal, index);
    for (int q = 0; q < 2; ++q) {
        picked.variance[q] = at(rung.variance[q], index), picked.trace[q] = at(rung.trace[q], index);
        picked.residual[q] = at(rung.residual[q], index), picked.spread[q] = at(rung.spread[q], index);
    }
    for (int f = 0; f < families; ++f)
        picked.density[f] = at(rung.density[f], index), picked.tensor[f] = at(rung.tensor[f], index);
    return picked;
}

/// The fits of a level's elements, rung after rung; each moves the feet of the elements to the surface that it finds.
class RungFits {
  public:
    /// \param active  elements that are fitted.
    /// \param dead    of each family, elements that it has left: averages that no family asks for are not made.
    /// \param fine    under the level's elements, where spheres are tried; gets what the rungs find.
    RungFits(const Elements& elements, Level& level, const std::vector<std::uint8_t>& active, const FamilyFlags& dead,
             FineSurface* fine, const Execution& run)
        : elements_(elements),
          level_(level),
          active_(active),
          dead_(dead),
          fine_(fine),
          run_{run.threads, {}},
          index_(Points(level.position), run_),
          most_averaged_(elements.connected || level.members == 1 ? few_samples : most_in_window),
          most_samples_(fine ? reach(most_in_window) : most_averaged_),
          samples_(level.count() * most_samples_, -1) {}

    /// The finds of a rung, fitted and averaged, at the active elements.
    Rung step(int rung);

  private:
    /// Elements in a window.
    std::size_t window(int rung) const {
        return static_cast<std::size_t>(rung_neighbors(rung) / static_cast<int>(level_.members));
    }
    /// Of how many in a window averages take one.
    std::size_t averaged_stride(std::size_t window) const { return (window + most_averaged_ - 1) / most_averaged_; }
    /// Elements that members within a window belong to.
    std::size_t reach(std::size_t window) const { return level_.members == 1 ? window : window + window / 4; }
    /// Whether windows follow the edges of a mesh.
    bool by_rings() const { return elements_.connected && level_.members == 1; }
    std::size_t ring_width() const;
    void keep_rings();
    void fit(int rung, std::size_t first, std::size_t last, Rung& found);
    void fit_windows(const std::size_t (&who)[fit_lanes], int rung, WindowFits& windows, Rung& found);
    void keep(std::size_t i, const WindowFit& fit, Rung& found);
    void average(int rung, Rung& found);
    void average_elements(const std::size_t (&who)[fit_lanes], int filled, int count, int stride,
                          const std::vector<SurfaceSample>& samples, Rung& found);
    template <class Keep>
    void find_level_sets(int count, const Surface& surface, const Rung& found, Keep&& keep) const;
    void keep_spheres(int count, Rung& found) const;
    void keep_fine_spheres(int rung, Rung& found) const;
    bool averages_wanted(std::size_t i) const;
    void keep(std::size_t i, int lane, double own, const LaneAverages (&windows)[2], const LaneCentres& centres,
              Rung& found);

    const Elements& elements_;
    Level& level_;
    const std::vector<std::uint8_t>& active_;
    const FamilyFlags& dead_;
    FineSurface* fine_;
    Execution run_;
    NeighborIndex index_;
    std::vector<std::int32_t> rings_;  ///< on the lowest level of a mesh, `ring_width()` neighbours of each element
    /// Level sets of spheres are second derivatives, and ask for every element of a window; averages for those of a
    /// coarser level's.
    static constexpr std::size_t few_samples = 96, most_in_window = 216;
    std::size_t most_averaged_, most_samples_;
    /// `most_samples_` of each element's nearest, nearest first, −1 for itself; where spheres are not tried those of
    /// the averages alone.
    std::vector<std::int32_t> samples_;
};

}  // namespace gaussmap
