// The fused pass compiled for each instruction set: the same bits from all, for any number of faces.
#include "../../src/vertex_density.h"
#include "gaussmap/surfaces.h"
#include "support.h"

using namespace gaussmap;

namespace {

struct Outcome {
    std::vector<double> sums, kappa, density;
};

Outcome run(const FusedKernel& kernel, const Surface& s, std::size_t faces) {
    Outcome out{std::vector<double>(2 * s.density.size()), std::vector<double>(faces), std::vector<double>(faces)};
    FusedPass pass{s.vertices.data(),
                   s.normals.data(),
                   s.faces.data(),
                   out.sums.data(),
                   out.kappa.data(),
                   out.density.data(),
                   nullptr,
                   0,
                   nullptr};
    kernel.faces(pass, 0, faces);
    kernel.divide(out.sums.data(), s.density.size());
    return out;
}

}  // namespace

#ifdef __x86_64__
TEST(FusedKernel, SameBitsFromEveryInstructionSet) {
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this machine has no AVX2";
    Surface s = bumpy_sphere(1, 0.2, 3, 3, {.jitter = 0.3, .noise = 0, .seed = 11});
    s.vertices[30] = std::nan("");                                          // an undefined corner
    for (int c = 0; c < 3; ++c) s.vertices[150 + c] = s.vertices[153 + c];  // two vertices at one place
    for (std::size_t faces : {0, 1, 2, 3, 4, 5, 7, 8, 9, 1000, 1279, 1280}) {
        const Outcome one = run(fused_kernel_baseline, s, faces), other = run(fused_kernel_avx2, s, faces);
        EXPECT_TRUE(support::same_bits(one.sums, other.sums)) << faces;
        EXPECT_TRUE(support::same_bits(one.kappa, other.kappa)) << faces;
        EXPECT_TRUE(support::same_bits(one.density, other.density)) << faces;
        EXPECT_EQ(fused_kernel_baseline.highest(s.faces.data(), 3 * faces),
                  fused_kernel_avx2.highest(s.faces.data(), 3 * faces));
    }
}
#endif

TEST(FusedKernel, HighestIndexReadsNegativeOnesAsBeyondAnyVertex) {
    const std::vector<std::int32_t> indices = {3, 9, 2, 7, 9, 0, 1, 8, 4};
    EXPECT_EQ(fused_kernel_baseline.highest(indices.data(), 9), 9u);
    const std::vector<std::int32_t> negative = {3, 9, -2};
    EXPECT_EQ(fused_kernel_baseline.highest(negative.data(), 3), 0xfffffffeu);
}
