// Fits over the windows of four elements side by side, a lane each: views settled on quadrics, then a quadric and a
// quartic in chords from the same sums.
#pragma once

#include <memory>
#include <vector>

#include "lane_fits.h"
#include "patch.h"
#include "vec.h"

namespace gaussmap {

/// What is fitted to a window.
struct WindowFit {
    View view;
    Frame frame;
    double weight;            ///< sum of the neighbours' weights
    HeightField<2> field[2];  ///< the quadric and the quartic, up to the second degree
    bool determined[2];       ///< the quartic never without the quadric
    static constexpr int unknowns[2] = {monomials(2), monomials(4)};
};

/// Four windows to be filled and fitted, then cleared for the next four. What a lane finds does not depend on the
/// others.
class WindowFits {
  public:
    /// \param most  neighbours of a window.
    explicit WindowFits(int most) : room_(std::make_unique<double[][3][fit_lanes]>(static_cast<std::size_t>(most))) {}

    void clear() { range_ = {{}, {}, Chart::chord, Weights::smoothing}, filled_ = 0; }
    int filled() const { return filled_; }
    bool full() const { return filled_ == fit_lanes; }

    /// Neighbours of the window that is being filled, as differences from its element; the last is the farthest.
    void add(Vec3 d) {
        LaneNeighbor& to = room_[static_cast<std::size_t>(range_.last[filled_]++)];
        to[0][filled_] = d.x, to[1][filled_] = d.y, to[2][filled_] = d.z;
    }
    int count() const { return range_.last[filled_]; }
    Vec3 neighbor(int j) const { return neighbor(filled_, j); }
    /// The window is complete, the next to be filled.
    void close() { ++filled_; }
    /// Begin the window anew.
    void drop() { range_.last[filled_] = 0; }

    /// \param normals  the views that are known, of each window; not finite where there are none.
    /// \param fresh    whether new views are tried, too, and taken where they leave less.
    void fit(const Vec3 (&normals)[fit_lanes], bool fresh, const LaneFitKernel& kernel = best_lane_fit());
    const WindowFit& operator[](int lane) const { return found_[lane]; }

  private:
    typedef View Views[fit_lanes];
    typedef double Residuals[fit_lanes];

    Vec3 neighbor(int lane, int j) const {
        const LaneNeighbor& d = room_[static_cast<std::size_t>(j)];
        return {d[0][lane], d[1][lane], d[2][lane]};
    }
    Vec3 principal(int lane);
    void see(int lane, const View& view);
    void settle_on_quadric(const LaneFitKernel& kernel, int turns, Views& views, Residuals& residuals);

    std::unique_ptr<LaneNeighbor[]> room_;
    LaneRange range_ = {{}, {}, Chart::chord, Weights::smoothing};
    int filled_ = 0;
    LaneViews views_;
    LaneSums sums_;
    LaneFields fields_;
    WindowFit found_[fit_lanes];
    std::vector<Vec3> alone_;
};

}  // namespace gaussmap
