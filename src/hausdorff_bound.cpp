// The one-sided Hausdorff distance between bounds: triangles of a are halved across their longest sides, those with the
// highest upper bounds first, in rounds that do not depend on the number of threads (docs/method.md).
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arguments.h"
#include "closest_tree.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = 4096;

/// A part of a triangle of a: its corners, what of b is closest to each, and what of b is near to all of it.
struct Piece {
    Vec3 corner[3];
    std::uint32_t slot[3], near;
    double upper;  ///< of the distances of its points to b
};

/// The distance to one triangle (point) of b is convex, so that its maximum over a piece is at a corner; the least such
/// maximum of the candidates bounds the piece.
void bound(Piece& piece, const ClosestTree& b) {
    double least = piece.upper * piece.upper;
    for (const std::uint32_t slot : {piece.near, piece.slot[0], piece.slot[1], piece.slot[2]}) {
        double most = 0;
        for (const Vec3 p : piece.corner) most = std::max(most, squared_distance(b, slot, p));
        if (most < least) least = most, piece.near = slot;
    }
    piece.upper = std::sqrt(least);
}

/// The corner across from the longest side, the first of equal ones.
int across_longest(const Piece& piece) {
    const auto side = [&](int i) { return squared(piece.corner[(i + 2) % 3] - piece.corner[(i + 1) % 3]); };
    return side(0) >= side(1) && side(0) >= side(2) ? 0 : side(1) >= side(2) ? 1 : 2;
}

Vec3 middle_of_longest(const Piece& piece) {
    const int i = across_longest(piece);
    const Vec3 p = piece.corner[(i + 1) % 3];
    return p + 0.5 * (piece.corner[(i + 2) % 3] - p);
}

/// Does the interval lie on one side of the limit, if there is one?
bool decided(const HausdorffInterval& found, double limit) {
    return limit >= 0 && (found.lower > limit || found.upper <= limit);
}

/// The interval, wider by the rounding of what it comes from.
HausdorffInterval widened(HausdorffInterval found, double rounding) {
    found.lower = std::max(0.0, found.lower - rounding);
    found.upper += rounding;
    return found;
}

class Bounding {
  public:
    Bounding(const ClosestTree& b, const HausdorffOptions& options, double tolerance, double rounding)
        : b_(b), options_(options), tolerance_(tolerance), rounding_(rounding) {}

    HausdorffInterval between(Points a, Triangles faces);

  private:
    /// The closest slots of points of a, which also raise the lower bound.
    std::vector<std::uint32_t> ask(const std::vector<double>& points);
    /// The faces of a that may hold a point farther away than the lower bound.
    std::vector<Piece> pieces_of(Points a, Triangles faces, const std::vector<std::uint32_t>& slots);
    std::vector<Piece> halves_of(const std::vector<Piece>& pieces);
    /// Bound the pieces, and let go of those that cannot hold a point farther away than the lower bound.
    void settle(std::vector<Piece>& pieces);
    /// Of the pieces, those bounded by more than `upper`, which leave.
    static std::vector<Piece> take_above(double upper, std::vector<Piece>& pieces);
    void refine(std::vector<Piece> pieces);
    void report(double gap) const;
    const ClosestTree& b_;
    const HausdorffOptions& options_;
    const double tolerance_, rounding_;
    double settled_ = 0;  ///< highest upper bound of the pieces that were let go
    double first_gap_ = 0;
    HausdorffInterval found_;
};

std::vector<std::uint32_t> Bounding::ask(const std::vector<double>& points) {
    const std::size_t count = points.size() / 3;
    std::vector<std::uint32_t> slot(count);
    std::vector<double> distance(count);
    find_closest(b_, points, distance.data(), slot.data(), {options_.run.threads, {}});
    const bool first = found_.queries == 0;
    found_.queries += count;
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (count == 0 || (!first && std::sqrt(*farthest) <= found_.lower)) return slot;
    found_.lower = std::sqrt(*farthest);
    std::copy_n(points.begin() + 3 * (farthest - distance.begin()), 3, found_.at);
    return slot;
}

void Bounding::settle(std::vector<Piece>& pieces) {
    for_blocks(pieces.size(), block, {options_.run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) bound(pieces[i], b_);
    });
    std::erase_if(pieces, [&](const Piece& piece) {
        if (piece.upper > found_.lower + tolerance_) return false;
        settled_ = std::max(settled_, piece.upper);
        return true;
    });
}

std::vector<Piece> Bounding::pieces_of(Points a, Triangles faces, const std::vector<std::uint32_t>& slots) {
    std::vector<double> middles(3 * faces.count);
    std::vector<Piece> pieces(faces.count);
    for (std::size_t f = 0; f < faces.count; ++f) {
        Piece& piece = pieces[f];
        for (int c = 0; c < 3; ++c) {
            const auto v = static_cast<std::size_t>(faces[f][c]);
            piece.corner[c] = load(a[v]);
            piece.slot[c] = slots[v];
        }
        piece.upper = std::numeric_limits<double>::infinity();
        const Vec3 p = piece.corner[0];
        store(middles.data() + 3 * f, p + (1.0 / 3) * ((piece.corner[1] - p) + (piece.corner[2] - p)));
    }
    const std::vector<std::uint32_t> near = ask(middles);
    for (std::size_t f = 0; f < faces.count; ++f) pieces[f].near = near[f];
    settle(pieces);
    return pieces;
}

std::vector<Piece> Bounding::halves_of(const std::vector<Piece>& pieces) {
    std::vector<double> middles(3 * pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) store(middles.data() + 3 * i, middle_of_longest(pieces[i]));
    const std::vector<std::uint32_t> slots = ask(middles);
    std::vector<Piece> halves;
    halves.reserve(2 * pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const int apex = across_longest(pieces[i]);
        for (const int replaced : {(apex + 1) % 3, (apex + 2) % 3}) {
            halves.push_back(pieces[i]);
            halves.back().corner[replaced] = load(middles.data() + 3 * i);
            halves.back().slot[replaced] = slots[i];
        }
    }
    settle(halves);
    return halves;
}

std::vector<Piece> Bounding::take_above(double upper, std::vector<Piece>& pieces) {
    std::vector<Piece> taken;
    std::erase_if(pieces, [&](const Piece& piece) {
        if (piece.upper > upper) taken.push_back(piece);
        return piece.upper > upper;
    });
    return taken;
}

/// Where the logarithm of the gap is on its way to that of the tolerance.
void Bounding::report(double gap) const {
    if (!options_.run.progress) return;
    const double way = std::log(first_gap_ / tolerance_), left = std::log(std::max(1.0, gap / tolerance_));
    if (!options_.run.progress(way > 0 ? std::clamp(1 - left / way, 0.0, 1.0) : 1)) throw Cancelled();
}

void Bounding::refine(std::vector<Piece> pieces) {
    for (;;) {
        double highest = found_.lower;
        for (const Piece& piece : pieces) highest = std::max(highest, piece.upper);
        found_.upper = std::max(settled_, highest);
        const double gap = highest - found_.lower;
        first_gap_ = std::max(first_gap_, gap);
        report(gap);
        if (gap <= tolerance_ || decided(widened(found_, rounding_), options_.limit)) return;
        if (found_.queries >= options_.most_queries) return;
        // The upper half of the gap first: what it finds may let go of the lower one.
        std::vector<Piece> chosen = take_above(found_.lower + std::max(tolerance_, 0.5 * gap), pieces);
        std::vector<Piece> halves = halves_of(chosen);
        pieces.insert(pieces.end(), halves.begin(), halves.end());
    }
}

HausdorffInterval Bounding::between(Points a, Triangles faces) {
    if (faces.empty()) {
        ask(std::vector<double>(a.xyz, a.xyz + 3 * a.count));
        found_.upper = found_.lower;
        report(0);
        return found_;
    }
    std::vector<std::uint32_t> slots(a.count), used_slots;
    std::vector<std::uint8_t> used(a.count);
    for (std::size_t i = 0; i < 3 * faces.count; ++i) used[static_cast<std::size_t>(faces.abc[i])] = 1;
    std::vector<double> corners;
    for (std::size_t v = 0; v < a.count; ++v)
        if (used[v]) corners.insert(corners.end(), a[v], a[v] + 3);
    used_slots = ask(corners);
    for (std::size_t v = 0, i = 0; v < a.count; ++v)
        if (used[v]) slots[v] = used_slots[i++];
    refine(pieces_of(a, faces, slots));
    return found_;
}

}  // namespace

HausdorffInterval hausdorff_bound(Points a, Triangles faces_a, const ClosestIndex& b, const HausdorffOptions& options) {
    require(std::isfinite(options.tolerance) && options.tolerance >= 0, "hausdorff_bound", "tolerance",
            options.tolerance, "be finite and not negative");
    check_surface(a, faces_a);
    const ClosestTree& tree = *b.tree_;
    // Rounding of coordinates and of distances, with room to spare.
    const double rounding = 64 * std::numeric_limits<double>::epsilon() * std::max(reach(a, faces_a), tree.reach);
    const double wanted = options.tolerance > 0 ? options.tolerance : 1e-4 * box_diagonal(a, faces_a);
    const double tolerance = std::max(wanted - 2 * rounding, rounding);
    HausdorffInterval found = widened(Bounding(tree, options, tolerance, rounding).between(a, faces_a), rounding);
    found.within_tolerance = found.upper - found.lower <= wanted || decided(found, options.limit);
    return found;
}

}  // namespace gaussmap
