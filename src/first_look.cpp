#include "first_look.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "patch.h"

namespace gaussmap {
namespace {

constexpr int nearest = 9;  ///< enough for a quadric, and the unit of lengths
constexpr int quadric_least = 5, quartic_least = 15;
typedef int Counts[fit_lanes];

/// An element that is being looked at.
struct Lane {
    View view;
    Frame frame;
    SurfaceJet jet;            ///< of the last fit
    int quartic_count = 0;     ///< neighbours that quartics are fitted to
    bool active = false;       ///< and defined so far
    double equal_density = 0;  ///< by the quartic in chords with equal weights
    FirstLook look;            ///< handed out when all fits are there
};

/// Four first looks in step: fits go through all lanes together, what is between them lane by lane. Lanes that are no
/// longer active go along unread.
class FourLooks {
  public:
    FourLooks(LanePatches& patches, const Counts& counts, FirstLook (&looks)[fit_lanes], const LaneFitKernel& kernel)
        : patches_(patches), counts_(counts), looks_(looks), kernel_(kernel) {}

    void run() {
        fit_quadrics();
        fit_equal_quartics();
        fit_weighted_quartics();
        fit_monge_quartics();
    }

  private:
    void begin(int l, int to_direction, int to_size);
    void level(const bool (&wanted)[fit_lanes], const Counts& last);
    void fit_quadrics();
    void fit_chord_quartics(bool weighted, double level);
    void fit_equal_quartics();
    void tell_noise();
    void widen(const LaneRange& range, FirstLook::Fit FirstLook::*which);
    void fit_weighted_quartics();
    void fit_monge_quartics();

    template <class Body>
    void for_active(Body&& body) {
        for (int l = 0; l < fit_lanes; ++l)
            if (lane_[l].active) body(l, lane_[l]);
    }
    void see(int l) {
        lane_[l].frame = frame_about(lane_[l].view.normal);
        patches_.see(l, lane_[l].frame, lane_[l].view.size);
    }
    HeightField<2> field(int l) const { return fields_.field(l); }
    SurfaceJet jet(int l) const { return surface_jet(field(l).c, lane_[l].frame, lane_[l].view.size); }

    LanePatches& patches_;
    const Counts& counts_;
    FirstLook (&looks_)[fit_lanes];
    const LaneFitKernel& kernel_;
    Lane lane_[fit_lanes];
    LaneSums sums_;
    LaneFields fields_;
};

/// The view along the principal direction of some neighbours, its unit of length the distance of one.
void FourLooks::begin(int l, int to_direction, int to_size) {
    std::array<Vec3, most_fitted> offsets;
    const auto offset = [&](int j) { return Vec3{patches_.d[j][0][l], patches_.d[j][1][l], patches_.d[j][2][l]}; };
    for (int j = 0; j < to_direction; ++j) offsets[static_cast<std::size_t>(j)] = offset(j);
    lane_[l].view = {principal_normal(offsets, to_direction), {}, length(offset(to_size - 1))};
    lane_[l].active = lane_[l].view.size > 0 && finite(lane_[l].view.normal);
}

/// Turn the views of some lanes until a quadric through the element over its nearest neighbours has no slope there.
void FourLooks::level(const bool (&wanted)[fit_lanes], const Counts& last) {
    LaneRange range = {{}, {}, Chart::chord, Weights::equal};
    std::copy(last, last + fit_lanes, range.last);
    for (int turn = 0; turn < 2; ++turn) {
        for_active([&](int l, Lane&) { see(l); });
        kernel_.quadric.collect(patches_.d, patches_, range, true, sums_);
        kernel_.quadric.solve(sums_, AtElement::zero, false, fields_);
        for_active([&](int l, Lane& lane) {
            if (!wanted[l]) return;
            lane.jet = jet(l);
            lane.view.normal = lane.jet.normal;
            lane.active = fields_.determined[l] && finite(lane.view.normal);
        });
    }
}

void FourLooks::fit_quadrics() {
    bool enough[fit_lanes], again[fit_lanes];
    Counts few;
    for (int l = 0; l < fit_lanes; ++l) {
        few[l] = std::min(counts_[l], nearest);
        enough[l] = counts_[l] >= quadric_least;
        looks_[l].lowered = enough[l];
        if (enough[l]) begin(l, std::min(counts_[l], 12), few[l]);
    }
    level(enough, few);
    // The nearest may lie on a conic, as of one or two lines of a scan; further ones then tell more.
    bool any = false;
    for (int l = 0; l < fit_lanes; ++l) {
        again[l] = enough[l] && !lane_[l].active;
        if (again[l]) begin(l, counts_[l], counts_[l]), few[l] = counts_[l];
        any = any || again[l];
    }
    if (any) level(again, few);
    for_active([&](int l, Lane& lane) {
        FirstLook& look = looks_[l];
        look.normal = lane.jet.normal;
        // Nothing tells the remainder of a quadric alone: take it for as large as the value.
        const double density = squared_norm(lane.jet.tensor);
        look.quadric = {lane.jet.tensor, density, density};
        lane.look = look;
        lane.quartic_count = std::min(counts_[l], look_neighbors);
        lane.active = counts_[l] >= quartic_least;
        if (lane.active) see(l);
    });
}

/// Fit quartics in chords; where they have a slope that matters, once more in their own view.
void FourLooks::fit_chord_quartics(bool weighted, double level) {
    LaneRange range = {{}, {}, Chart::chord, weighted ? Weights::remainder : Weights::equal};
    bool again = true;
    for (int turn = 0; again; ++turn) {
        for (int l = 0; l < fit_lanes; ++l) range.last[l] = lane_[l].quartic_count;
        kernel_.quartic.collect(patches_.d, patches_, range, true, sums_);
        kernel_.quartic.solve(sums_, weighted ? AtElement::zero : AtElement::datum, !weighted, fields_);
        again = false;
        for_active([&](int l, Lane& lane) {
            lane.active = fields_.determined[l];
            if (!lane.active && lane.quartic_count < counts_[l]) {
                // On the border of a grid the nearest lie on four lines, too few for a quartic, and more on five.
                lane.active = again = true;
                lane.quartic_count = counts_[l];
                return;
            }
            lane.jet = jet(l);
            if (turn > 0 || !(dot(lane.jet.normal, lane.view.normal) < 1 - 0.5 * level * level)) return;
            lane.view.normal = lane.jet.normal;
            see(l);
            again = true;
        });
    }
}

/// With equal weights, free to pass by the elements: they level the views, and tell of the noise.
void FourLooks::fit_equal_quartics() {
    fit_chord_quartics(false, 0.03);
    for_active([&](int l, Lane& lane) {
        const HeightField<2> equal = field(l);
        lane.equal_density = squared_norm(lane.jet.tensor);
        lane.look.variance = density_variance(equal) / std::pow(lane.view.size, 6);
        lane.look.trace = shape_variance(equal) / std::pow(lane.view.size, 4);
    });
    tell_noise();
}

/// Residuals of those quartics, and of the same over more neighbours.
void FourLooks::tell_noise() {
    LaneRange range = {{}, {}, Chart::chord, Weights::equal};
    double residual[fit_lanes];
    std::copy(fields_.residual, fields_.residual + fit_lanes, residual);
    for (int l = 0; l < fit_lanes; ++l) range.first[l] = lane_[l].quartic_count, range.last[l] = counts_[l];
    kernel_.quartic.collect(patches_.d, patches_, range, false, sums_);
    kernel_.quartic.solve(sums_, AtElement::datum, false, fields_);
    for_active([&](int l, Lane& lane) {
        if (lane.quartic_count == counts_[l] || !fields_.determined[l]) return;
        const double unit = lane.view.size * lane.view.size;
        lane.look.residual = unit * residual[l] / (lane.quartic_count + 1 - monomials(4));
        lane.look.wide_residual = unit * fields_.residual[l] / (counts_[l] + 1 - monomials(4));
    });
}

/// Take the neighbours beyond those of the last quartics into them, too, to see what that changes.
void FourLooks::widen(const LaneRange& range, FirstLook::Fit FirstLook::*which) {
    LaneRange more = range;
    for (int l = 0; l < fit_lanes; ++l) more.first[l] = lane_[l].quartic_count, more.last[l] = counts_[l];
    kernel_.quartic.collect(patches_.d, patches_, more, false, sums_);
    kernel_.quartic.solve(sums_, AtElement::zero, false, fields_);
    for_active([&](int l, Lane& lane) {
        if (lane.quartic_count == counts_[l] || !fields_.determined[l]) return;
        FirstLook::Fit& fit = lane.look.*which;
        fit.widened = fit.density - squared_norm(jet(l).tensor);
    });
}

/// The quartic in chords with weights, in a view without slope.
void FourLooks::fit_weighted_quartics() {
    for_active([&](int l, Lane& lane) {
        lane.view.normal = lane.jet.normal;
        see(l);
    });
    fit_chord_quartics(true, 1e-3);
    for_active([&](int, Lane& lane) {
        FirstLook& look = lane.look;
        const double chord = squared_norm(lane.jet.tensor);
        look.chord = {lane.jet.tensor, chord, chord - lane.equal_density};
        // Unoriented normals of one surface differ by less than a right angle, or there is no telling.
        const double side = dot(look.normal, lane.jet.normal) < 0 ? -1 : 1;
        Symmetric3 quadric;
        add(quadric, side, look.quadric.tensor);
        look.quadric.tensor = carried(quadric, side * look.normal, lane.jet.normal);
        look.quadric.change = look.quadric.density - chord;
        look.normal = lane.jet.normal;
    });
    widen({{}, {}, Chart::chord, Weights::remainder}, &FirstLook::chord);
}

/// In Monge coordinates, with weights and without.
void FourLooks::fit_monge_quartics() {
    LaneRange range = {{}, {}, Chart::monge, Weights::remainder};
    for (int l = 0; l < fit_lanes; ++l) range.last[l] = lane_[l].quartic_count;
    kernel_.quartic.collect(patches_.d, patches_, range, true, sums_);
    kernel_.quartic.solve(sums_, AtElement::zero, false, fields_);
    for_active([&](int l, Lane& lane) {
        lane.active = fields_.determined[l];
        const SurfaceJet monge = jet(l);
        lane.look.monge = {carried(monge.tensor, monge.normal, lane.jet.normal), squared_norm(monge.tensor), 0};
    });
    widen(range, &FirstLook::monge);
    range.weights = Weights::equal;
    kernel_.quartic.collect(patches_.d, patches_, range, true, sums_);
    kernel_.quartic.solve(sums_, AtElement::datum, false, fields_);
    for_active([&](int l, Lane& lane) {
        if (!fields_.determined[l]) return;
        lane.look.monge.change = lane.look.monge.density - squared_norm(jet(l).tensor);
        lane.look.lowered = false;
        looks_[l] = lane.look;
    });
}

}  // namespace

void first_look(LanePatches& patches, const int (&counts)[fit_lanes], FirstLook (&looks)[fit_lanes],
                const LaneFitKernel& kernel) {
    FourLooks(patches, counts, looks, kernel).run();
}

}  // namespace gaussmap
