// The neighbours of four points side by side.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloud_kernel.h"
#include "neighborhood.h"

namespace gaussmap {

/// The neighbourhoods of up to four points, in lanes where they are not too large for that; what cannot be done in
/// lanes takes one out.
class LaneNeighborhoods {
  public:
    /// \param k  most neighbours of a point.
    explicit LaneNeighborhoods(std::size_t k)
        : in_lanes_(k <= static_cast<std::size_t>(most_fitted)), alone_(fit_lanes, Neighborhood(k)) {}

    /// Points `first` and following, `count` of them, with their rows of k indices as of `Neighborhood`. The rows must
    /// stay.
    template <class Positions>
    void gather(const Positions& points, std::size_t first, std::size_t count, const std::int32_t* rows,
                std::size_t k) {
        count_ = count;
        rows_ = rows, stride_ = k;
        for (std::size_t l = 0; l < fit_lanes; ++l) {
            counts_[l] = 0;
            apart_[l] = !in_lanes_;
            if (l >= count) continue;
            if (in_lanes_)
                gather_lane(points, first + l, rows + l * k, k, l);
            else
                alone_[l].gather(points, first + l, rows + l * k, k);
        }
        if (in_lanes_) rescale();
    }

    std::size_t count() const { return count_; }
    /// Whether the lanes hold them.
    bool in_lanes() const { return in_lanes_; }
    const LanePatches& patches() const { return patches_; }
    LanePatches& patches() { return patches_; }
    const LaneCounts& counts() const { return counts_; }

    double scale(std::size_t l) const { return in_lanes_ ? scale_[l] : alone_[l].scale; }
    const Neighborhood& alone(std::size_t l) {
        if (!apart_[l]) take_out(l);
        return alone_[l];
    }

  private:
    template <class Positions>
    void gather_lane(const Positions& points, std::size_t centre, const std::int32_t* row, std::size_t k,
                     std::size_t l) {
        const Vec3 origin = position(points[centre]);
        Vec3 largest;
        std::size_t j = 0;
        for (; j < k && row[j] >= 0; ++j) {
            const Vec3 d = position(points[static_cast<std::size_t>(row[j])]) - origin;
            largest.x = std::max(largest.x, std::abs(d.x));
            largest.y = std::max(largest.y, std::abs(d.y));
            largest.z = std::max(largest.z, std::abs(d.z));
            patches_.d[j][0][l] = d.x, patches_.d[j][1][l] = d.y, patches_.d[j][2][l] = d.z;
        }
        const double most = std::max({largest.x, largest.y, largest.z});
        if (!std::isfinite(most)) j = 0;
        counts_[l] = static_cast<std::int32_t>(j);
        scale_[l] = j > 0 ? scale_of(most) : 1;
    }

    /// And fill up with zeros.
    void rescale() {
        const std::int32_t most = *std::max_element(counts_, counts_ + fit_lanes),
                           end = std::min(most + 1, most_fitted);
        for (std::size_t l = 0; l < fit_lanes; ++l)
            for (std::int32_t j = counts_[l]; j < end; ++j)
                patches_.d[j][0][l] = patches_.d[j][1][l] = patches_.d[j][2][l] = 0;
        const Four scale = load_four(scale_);
        for (std::int32_t j = 0; j < most; ++j)
            for (LaneValues& d : patches_.d[j]) store_four(d, load_four(d) * scale);
    }

    void take_out(std::size_t l) {
        Neighborhood& one = alone_[l];
        one.count = static_cast<std::size_t>(counts_[l]);
        one.scale = scale_[l];
        for (std::size_t j = 0; j < padded(one.count); ++j) {
            const bool there = j < one.count;
            one.x[j] = there ? patches_.d[j][0][l] : 0;
            one.y[j] = there ? patches_.d[j][1][l] : 0;
            one.z[j] = there ? patches_.d[j][2][l] : 0;
            if (there) one.index[j] = rows_[l * stride_ + j];
        }
        apart_[l] = true;
    }

    bool in_lanes_;
    std::size_t count_ = 0, stride_ = 0;
    const std::int32_t* rows_ = nullptr;
    LanePatches patches_;
    LaneCounts counts_ = {};
    LaneValues scale_ = {1, 1, 1, 1};
    bool apart_[fit_lanes] = {};
    std::vector<Neighborhood> alone_;
};

}  // namespace gaussmap
