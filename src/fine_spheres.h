// Level sets of spheres (algebraic_sphere.h) over samples of a finer surface: every element of the lowest level, on the
// surface that the rung with windows of a third found. Noise of the small windows is averaged, and their bias is small.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"
#include "level_sets.h"
#include "pyramid.h"
#include "scale_ladder.h"

namespace gaussmap {

struct Rung;

/// The surface under each element of the lowest level, as the rungs find it.
class FineSurface {
  public:
    static constexpr int rungs_below = 3;  ///< that the spheres' samples are from: a third of the neighbours

    /// The level's feet are read later, too.
    explicit FineSurface(const Level& lowest);

    /// From now on rungs stand on the elements of `above`.
    void coarsen(const CoarserLevel& above);
    /// Keep what a rung found, in place of what is no longer asked for.
    void keep(int rung, const Level& level, const std::vector<std::uint8_t>& active, const Rung& found,
              const Execution& run);

    /// The surface for the spheres of a rung, until what that found is kept; empty on the first ones.
    const Surface& for_rung(int rung) const;
    /// The element of the lowest level at whose foot an element is.
    std::size_t representative(std::size_t element) const { return static_cast<std::size_t>(representative_[element]); }
    /// Elements of the lowest level that an element stands for, from `begin` to `end`.
    const std::int32_t* begin(std::size_t element) const { return member_.data() + first_member_[element]; }
    const std::int32_t* end(std::size_t element) const { return member_.data() + first_member_[element + 1]; }

  private:
    void list_members(std::size_t elements);

    const Level& lowest_;
    std::vector<std::int32_t> over_;            ///< of each element of the lowest level, that of the current one
    std::vector<std::int32_t> representative_;  ///< of each of the current one
    std::vector<std::int32_t> first_member_, member_;
    std::array<Surface, rungs_below> surface_;  ///< of the last rungs
};

/// What is asked of the spheres of four elements.
struct FineWindows {
    std::size_t element[fit_lanes];
    const std::int32_t* row[fit_lanes];  ///< nearest elements of the level, nearest first; −1 where there is none
    double half[fit_lanes], whole[fit_lanes];  ///< radii
    int filled = 0;
};

/// Shape operators across the normals `across`, over whole windows, and extrapolated from half ones and whole ones to
/// windows of no size; not finite where there is none.
struct FineSpheres {
    Symmetric3 whole[fit_lanes], extrapolated[fit_lanes];
};

/// \param length  of the rows.
FineSpheres fine_spheres(const FineSurface& fine, const Surface& surface, const FineWindows& windows,
                         std::size_t length, const std::vector<Vec3>& across);

}  // namespace gaussmap
