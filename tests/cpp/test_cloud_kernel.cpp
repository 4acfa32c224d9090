// What is done for group points side by side: against the same done for one, and the same bits from every instruction
// set.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "../../src/fan.h"
#include "../../src/frame.h"
#include "../../src/principal_normal.h"
#include "gaussmap/curvature.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::vector<const CloudKernel*> kernels() {
    std::vector<const CloudKernel*> found = {&cloud_kernel_baseline};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) found.push_back(&cloud_kernel_avx2);
#endif
    return found;
}

/// Group points at the places 0 to 3, with up to k neighbours each, on a bent and turned patch.
struct Group {
    std::size_t k;
    std::vector<double> points = std::vector<double>(3 * fit_lanes);
    std::vector<std::int32_t> rows;
    LaneNeighborhoods lanes;

    Group(Random& random, std::size_t neighbors, double spread) : k(neighbors), lanes(neighbors) {
        rows.assign(fit_lanes * k, -1);
        const std::vector<double> turn = support::random_rotation(random);
        for (std::size_t l = 0; l < fit_lanes; ++l) {
            const std::size_t count = random.below(4) == 0 ? random.below(k + 1) : k;
            const double part = random.below(5) == 0 ? 0.5 : 1;  // of a turn: half of one makes open fans
            for (std::size_t j = 0; j < count; ++j) {
                const double angle = part * 2 * std::numbers::pi * random.uniform();
                const double r = spread == 0 ? std::sqrt(random.uniform()) : std::exp(-spread * random.uniform());
                const double u = r * std::cos(angle), v = r * std::sin(angle);
                rows[l * k + j] = static_cast<std::int32_t>(points.size() / 3);
                const std::vector<double> p =
                    support::times(turn, {u, v, 0.1 * u * u - 0.07 * u * v + 0.01 * random.normal()});
                points.insert(points.end(), p.begin(), p.end());
            }
        }
        gather();
    }
    void gather() { lanes.gather(Points(points), 0, fit_lanes, rows.data(), k); }
    Neighborhood alone(std::size_t l) const {
        Neighborhood one(k);
        one.gather(Points(points), l, rows.data() + l * k, k);
        return one;
    }
};

void set(LaneValues (&to)[3], std::size_t l, Vec3 a) {
    to[0][l] = a.x, to[1][l] = a.y, to[2][l] = a.z;
}
Vec3 get(const LaneValues (&from)[3], std::size_t l) {
    return {from[0][l], from[1][l], from[2][l]};
}

}  // namespace

TEST(LaneNeighborhoods, HoldWhatOneHolds) {
    Random random(1);
    for (const std::size_t k : {1, 7, 20, 36, 37, 50}) {
        Group group(random, k, 3);
        group.points[0] = 1e300;  // differences of any size
        group.gather();
        EXPECT_EQ(group.lanes.in_lanes(), k <= 36);
        for (std::size_t l = 0; l < fit_lanes; ++l) {
            const Neighborhood one = group.alone(l), &other = group.lanes.alone(l);
            ASSERT_EQ(one.count, other.count);
            ASSERT_EQ(one.scale, other.scale);
            ASSERT_EQ(one.scale, group.lanes.scale(l));
            for (std::size_t j = 0; j < padded(one.count); ++j) {
                ASSERT_EQ(one.x[j], other.x[j]);
                ASSERT_EQ(one.y[j], other.y[j]);
                ASSERT_EQ(one.z[j], other.z[j]);
                if (j < one.count) { ASSERT_EQ(one.index[j], other.index[j]); }
            }
        }
    }
}

TEST(CloudKernel, PrincipalDirectionsAsAlone) {
    Random random(2);
    for (const CloudKernel* kernel : kernels())
        for (const bool weighted : {false, true}) {
            int found = 0, all = 0;
            for (int trial = 0; trial < 500; ++trial) {
                Group group(random, 3 + random.below(34), 0);
                LaneNormals normals;
                kernel->principal(group.lanes.patches(), group.lanes.counts(), weighted, normals);
                for (std::size_t l = 0; l < fit_lanes; ++l) {
                    const Vec3 alone = principal_normal(group.alone(l), weighted), n = get(normals.n, l);
                    if (group.lanes.counts()[l] < 5) continue;
                    ++all;
                    if (!normals.found[l]) continue;
                    ++found;
                    ASSERT_GT(std::abs(dot(alone, n)), 1 - 1e-13);
                    ASSERT_NEAR(length(n), 1, 1e-15);
                    ASSERT_GE(n.z, 0);
                }
            }
            EXPECT_GT(found, 0.95 * all);
        }
}

TEST(CloudKernel, LinesAndNothingHaveNoPrincipalDirection) {
    Random random(3);
    Group group(random, 12, 0);
    for (std::size_t j = 0; j < 12; ++j)
        for (int a = 0; a < 3; ++a) {
            if (group.rows[j] >= 0) group.points[3 * static_cast<std::size_t>(group.rows[j]) + a] = double(j) * (a + 1);
            group.rows[12 + j] = -1;
        }
    group.gather();
    for (const CloudKernel* kernel : kernels()) {
        LaneNormals normals;
        kernel->principal(group.lanes.patches(), group.lanes.counts(), false, normals);
        EXPECT_FALSE(normals.found[0]);
        EXPECT_FALSE(normals.found[1]);
    }
}

/// A fan that the kernel finds is that of `build_fan`, from the same corner on; and it finds nearly all closed ones.
TEST(CloudKernel, FansAsAlone) {
    Random random(4);
    for (const CloudKernel* kernel : kernels())
        for (const double spread : {0.0, 6.0}) {
            int found = 0, closed = 0;
            for (int trial = 0; trial < 3000; ++trial) {
                const Group group(random, 3 + random.below(34), spread);
                LaneValues normal[3];
                for (std::size_t l = 0; l < fit_lanes; ++l) set(normal, l, principal_normal(group.alone(l), false));
                LaneFans fans;
                kernel->fans(group.lanes.patches(), group.lanes.counts(), normal, fans);
                for (std::size_t l = 0; l < fit_lanes; ++l) {
                    Fan fan(group.k);
                    build_fan(group.alone(l), get(normal, l), fan);
                    closed += fan.closed;
                    if (fans.corners[l] == 0) continue;
                    ++found;
                    ASSERT_TRUE(fan.closed);
                    ASSERT_EQ(fan.corners, static_cast<std::size_t>(fans.corners[l]));
                    for (std::size_t c = 0; c < fan.corners; ++c) ASSERT_EQ(fan.chain[c], fans.chain[c][l]);
                }
            }
            EXPECT_GT(found, spread == 0 ? 0.99 * closed : 0.9 * closed);
        }
}

/// What hangs on rounding is left to `build_fan`: cocircular, collinear, equally near or repeated neighbours.
TEST(CloudKernel, FansThatHangOnRoundingAreLeft) {
    Random random(5);
    const std::vector<std::vector<double>> planes = {
        {1, 0, 2, 0, 0, 1.5, -3, 0.1, 0.1, -2, 1.9, 1.4},  // two on a ray, which makes no doubt,
        {1, 0, 0, 1.5, -3, 0.1, 0.1, -2, 1, 1.5, 7, 7},    // a rectangle with the centre,
        {1, 0, 0, 2, -2, 0.1, 0.1, -3, 3, 3, 0, 1},        // two equally near,
        {1, 0, -1.5, 0, 0, 2, 0.5, 3, -0.5, 3, -0.1, 7},   // the centre on the border,
    };
    for (const double turn : {0.0, 0.7}) {
        Group group(random, 6, 0);
        for (std::size_t l = 0; l < fit_lanes; ++l) {
            for (std::size_t j = 0; j < 6; ++j) {
                group.rows[l * 6 + j] = static_cast<std::int32_t>(group.points.size() / 3);
                const double x = planes[l][2 * j], y = planes[l][2 * j + 1];
                for (const double v : {std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y,
                                       0.1 * random.uniform()})
                    group.points.push_back(v);
            }
        }
        group.gather();
        LaneValues normal[3];
        for (std::size_t l = 0; l < fit_lanes; ++l) set(normal, l, {0, 0, 1});
        for (const CloudKernel* kernel : kernels()) {
            LaneFans fans;
            kernel->fans(group.lanes.patches(), group.lanes.counts(), normal, fans);
            EXPECT_EQ(fans.corners[0], 4);
            EXPECT_EQ(fans.corners[1], 0);
            if (turn == 0) {  // turned, one may be nearer by a bit
                EXPECT_EQ(fans.corners[2], 0);
            }
            EXPECT_EQ(fans.corners[3], 0);
            set(normal, 0, {nan_value, nan_value, nan_value});
            kernel->fans(group.lanes.patches(), group.lanes.counts(), normal, fans);
            EXPECT_EQ(fans.corners[0], 0);
            set(normal, 0, {0, 0, 1});
        }
    }
}

TEST(CloudKernel, EnergiesOfTriangles) {
    Random random(6);
    for (const CloudKernel* kernel : kernels())
        for (const bool align : {false, true}) {
            LaneStrips strips = {};
            for (std::size_t l = 0; l < fit_lanes; ++l) {
                strips.count[l] = static_cast<std::int32_t>(l == 0 ? 0 : 3 + 4 * l);
                for (int c = 0; c < LaneStrips::most_others; ++c) {
                    set(strips.d[c], l, {random.normal(), random.normal(), random.normal()});
                    set(strips.n[c], l, unit({random.normal(), random.normal(), random.normal()}));
                }
                set(strips.normal, l, unit({random.normal(), random.normal(), random.normal()}));
            }
            set(strips.d[2], 1, 2 * get(strips.d[1], 1));            // a triangle without area
            set(strips.n[1], 2, {nan_value, nan_value, nan_value});  // two undefined ones
            LaneEnergies energies = {{1, 1, 1, 1}, {2, 2, 2, 2}};    // which are added to
            kernel->energies(strips, align, energies);
            for (std::size_t l = 0; l < fit_lanes; ++l) {
                double kappa = 1, area = 2;
                const Vec3 n = get(strips.normal, l);
                const auto other = [&](int c) {
                    const Vec3 m = get(strips.n[c], l);
                    return align && dot(m, n) < 0 ? -m : m;
                };
                for (int c = 1; c < strips.count[l]; ++c) {
                    const Vec3 a = get(strips.d[c - 1], l), b = get(strips.d[c], l);
                    const double twice = length(cross(a, b));
                    const double cotangents[3] = {dot(a, b) / twice, dot(a, a - b) / twice, dot(b, b - a) / twice};
                    const double sum = cotangents[0] * squared(other(c) - other(c - 1)) +
                                       cotangents[1] * squared(other(c) - n) +
                                       cotangents[2] * squared(other(c - 1) - n);
                    if (!std::isfinite(sum) || twice < 1e-12) continue;
                    kappa += sum / 2, area += twice / 2;
                }
                ASSERT_NEAR(energies.kappa[l], kappa, 1e-9 * kappa) << l;
                ASSERT_NEAR(energies.area[l], area, 1e-12 * area) << l;
            }
        }
}

/// Around the tip of a pyramid with many sides, normals along its edges: more corners than go through at once.
TEST(CloudKernel, LargeFans) {
    for (const int sides : {5, 16, 17, 30, 33, 40}) {
        std::vector<double> points = {0, 0, 1}, normals = {0, 0, 1};
        for (int s = 0; s < sides; ++s) {
            const double angle = 2 * std::numbers::pi * s / sides, x = std::cos(angle), y = std::sin(angle);
            points.insert(points.end(), {x, y, 0});
            normals.insert(normals.end(), {std::sqrt(0.5) * x, std::sqrt(0.5) * y, std::sqrt(0.5)});
        }
        CloudCurvatureOptions options;
        options.estimator = Estimator::dirichlet;
        options.k = sides;
        const CloudCurvature result = cloud_curvature(points, normals, options);
        // Each side has two edges of length √2 and one of 2 sin(π/sides).
        const double half = std::sin(std::numbers::pi / sides), height = std::sqrt(2 - half * half);
        const double base_change = 2 * half * half, edge_change = 2 - std::sqrt(2.0);  // of the normals, squared
        const double kappa = ((1 - half * half) * base_change + 2 * half * half * edge_change) / (2 * half * height);
        EXPECT_NEAR(result.kappa[0], sides * kappa, 1e-12 * sides * kappa) << sides;
        EXPECT_NEAR(result.density[0], kappa / (half * height), 1e-12 * kappa / (half * height)) << sides;
    }
}

#ifdef __x86_64__
template <class T>
std::array<std::byte, sizeof(T)> bytes_of(const T& value) {
    return std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
}

TEST(CloudKernel, SameBitsFromEveryInstructionSet) {
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this machine has no AVX2";
    const CloudKernel &one = cloud_kernel_baseline, &other = cloud_kernel_avx2;
    Random random(7);
    for (int trial = 0; trial < 2000; ++trial) {
        const Group group(random, 3 + random.below(34), trial % 2 == 0 ? 0 : 8);
        const LanePatches& patches = group.lanes.patches();
        const LaneCounts& counts = group.lanes.counts();
        LaneNormals normals[2] = {};
        for (const bool weighted : {false, true}) {
            one.principal(patches, counts, weighted, normals[0]);
            other.principal(patches, counts, weighted, normals[1]);
            ASSERT_EQ(bytes_of(normals[0]), bytes_of(normals[1]));
        }
        LaneFans fans[2] = {};
        one.fans(patches, counts, normals[0].n, fans[0]);
        other.fans(patches, counts, normals[0].n, fans[1]);
        for (std::size_t l = 0; l < fit_lanes; ++l) {
            ASSERT_EQ(fans[0].corners[l], fans[1].corners[l]);
            for (int c = 0; c < fans[0].corners[l]; ++c) ASSERT_EQ(fans[0].chain[c][l], fans[1].chain[c][l]);
        }
        LaneStrips strips = {};
        for (std::size_t l = 0; l < fit_lanes; ++l) {
            strips.count[l] = static_cast<std::int32_t>(random.below(LaneStrips::most_others + 1));
            set(strips.normal, l, get(normals[0].n, l));
            for (int c = 0; c < strips.count[l]; ++c) {
                set(strips.d[c], l, {random.normal(), random.normal(), random.normal()});
                set(strips.n[c], l, unit({random.normal(), random.normal(), random.normal()}));
            }
        }
        LaneEnergies energies[2] = {};
        one.energies(strips, trial % 3 == 0, energies[0]);
        other.energies(strips, trial % 3 == 0, energies[1]);
        ASSERT_EQ(bytes_of(energies[0]), bytes_of(energies[1]));
    }
}
#endif
