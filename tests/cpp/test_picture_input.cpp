// Clouds, views, legend, PNG and everything that can be wrong.
#include <gtest/gtest.h>
#include <spng.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "gaussmap/picture.h"
#include "gaussmap/surfaces.h"
#include "support.h"

using namespace gaussmap;

namespace {

const double undefined = std::nan("");
const std::vector<std::int32_t> no_faces;

std::size_t drawn(const Picture& p, int x0, int y0, int x1, int y1) {
    std::size_t n = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const std::uint8_t* c = &p.rgb[3 * (static_cast<std::size_t>(y) * p.width + x)];
            n += c[0] != 255 || c[1] != 255 || c[2] != 255;
        }
    return n;
}
std::size_t drawn(const Picture& p) {
    return drawn(p, 0, 0, p.width, p.height);
}

PictureOptions plain(int width = 200, int height = 200) {
    PictureOptions o;
    o.width = width, o.height = height;
    o.label = "";
    return o;
}

template <class Work>
std::string complaint(Work&& work) {
    try {
        work();
    } catch (const std::invalid_argument& error) { return error.what(); }
    return "nothing";
}

std::string complaint_of(const PictureOptions& o) {
    const Surface s = sphere(1);
    return complaint([&] { draw(s.vertices, s.faces, s.density, {}, o); });
}

}  // namespace

TEST(PictureCloud, DiscsCoverTheSphere) {
    const Surface s = sphere(5);
    PictureOptions o = plain();
    o.direction = {0, 0, 1};
    for (const bool normals : {false, true}) {
        const Picture p = draw(s.vertices, no_faces, s.density, normals ? s.normals : std::vector<double>(), o);
        const double radius = 0.45 * 200;
        const double expected = 3.14159 * radius * radius;
        // The whole of the outermost discs is on the picture.
        EXPECT_GT(static_cast<double>(drawn(p)), 0.9 * expected);
        EXPECT_LT(static_cast<double>(drawn(p)), 1.01 * expected);
        // No holes inside.
        EXPECT_EQ(drawn(p, 50, 50, 150, 150), 100u * 100u) << normals;
    }
}

TEST(PictureCloud, OneColourShows) {
    const std::vector<double> vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    PictureOptions o = plain();
    o.direction = {0, 0, 1};
    o.low = 0, o.high = 1;
    const Picture p = draw(vertices, no_faces, {1, 1, 1, 1}, {}, o);
    const auto top = color_at(1);
    const std::uint8_t* c = &p.rgb[3 * (130 * 200 + 70)];  // the first point, down left
    EXPECT_NEAR(c[0], top[0], 1);
    EXPECT_NEAR(c[1], top[1], 1);
}

TEST(PictureCloud, LargeDiscsAreNotCutOff) {
    const Surface s = sphere(1);
    const Picture p = draw(s.vertices, no_faces, s.density, {}, plain());
    const std::size_t all = drawn(p);
    EXPECT_GT(all, 10000u);
    EXPECT_EQ(drawn(p, 1, 1, 199, 199), all);
}

TEST(PictureCloud, SinglePointAndCopies) {
    const std::vector<double> one = {3, 4, 5}, copies = {3, 4, 5, 3, 4, 5, 3, 4, 5};
    const Picture a = draw(one, no_faces, {1}, {}, plain());
    EXPECT_NEAR(static_cast<double>(drawn(a)), 3.14159 * 10 * 10, 60);
    const Picture b = draw(copies, no_faces, {1, 1, 1}, {}, plain());
    EXPECT_TRUE(a.rgb == b.rgb);
}

TEST(PictureCloud, NonFinitePointsAreLeftOut) {
    const Surface s = sphere(3);
    std::vector<double> vertices = s.vertices, values = s.density;
    vertices.insert(vertices.end(), {undefined, 0, 0, std::numeric_limits<double>::infinity(), 0, 0});
    values.insert(values.end(), {undefined, undefined});
    PictureOptions o = plain();
    o.high = 4;
    EXPECT_TRUE(draw(s.vertices, no_faces, s.density, {}, o).rgb == draw(vertices, no_faces, values, {}, o).rgb);
}

TEST(PictureMesh, BrokenFacesAreLeftOut) {
    const Surface s = sphere(3);
    std::vector<double> vertices = s.vertices, values = s.density;
    std::vector<std::int32_t> faces = s.faces;
    const auto n = static_cast<std::int32_t>(values.size());
    // A vertex that is not finite, and one of no face that lies far away.
    vertices.insert(vertices.end(), {undefined, 0, 0, 1e300, 0, -1e300});
    values.insert(values.end(), {0, 0});
    for (const std::int32_t index : {0, 1, n, 0, 0, 1, 2, 2, 2}) faces.push_back(index);
    PictureOptions o = plain();
    o.high = 4;
    EXPECT_TRUE(draw(s.vertices, s.faces, s.density, {}, o).rgb == draw(vertices, faces, values, {}, o).rgb);
}

TEST(PictureMesh, OddSizesOfObjectsAreAnswered) {
    const Surface s = sphere(2);
    for (const double scale : {1e-140, 1e-60, 1e60, 1e140}) {
        std::vector<double> vertices = s.vertices;
        for (double& v : vertices) v *= scale;
        EXPECT_GT(drawn(draw(vertices, s.faces, s.density, {}, plain())), 20000u) << scale;
        EXPECT_GT(drawn(draw(vertices, no_faces, s.density, {}, plain())), 5000u) << scale;
    }
    const std::vector<double> flat = {0, 0, 0, 1, 1, 1, 2, 2, 2};
    const std::vector<std::int32_t> face = {0, 1, 2};
    EXPECT_EQ(drawn(draw(flat, face, {1, 2, 3}, {}, plain())), 0u);
}

TEST(PictureViews, ContactSheetFillsItsQuarters) {
    const Surface s = ellipsoid(3, 2, 1, 4);
    PictureOptions o = plain(400, 400);
    o.views = 4;
    const Picture p = draw(s.vertices, s.faces, s.density, {}, o);
    for (const int x : {0, 200})
        for (const int y : {0, 200}) EXPECT_GT(drawn(p, x, y, x + 200, y + 200), 4000u) << x << ' ' << y;
    // A quarter turn and three show the same ellipsoid from opposite sides; the first shows it broader.
    EXPECT_GT(drawn(p, 0, 0, 200, 200), drawn(p, 200, 0, 400, 200));
}

TEST(PictureViews, LongSidesLieAcross) {
    // A board standing on its long edge, whatever the axis of its thickness: it covers most of the picture.
    for (const std::array<double, 3> sides : {std::array{3., 2., 1.}, {3., 1., 2.}, {1., 3., 2.}}) {
        const Surface s = ellipsoid(sides[0], sides[1], sides[2], 4);
        const double covered = static_cast<double>(drawn(draw(s.vertices, s.faces, s.density, {}, plain(300, 200))));
        EXPECT_GT(covered, 0.45 * 300 * 200) << sides[0] << sides[1] << sides[2];
    }
}

TEST(PictureLegend, IsDrawnBelowAndOnlyWhereItFits) {
    const Surface s = sphere(3);
    PictureOptions o;
    o.width = 640, o.height = 480;
    std::vector<double> values = s.density;
    const Picture p = draw(s.vertices, s.faces, values, {}, o);
    const std::size_t ink = drawn(p, 0, 440, 640, 480);
    EXPECT_GT(ink, 300u);
    // The bar holds both ends of the colour map.
    const auto holds = [&](const Picture& in, double value) {
        const auto color = color_at(value);
        for (int y = 400; y < 480; ++y)
            for (int x = 0; x < 640; ++x) {
                const std::uint8_t* c = &in.rgb[3 * (static_cast<std::size_t>(y) * 640 + x)];
                if (std::abs(c[0] - color[0]) + std::abs(c[1] - color[1]) + std::abs(c[2] - color[2]) <= 3) return true;
            }
        return false;
    };
    EXPECT_TRUE(holds(p, 0));
    EXPECT_TRUE(holds(p, 1));
    EXPECT_FALSE(holds(p, undefined));
    // Something undefined is said; another label changes the picture; no label, no legend.
    values[0] = undefined;
    EXPECT_TRUE(holds(draw(s.vertices, s.faces, values, {}, o), undefined));
    o.label = "kappa";
    EXPECT_NE(drawn(draw(s.vertices, s.faces, s.density, {}, o), 0, 400, 640, 480), drawn(p, 0, 400, 640, 480));
    o.label = "";
    EXPECT_EQ(drawn(draw(s.vertices, s.faces, s.density, {}, o), 0, 462, 640, 480), 0u);
    o = plain(64, 64);
    const Picture bare = draw(s.vertices, s.faces, s.density, {}, o);
    o.label = "too small to read";
    EXPECT_TRUE(bare.rgb == draw(s.vertices, s.faces, s.density, {}, o).rgb);
}

TEST(PictureLegend, AnyLabelIsAnswered) {
    const Surface s = sphere(1);
    PictureOptions o;
    o.width = 300, o.height = 300;
    for (const std::string& label :
         {std::string(2000, 'm'), std::string("\xff\xc2\xe2\x82"), std::string("漢字 κ €")}) {
        o.label = label;
        EXPECT_GT(drawn(draw(s.vertices, s.faces, s.density, {}, o)), 10000u);
    }
}

TEST(Png, DecodesToTheSamePixels) {
    const Surface s = torus(2, 0.5, 40, 20);
    const Picture p = draw(s.vertices, s.faces, s.density, {}, plain(123, 77));
    const std::string bytes = png_bytes(p);
    EXPECT_EQ(bytes, png_bytes(p));
    const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> context(spng_ctx_new(0), spng_ctx_free);
    ASSERT_EQ(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()), 0);
    spng_ihdr header;
    ASSERT_EQ(spng_get_ihdr(context.get(), &header), 0);
    EXPECT_EQ(header.width, 123u);
    EXPECT_EQ(header.height, 77u);
    std::vector<std::uint8_t> rgb(p.rgb.size());
    ASSERT_EQ(spng_decode_image(context.get(), rgb.data(), rgb.size(), SPNG_FMT_RGB8, 0), 0);
    EXPECT_TRUE(rgb == p.rgb);
}

TEST(Png, RefusesWhatIsNoPicture) {
    EXPECT_EQ(complaint([] { png_bytes({}); }),
              "png_bytes: a picture of 0 × 0 pixels with 0 bytes of rgb; there must be 3 a pixel, and a pixel");
    EXPECT_EQ(complaint([] {
                  png_bytes({4, 2, std::vector<std::uint8_t>(23), 0, 0, 0});
              }),
              "png_bytes: a picture of 4 × 2 pixels with 23 bytes of rgb; there must be 3 a pixel, and a pixel");
}

TEST(PictureErrors, Geometry) {
    const std::vector<double> none, three = {0, 0, 0, 1, 0, 0, 0, 1, 0},
                                    bad = {undefined, 0, 0, undefined, 0, 0, 0, 1, 0};
    const std::vector<double> far = {-1e308, 0, 0, 1e308, 0, 0, 0, 1e308, 0}, only_nan = {undefined, 0, 0};
    const std::vector<std::int32_t> face = {0, 1, 2}, outside = {0, 1, 3};
    const std::vector<double> values = {1, 2, 3};
    EXPECT_EQ(complaint([&] { draw(none, no_faces, none); }), "nothing to draw: there are no vertices");
    EXPECT_EQ(complaint([&] { draw(only_nan, no_faces, {1}); }), "nothing to draw: no vertex is finite");
    EXPECT_EQ(complaint([&] { draw(bad, face, values); }), "nothing to draw: no face has three finite corners");
    EXPECT_EQ(complaint([&] { draw(far, face, values); }),
              "the vertices are too far apart for double precision; scale them down");
    EXPECT_EQ(complaint([&] { draw(three, face, {1, 2}); }), "values has 2 entries, but there are 3 vertices");
    EXPECT_EQ(complaint([&] { draw(three, face, values, Points(three.data(), 2)); }),
              "normals has 2 entries, but there are 3 vertices");
    EXPECT_EQ(complaint([&] { draw(three, outside, values); }), "faces[0][2] = 3 is outside [0, 3)");
}

TEST(PictureErrors, Options) {
    PictureOptions o;
    o.width = 15;
    EXPECT_EQ(complaint_of(o), "draw: width = 15 must be between 16 and 16384");
    o = {}, o.height = 16385;
    EXPECT_EQ(complaint_of(o), "draw: height = 16385 must be between 16 and 16384");
    o = {}, o.views = 3;
    EXPECT_EQ(complaint_of(o), "draw: views = 3 must be 1 or 4");
    o = {}, o.low = 2, o.high = 2;
    EXPECT_EQ(
        complaint_of(o),
        "draw: a range from low = 2 to high = 2; low must be less than high, and both finite (or NaN: automatic)");
    o = {}, o.high = std::numeric_limits<double>::infinity();
    EXPECT_EQ(complaint_of(o).substr(0, 40), "draw: a range from low = nan to high = i");
    o = {}, o.direction = {0, undefined, 0};
    EXPECT_EQ(complaint_of(o), "draw: direction is not finite");
    o = {}, o.up = {0, undefined, 0};
    EXPECT_EQ(complaint_of(o), "draw: up is not finite");
    o = {}, o.direction = {0, 0, 2}, o.up = {0, 0, -1};
    EXPECT_EQ(complaint_of(o), "draw: direction and up are parallel; give another up");
    // Along the upward axis that would be chosen, another is.
    for (const std::array<double, 3> axis : {std::array{1., 0., 0.}, {0., 1., 0.}, {0., 0., -1.}}) {
        o = {}, o.direction = axis;
        EXPECT_EQ(complaint_of(o), "nothing");
        o = {}, o.up = axis;
        EXPECT_EQ(complaint_of(o), "nothing");
    }
}
