#include "gaussmap/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "gaussmap/surfaces.h"
#include "support.h"

using namespace gaussmap;

namespace {

using Rgb = std::array<int, 3>;

Rgb pixel(const Picture& p, int x, int y) {
    const std::uint8_t* c = &p.rgb[3 * (static_cast<std::size_t>(y) * p.width + x)];
    return {c[0], c[1], c[2]};
}

Rgb at(double value) {
    const auto c = color_at(value);
    return {c[0], c[1], c[2]};
}

constexpr Rgb white = {255, 255, 255};
const double undefined = std::nan("");

int difference(Rgb a, Rgb b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Seen along z, y upward, no legend, values from 0 to 1.
PictureOptions plain(int width = 200, int height = 200) {
    PictureOptions o;
    o.width = width, o.height = height;
    o.direction = {0, 0, 1}, o.up = {0, 1, 0};
    o.label = "";
    o.low = 0, o.high = 1;
    return o;
}

/// A square of side 2 in z = 0 about the origin, two faces.
struct Square {
    std::vector<double> vertices = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    std::vector<std::int32_t> faces = {0, 1, 2, 0, 2, 3};
};

std::size_t drawn(const Picture& p) {
    std::size_t n = 0;
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) n += pixel(p, x, y) != white;
    return n;
}

}  // namespace

TEST(ColorMap, GetsLighterEvenlyAndClamps) {
    double last = -1;
    for (int i = 0; i <= 100; ++i) {
        const auto c = color_at(i / 100.0);
        const double luminance = 0.2126 * std::pow(c[0] / 255.0, 2.2) + 0.7152 * std::pow(c[1] / 255.0, 2.2) +
                                 0.0722 * std::pow(c[2] / 255.0, 2.2);
        EXPECT_GT(std::cbrt(luminance) + 0.003, last) << i;
        last = std::cbrt(luminance);
    }
    EXPECT_EQ(color_at(-1), color_at(0));
    EXPECT_EQ(color_at(7), color_at(1));
    const auto grey = color_at(undefined);
    EXPECT_EQ(grey[0], grey[1]);
    EXPECT_EQ(grey[1], grey[2]);
}

TEST(ColorMap, DivergingIsLightAtZeroAndAsDarkEitherWay) {
    const auto luminance = [](double value) {
        const auto c = diverging_color_at(value);
        return std::cbrt(0.2126 * std::pow(c[0] / 255.0, 2.2) + 0.7152 * std::pow(c[1] / 255.0, 2.2) +
                         0.0722 * std::pow(c[2] / 255.0, 2.2));
    };
    for (int i = 0; i < 50; ++i) {
        EXPECT_GT(luminance(i / 50.0) + 0.003, luminance((i + 1) / 50.0)) << i;
        EXPECT_NEAR(luminance(i / 50.0), luminance(-i / 50.0), 0.05) << i;
    }
    const auto below = diverging_color_at(-1), zero = diverging_color_at(0), above = diverging_color_at(1);
    EXPECT_GT(below[2], below[0] + 60) << "blue";
    EXPECT_GT(above[0], above[2] + 60) << "red";
    EXPECT_TRUE(zero[0] == zero[1] && zero[1] == zero[2] && zero[0] > 200);
    EXPECT_EQ(diverging_color_at(-7), below);
    EXPECT_EQ(diverging_color_at(7), above);
    EXPECT_EQ(diverging_color_at(undefined), color_at(undefined));
}

TEST(Picture, DivergingColoursReachAsFarEitherWay) {
    const Square s;
    PictureOptions o = plain();
    o.low = o.high = undefined;
    o.density = false;
    const auto range = [&](const std::vector<double>& values, bool diverging) {
        o.diverging = diverging;
        const Picture p = draw(s.vertices, s.faces, values, {}, o);
        return std::vector<double>{p.low, p.high};
    };
    EXPECT_EQ(range({-3, -3, -3, 2}, true), (std::vector<double>{-3, 3}));
    EXPECT_EQ(range({2, 2, 2, 2}, true), (std::vector<double>{0, 2}));
    EXPECT_EQ(range({-2, -2, -2, -2}, true), (std::vector<double>{-2, 0}));
    EXPECT_EQ(range({0, 0, 0, 0}, true), (std::vector<double>{0, 1}));
    EXPECT_EQ(range({2, 2, 2, 2}, false), (std::vector<double>{0, 2}));

    o.diverging = true;
    o.low = -2, o.high = 1;  // half way up to 1 is as red as −1 is blue, however far the other end is
    const Picture p = draw(s.vertices, s.faces, {1, 1, 1, 1}, {}, o);
    const auto half = diverging_color_at(0.5);
    EXPECT_LE(difference(pixel(p, 100, 100), {half[0], half[1], half[2]}), 3);
}

TEST(Picture, SphereCoversItsDisc) {
    const Surface s = sphere(5);
    const Picture p = draw(s.vertices, s.faces, s.density, s.normals, plain(400, 300));
    ASSERT_EQ(p.rgb.size(), 3u * 400 * 300);
    // The diameter fills 90 % of the shorter side; pixels that are touched reach half a pixel further.
    const double radius = 0.45 * 300;
    EXPECT_NEAR(static_cast<double>(drawn(p)), std::numbers::pi * (radius + 0.5) * (radius + 0.5), 0.01 * drawn(p));
    EXPECT_EQ(pixel(p, 200 - 133, 150) == white, false);
    EXPECT_EQ(pixel(p, 200 - 137, 150), white);
}

TEST(Picture, SilhouetteIsSmooth) {
    const Surface s = sphere(5);
    const Picture p = draw(s.vertices, s.faces, s.density, s.normals, plain());
    std::size_t between = 0;  // pixels that the edge crosses
    for (int y = 1; y < 199; ++y)
        for (int x = 1; x < 199; ++x) {
            const int green = pixel(p, x, y)[1];
            if (green < 250 && (pixel(p, x - 1, y) == white || pixel(p, x + 1, y) == white) && green > 200) ++between;
        }
    EXPECT_GT(between, 50u);
}

TEST(Picture, SquareToTheEyeShowsTheColourItself) {
    const Square s;
    for (const double value : {0.0, 0.25, 0.5, 0.8, 1.0}) {
        const Picture p = draw(s.vertices, s.faces, std::vector<double>(4, value), {}, plain());
        EXPECT_LE(difference(pixel(p, 100, 100), at(value)), 1) << value;
        EXPECT_LE(difference(pixel(p, 30, 160), at(value)), 1) << value;
        EXPECT_EQ(pixel(p, 5, 5), white);
    }
}

TEST(Picture, InterpolatesValuesBeforeColours) {
    const Square s;
    const Picture p = draw(s.vertices, s.faces, {0, 1, 1, 0}, {}, plain());
    // The square spans pixels 10 to 190.
    for (const int x : {20, 60, 100, 140, 180})
        EXPECT_LE(difference(pixel(p, x, 130), at((x + 0.5 - 10) / 180)), 2) << x;
}

TEST(Picture, NearestFaceWins) {
    Square s;
    const std::size_t n = s.vertices.size();
    for (std::size_t i = 0; i < n; ++i) s.vertices.push_back(i % 3 == 2 ? 0.5 : s.vertices[i] / 2);
    for (const std::int32_t index : {0, 1, 2, 0, 2, 3}) s.faces.push_back(index + 4);
    const std::vector<double> values = {0, 0, 0, 0, 1, 1, 1, 1};
    Picture p = draw(s.vertices, s.faces, values, {}, plain());
    EXPECT_LE(difference(pixel(p, 100, 100), at(1)), 1);
    EXPECT_LE(difference(pixel(p, 30, 30), at(0)), 1);
    // From behind, the small square is hidden.
    PictureOptions behind = plain();
    behind.direction = {0, 0, -1};
    p = draw(s.vertices, s.faces, values, {}, behind);
    EXPECT_LE(difference(pixel(p, 100, 100), at(0)), 1);
}

TEST(Picture, FirstFaceWinsAtEqualDepth) {
    Square s;
    s.vertices.insert(s.vertices.end(), s.vertices.begin(), s.vertices.end());
    for (const std::int32_t index : {4, 5, 6, 4, 6, 7}) s.faces.push_back(index);
    const Picture p = draw(s.vertices, s.faces, {0, 0, 0, 0, 1, 1, 1, 1}, {}, plain());
    for (int x = 20; x < 180; x += 7) EXPECT_LE(difference(pixel(p, x, 61), at(0)), 1) << x;
}

TEST(Picture, FacesLeaveNoGaps) {
    const Surface s = plane(2, 2, 150, 150, {.jitter = 0.25, .seed = 3});
    const Picture p = draw(s.vertices, s.faces, std::vector<double>(s.density.size(), 1.0), s.normals, plain());
    for (int y = 12; y < 188; ++y)
        for (int x = 12; x < 188; ++x) ASSERT_LE(difference(pixel(p, x, y), at(1)), 1) << x << ' ' << y;
}

TEST(Picture, UndefinedIsGreyAndCounted) {
    const Square s;
    const double infinite = std::numeric_limits<double>::infinity();
    const Picture p = draw(s.vertices, s.faces, {undefined, infinite, 1, 1}, {}, plain());
    EXPECT_EQ(p.undefined, 2u);
    EXPECT_LE(difference(pixel(p, 100, 185), at(undefined)), 1);
    EXPECT_LE(difference(pixel(p, 100, 15), at(1)), 1);
    const Picture none = draw(s.vertices, s.faces, {undefined, undefined, undefined, undefined}, {}, plain());
    EXPECT_EQ(none.undefined, 4u);
    EXPECT_LE(difference(pixel(none, 60, 60), at(undefined)), 1);
}

TEST(Picture, RangeIsZeroToThe98thPercentile) {
    std::vector<double> vertices, values;
    for (int i = 0; i <= 100; ++i) {
        vertices.insert(vertices.end(), {i / 10.0, i % 7 / 7.0, 0});
        values.push_back(i == 50 ? undefined : i);
    }
    PictureOptions o = plain();
    o.low = o.high = undefined;
    const std::vector<std::int32_t> faces = {0, 1, 2};
    Picture p = draw(vertices, faces, values, {}, o);
    EXPECT_EQ(p.low, 0);
    EXPECT_NEAR(p.high, 98.02, 1e-9);  // rank 0.98 · 99 of the 100 defined
    for (double& value : values) value -= 50;
    p = draw(vertices, faces, values, {}, o);
    EXPECT_NEAR(p.low, -48.02, 1e-9);
    o.low = 3;
    o.high = 4;
    p = draw(vertices, faces, values, {}, o);
    EXPECT_EQ(p.low, 3);
    EXPECT_EQ(p.high, 4);
}

TEST(Picture, PlaneOfNoiseLooksLikeAPlane) {
    Surface s = plane(1, 1, 20, 20);
    support::Random random(5);
    for (double& value : s.density) value = 1e-15 * random.uniform();
    PictureOptions o = plain();
    o.low = o.high = undefined;
    Picture p = draw(s.vertices, s.faces, s.density, s.normals, o);
    for (int y = 15; y < 185; y += 5)
        for (int x = 15; x < 185; x += 5) ASSERT_LE(difference(pixel(p, x, y), at(0)), 1) << x << ' ' << y;
    EXPECT_EQ(p.low, 0);
    EXPECT_NEAR(p.high, 0.5, 1e-12);  // 1/diagonal²
    // What is no density may be as small as it likes.
    o.density = false;
    p = draw(s.vertices, s.faces, s.density, s.normals, o);
    EXPECT_LT(p.high, 1e-15);
}

TEST(Picture, ConstantValueHasTheTopColour) {
    const Surface s = sphere(3);
    PictureOptions o = plain();
    o.low = o.high = undefined;
    const Picture p = draw(s.vertices, s.faces, std::vector<double>(s.density.size(), 2.0), s.normals, o);
    EXPECT_EQ(p.high, 2);
    EXPECT_LE(difference(pixel(p, 100, 100), at(1)), 8);
}

TEST(Picture, FarOriginChangesNothing) {
    const Surface s = torus(2, 0.5, 40, 20);  // coordinates that survive the offset would be dyadic; compare loosely
    std::vector<double> moved = s.vertices;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += 5e6;
    PictureOptions o = plain();
    o.high = 8;
    const Picture a = draw(s.vertices, s.faces, s.density, s.normals, o);
    const Picture b = draw(moved, s.faces, s.density, s.normals, o);
    std::size_t different = 0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) different += difference(pixel(a, x, y), pixel(b, x, y)) > 3;
    EXPECT_LT(different, 20u);
}

TEST(Picture, NormalsOfEitherSignLookAlike) {
    const Surface s = sphere(4);
    std::vector<double> inward = s.normals;
    for (double& v : inward) v = -3 * v;
    const Picture a = draw(s.vertices, s.faces, s.density, s.normals, plain());
    const Picture b = draw(s.vertices, s.faces, s.density, inward, plain());
    std::size_t different = 0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) different += difference(pixel(a, x, y), pixel(b, x, y)) > 1;
    EXPECT_EQ(different, 0u);
}

TEST(PictureThreads, SameBytes) {
    const Surface s = torus_knot(2, 3, 2, 1, 0.3, 300, 24);
    for (const bool cloud : {false, true})
        for (const int views : {1, 4}) {
            PictureOptions o;
            o.width = 500, o.height = 400, o.views = views;
            const std::vector<std::int32_t> none;
            std::vector<Picture> pictures;
            for (const int threads : {1, 2, 7}) {
                o.run.threads = threads;
                pictures.push_back(draw(s.vertices, cloud ? none : s.faces, s.density, s.normals, o));
            }
            EXPECT_TRUE(pictures[0].rgb == pictures[1].rgb) << cloud << views;
            EXPECT_TRUE(pictures[0].rgb == pictures[2].rgb) << cloud << views;
            EXPECT_GT(drawn(pictures[0]), 20000u);
        }
}

TEST(Picture, ProgressAndCancel) {
    const Surface s = torus(2, 0.5, 40, 20);
    double last = 0;
    PictureOptions o = plain();
    o.views = 4;
    o.run.threads = 1;
    o.run.progress = [&](double f) {
        EXPECT_GE(f, last);
        last = f;
        return true;
    };
    draw(s.vertices, s.faces, s.density, {}, o);
    EXPECT_NEAR(last, 1, 1e-12);
    o.run.progress = [](double) { return false; };
    EXPECT_THROW(draw(s.vertices, s.faces, s.density, {}, o), Cancelled);
}
