#include "half_sample.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "automatic.h"
#include "first_look.h"
#include "parallel.h"
#include "percentile.h"

namespace gaussmap {
namespace {

/// Elements of the half that are looked at: all, or some runs of them, evenly spread.
constexpr std::size_t most_looked_at = 16384, run_length = 2048;
static_assert(run_length % Elements::block == 0);
/// Enough of them for a percentile; and the part of them that first looks must have settled, in the half too.
constexpr std::size_t least_compared = 200;
constexpr double least_part = 0.9;
/// Half of the elements stand 1.4 times as far apart, and tell larger errors for what they are off the coarser they are
/// for the shape: of the whole this is 0.9 to 1.5 times as much. Where that is more than `no_sign` times what they
/// tell, the half is another shape.
constexpr double of_half = 1.15, least = 0.65, most = 1.25, no_sign = 1.5;

/// Every other element, by the neighbours that are left.
Elements every_other(const Elements& all) {
    Elements half;
    half.count = (all.count + 1) / 2;
    half.connected = all.connected;
    half.position = [&all](std::size_t i) { return all.position(2 * i); };
    half.neighbors = [&all](std::size_t first, std::size_t last, int k, std::int32_t* rows) {
        // About half of them are left; a few more, since not everywhere exactly half.
        const auto stride = static_cast<std::size_t>(k), reach = 2 * stride + stride / 2;
        const std::size_t begin = 2 * first, end = std::min(2 * last, all.count);
        std::vector<std::int32_t> reached((end - begin) * reach);
        const auto find = [&](std::size_t from, std::size_t to) {
            all.neighbors(from, to, static_cast<int>(reach), reached.data() + (from - begin) * reach);
        };
        if (all.connected)
            for (std::size_t i = begin; i < end; i += 2) find(i, i + 1);
        else
            find(begin, end);
        for (std::size_t i = first; i < last; ++i, rows += stride) {
            const std::int32_t* row = reached.data() + 2 * (i - first) * reach;
            std::size_t kept = 0;
            for (std::size_t j = 0; j < reach && row[j] >= 0 && kept < stride; ++j)
                if (row[j] % 2 == 0) rows[kept++] = row[j] / 2;
            std::fill(rows + kept, rows + stride, -1);
        }
    };
    return half;
}

}  // namespace

double told_error_factor(const Elements& elements, double size, const std::function<double(std::size_t)>& density,
                         const Execution& run) {
    const Elements half = every_other(elements);
    const std::size_t runs = half.count <= most_looked_at ? 1 : most_looked_at / run_length;
    const std::size_t length = runs == 1 ? half.count : run_length;
    const auto enough = [&](std::size_t compared) {
        return compared >= least_compared &&
               static_cast<double>(compared) >= least_part * static_cast<double>(runs * length);
    };
    std::vector<double> ratios, whole(length);
    std::size_t known = runs * length;
    for (std::size_t r = 0; r < runs; ++r) {
        // Runs begin where blocks do.
        const std::size_t first = r * (half.count / runs) / Elements::block * Elements::block;
        for (std::size_t i = 0; i < length; ++i) {
            whole[i] = density(2 * (first + i));
            known -= std::isnan(whole[i]) ? 1 : 0;
        }
        if (!enough(known)) return 1;  // whatever further looks would find
        const AutomaticCurvature found = first_looks(half, first, length, size, {run.threads, {}});
        for (std::size_t i = 0; i < length; ++i) {
            const double off = std::abs(found.density[i] - whole[i]);
            if (found.choice[i] == look_choice && std::isfinite(off) && found.error[i] > 0)
                ratios.push_back(off / found.error[i]);
        }
    }
    if (!enough(ratios.size())) return 1;
    // Two errors should hold 95 of 100.
    const double off = percentile(ratios, 0.95) / 2;
    return off > no_sign ? 1 : std::clamp(of_half * off, least, most);
}

}  // namespace gaussmap
