// What the residuals of a window's quadric tell that it has met.
#include "../../src/far_side.h"

#include "support.h"

using namespace gaussmap;

TEST(FarSide, IsMetWhereResidualsAreLargeBesideTheRadius) {
    EXPECT_FALSE(meets_far_side(1.5F, 0.5F, 10)) << "0.01 of the squared radius";
    EXPECT_TRUE(meets_far_side(2.5F, 0.5F, 10)) << "0.02";
}

TEST(FarSide, SaddlesAreToldByTheProductOfTheCurvatures) {
    EXPECT_FLOAT_EQ(saddle({.xx = 2, .yy = -2}), -0.5F);
    EXPECT_FLOAT_EQ(saddle({.xx = 3, .zz = 3}), 0.5F);
    EXPECT_FLOAT_EQ(saddle({.yy = -4}), 0) << "a tube";
    EXPECT_NEAR(saddle({.xx = -10 / 3.0, .zz = 1 / 0.7}), -0.362F, 0.001F) << "the rim of a hole";
    EXPECT_TRUE(is_hole(-0.362F));
    EXPECT_FALSE(is_hole(-0.2F));
}

TEST(FarSide, BendsOfAShapeLeaveResiduals) {
    // Windows of radius 2 on a shape of density 1: (h²ρ)³ = 64.
    EXPECT_TRUE(is_bend(0.1F + 0.05F * 4, 0.1F, 2, 1, false));
    EXPECT_FALSE(is_bend(0.1F + 0.07F * 4, 0.1F, 2, 1, false)) << "all of a tube";
    EXPECT_TRUE(is_bend(0.1F + 0.19F * 4, 0.1F, 2, 1, true)) << "of a hole";
    EXPECT_FALSE(is_bend(0.1F + 0.21F * 4, 0.1F, 2, 1, true));
    // A flatter shape: 1, of which 0.005 may be left.
    EXPECT_TRUE(is_bend(0.1F + 0.004F * 4, 0.1F, 2, 0.25F, true));
    EXPECT_FALSE(is_bend(0.1F + 0.006F * 4, 0.1F, 2, 0.25F, true));
}
