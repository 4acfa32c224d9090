// Delaunay fans by inversion: one angular sort and one convex hull in the tangent plane.
#include "fan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "frame.h"

namespace gaussmap {
namespace {

constexpr double tolerance = 1e-12;
constexpr double no_angle = 8;

/// Project, invert, and find the polar angles, without a trigonometric function; the number of rays that count.
std::size_t project(const Neighborhood& neighborhood, const Frame& frame, Rays& rays) {
    const std::size_t slots = padded(neighborhood.count);
    FourMask counted = {};
    for (std::size_t j = 0; j < slots; j += lanes) {
        const Four x = load_four(&neighborhood.x[j]), y = load_four(&neighborhood.y[j]);
        const Four z = load_four(&neighborhood.z[j]), zero = {};
        const Four u = x * frame.u.x + y * frame.u.y + z * frame.u.z;
        const Four v = x * frame.v.x + y * frame.v.y + z * frame.v.z;
        const Four squared = u * u + v * v;
        const FourMask counts = squared > tolerance * tolerance;
        const Four inverse = 1 / (counts ? squared : zero + 1);
        const Four size = absolute(u) + absolute(v), t = v / (counts ? size : zero + 1);
        const Four right = v < 0 ? 4 + t : t, angle = u < 0 ? 2 - t : right;
        store_four(&rays.u[j], u * inverse);
        store_four(&rays.v[j], v * inverse);
        store_four(&rays.size[j], size * inverse);
        store_four(&rays.squared[j], squared);
        store_four(&rays.angle[j], counts ? angle : zero + no_angle);
        counted -= counts;
    }
    return static_cast<std::size_t>(counted[0] + counted[1] + counted[2] + counted[3]);
}

/// Every angle is compared with every other, so that no branch goes wrong. The lowest six bits of an angle, far below
/// the tolerance, give way to its slot, so that no two are equal.
void sort_few(std::size_t slots, Rays& rays) {
    for (std::size_t j = 0; j < slots; ++j)
        rays.angle[j] = std::bit_cast<double>((std::bit_cast<std::uint64_t>(rays.angle[j]) & ~std::uint64_t{63}) | j);
    for (std::size_t i = 0; i < slots; i += lanes) {
        const Four angle = load_four(&rays.angle[i]);
        FourMask rank = {};
        for (std::size_t j = 0; j < slots; ++j) rank -= rays.angle[j] < angle;
        for (std::size_t l = 0; l < lanes; ++l)
            rays.turn[static_cast<std::size_t>(rank[l])] = static_cast<std::int32_t>(i + l);
    }
}

void sort_many(std::size_t slots, Rays& rays) {
    std::iota(rays.turn.begin(), rays.turn.begin() + static_cast<std::ptrdiff_t>(slots), 0);
    std::sort(rays.turn.begin(), rays.turn.begin() + static_cast<std::ptrdiff_t>(slots),
              [&](std::int32_t a, std::int32_t b) {
                  return rays.angle[a] < rays.angle[b] || (rays.angle[a] == rays.angle[b] && a < b);
              });
}

struct Inverted {
    double u, v, size;
};

/// How two rays lie to each other, given by counterclockwise order.
enum class Turn { left, none, half };

Turn turn_between(const Inverted& a, const Inverted& b) {
    const double cross = a.u * b.v - a.v * b.u;
    if (cross > tolerance * a.size * b.size) return Turn::left;
    // Aligned, or more than half a turn.
    const bool aligned = cross >= -tolerance * a.size * b.size;
    return aligned && a.u * b.u + a.v * b.v > 0 ? Turn::none : Turn::half;
}

/// Whether the hull of the inverted points turns inwards at b on the way from a to c, and so passes b by.
bool inward(const Inverted& a, const Inverted& b, const Inverted& c) {
    const double determinant = (b.u - a.u) * (c.v - b.v) - (b.v - a.v) * (c.u - b.u);
    return determinant < -tolerance * (b.size * (a.size + c.size) + a.size * c.size);
}

/// The rays about the centre, one in each direction.
class Turns {
  public:
    Turns(const Neighborhood& neighborhood, Rays& rays, std::size_t count)
        : index_(neighborhood.index), rays_(rays), count_(count) {
        for (std::size_t i = 0; i < count_; ++i) {
            const Turn turn = turn_between(at(i), at(i + 1 < count_ ? i + 1 : 0));
            if (turn == Turn::left) continue;
            straighten();
            break;
        }
    }
    std::size_t count() const { return count_; }
    std::size_t gaps() const { return gaps_; }
    std::size_t first() const { return gaps_ == 0 ? nearest() : after_gap_; }
    std::int32_t slot(std::size_t i) const { return rays_.turn[i]; }
    Inverted at(std::size_t i) const {
        const auto j = static_cast<std::size_t>(rays_.turn[i]);
        return {rays_.u[j], rays_.v[j], rays_.size[j]};
    }

  private:
    bool nearer(std::size_t i, std::size_t j) const {
        const auto a = static_cast<std::size_t>(slot(i)), b = static_cast<std::size_t>(slot(j));
        return rays_.squared[a] < rays_.squared[b] || (rays_.squared[a] == rays_.squared[b] && index_[a] < index_[b]);
    }
    std::size_t nearest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < count_; ++i)
            if (rays_.squared[static_cast<std::size_t>(slot(i))] < rays_.squared[static_cast<std::size_t>(slot(best))])
                best = i;
        return best;
    }

    /// Leave the nearest ray in each direction, then look for gaps of half a turn.
    void straighten() {
        std::size_t kept = 1;
        for (std::size_t i = 1; i < count_; ++i) {
            const bool same = turn_between(at(kept - 1), at(i)) == Turn::none;
            if (!same)
                rays_.turn[kept++] = rays_.turn[i];
            else if (nearer(i, kept - 1))
                rays_.turn[kept - 1] = rays_.turn[i];
        }
        if (kept > 1 && turn_between(at(kept - 1), at(0)) == Turn::none) {
            if (nearer(kept - 1, 0)) rays_.turn[0] = rays_.turn[kept - 1];
            --kept;
        }
        count_ = kept;
        for (std::size_t i = 0; i < count_; ++i) {
            const std::size_t next = i + 1 < count_ ? i + 1 : 0;
            if (turn_between(at(i), at(next)) == Turn::half) ++gaps_, after_gap_ = next;
        }
    }

    const std::vector<std::int32_t>& index_;
    Rays& rays_;
    std::size_t count_, gaps_ = 0, after_gap_ = 0;
};

}  // namespace

void build_fan(const Neighborhood& neighborhood, Vec3 normal, Fan& fan) {
    fan.chain.clear();
    fan.closed = false;
    if (!finite(normal)) return;
    Rays& rays = fan.rays;
    const std::size_t slots = padded(neighborhood.count), count = project(neighborhood, frame_about(normal), rays);
    if (slots <= 64)
        sort_few(slots, rays);
    else
        sort_many(slots, rays);
    const Turns turns(neighborhood, rays, count);
    if (turns.count() < 2 || turns.gaps() > 1) return;
    fan.closed = turns.gaps() == 0;

    // Start where the hull surely has a corner: after a gap of half a turn, else at the nearest (the farthest
    // inverted). The chain so far is kept in the places of the rays already seen.
    std::vector<std::int32_t>& chain = fan.chain;
    Inverted before{}, last{};
    const auto of = [&](std::int32_t slot) {
        const auto j = static_cast<std::size_t>(slot);
        return Inverted{rays.u[j], rays.v[j], rays.size[j]};
    };
    const auto pass_by = [&](const Inverted& next) {
        while (chain.size() > 1 && inward(before, last, next)) {
            chain.pop_back();
            last = before;
            if (chain.size() > 1) before = of(chain[chain.size() - 2]);
        }
    };
    const std::size_t first = turns.first();
    for (std::size_t i = 0; i < turns.count(); ++i) {
        const std::size_t place = first + i < turns.count() ? first + i : first + i - turns.count();
        const Inverted next = turns.at(place);
        pass_by(next);
        chain.push_back(turns.slot(place));
        before = last;
        last = next;
    }
    if (fan.closed) pass_by(turns.at(first));
}

}  // namespace gaussmap
