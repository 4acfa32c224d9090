// Polygons become triangles: the whole of them, facing as they do, in time that their size justifies; welding and
// triangulating keep the properties beside their faces.
#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using gaussmap::Property;
using support::has_note;
using support::values_of;

namespace {

using Indices = std::vector<std::int32_t>;
using Values = std::vector<double>;

/// One polygon over all the points, in their order.
Geometry polygon(const Values& points) {
    const std::size_t n = points.size() / 3;
    std::string text = "OFF\n" + std::to_string(n) + " 1 0\n", corners = std::to_string(n);
    for (std::size_t i = 0; i < points.size(); ++i) {
        char number[40];
        std::snprintf(number, sizeof number, "%.17g%c", points[i], i % 3 == 2 ? '\n' : ' ');
        text += number;
    }
    for (std::size_t i = 0; i < n; ++i) corners += " " + std::to_string(i);
    return gaussmap::read_bytes(text + corners + "\n", "p.off", Format::off);
}

struct Cover {
    double area = 0,
           smallest = INFINITY;  // sum of the triangles' areas; the least, signed by the way the polygon faces
};

Cover cover_of(const Geometry& g) {
    const auto cross = [&](const double* a, const double* b, const double* c) {
        const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
        return Values{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    };
    const auto dot = [](const Values& a, const Values& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const double* const p = g.vertices.data();
    Values normal = {0, 0, 0};
    for (std::size_t i = 1; i + 1 < g.vertex_count(); ++i) {
        const Values n = cross(p, p + 3 * i, p + 3 * i + 3);
        for (int c = 0; c < 3; ++c) normal[c] += n[c];
    }
    Cover cover;
    for (std::size_t t = 0; t < g.face_count(); ++t) {
        const std::int32_t* f = g.faces.data() + 3 * t;
        const Values n = cross(p + 3 * f[0], p + 3 * f[1], p + 3 * f[2]);
        cover.area += std::sqrt(dot(n, n)) / 2;
        cover.smallest = std::min(cover.smallest, dot(n, normal) / std::sqrt(dot(normal, normal)) / 2);
    }
    return cover;
}

/// The polygon, wherever it is and however it starts, is cut into n − 2 triangles of its area, none turned over.
void expect_covered(const Values& flat, double area) {
    support::Random random(5);
    const std::size_t n = flat.size() / 2;
    for (std::size_t start = 0; start < n; ++start) {
        Values points;
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t k = (start + i) % n;
            points.insert(points.end(), {flat[2 * k], flat[2 * k + 1], 0});
        }
        points = support::times(support::random_rotation(random), points);
        for (std::size_t i = 0; i < points.size(); ++i) points[i] += 1e6 * static_cast<double>(i % 3);
        const Geometry g = polygon(points);
        EXPECT_EQ(g.face_count(), n - 2);
        const Cover cover = cover_of(g);
        EXPECT_NEAR(cover.area, area, 1e-8 * area) << "from corner " << start;
        EXPECT_GE(cover.smallest, -1e-9 * area) << "from corner " << start;
    }
}

TEST(Polygons, ConvexAndNot) {
    expect_covered({0, 0, 2, 0, 2, 1, 0, 1}, 2);                                      // a rectangle
    expect_covered({0, 0, 2, 0, 0.5, 0.5, 0, 2}, 1);                                  // a dart: one diagonal only
    expect_covered({0, 0, 1, 0, 2, 0, 2, 2, 0, 2}, 4);                                // a corner within a side
    expect_covered({0, 0, 3, 0, 3, 1, 1, 1, 1, 3, 0, 3}, 5);                          // an L
    expect_covered({0, 0, 4, 0, 4, 3, 3, 3, 3, 1, 1, 1, 1, 3, 0, 3}, 8);              // a U
    expect_covered({0, 0, 1, 0, 2, 0, 3, 0, 3, 3, 2, 3, 2, 1, 1, 1, 1, 3, 0, 3}, 7);  // a U with corners within sides
    Values star;
    for (int i = 0; i < 20; ++i) {
        const double angle = std::numbers::pi * i / 10, r = i % 2 ? 0.3 : 1;
        star.insert(star.end(), {r * std::cos(angle), r * std::sin(angle)});
    }
    expect_covered(star, 10 * 0.3 * std::sin(std::numbers::pi / 10));
}

TEST(Polygons, SpiralBeyondAFan) {
    Values outer, inner;
    for (int i = 0; i <= 200; ++i) {
        const double angle = 0.1 * i, r = 1 + 0.3 * angle;
        outer.insert(outer.end(), {(r + 0.5) * std::cos(angle), (r + 0.5) * std::sin(angle), 0});
        inner.insert(inner.begin(), {r * std::cos(angle), r * std::sin(angle), 0});
    }
    Values points = outer;
    points.insert(points.end(), inner.begin(), inner.end());
    double area = 0;
    for (std::size_t i = 0, n = points.size() / 3; i < n; ++i) {
        const double *a = &points[3 * i], *b = &points[3 * ((i + 1) % n)];
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    const Cover cover = cover_of(polygon(points));
    EXPECT_NEAR(cover.area, area, 1e-9 * area);
    EXPECT_GT(cover.smallest, 0);
}

TEST(Polygons, QuadsTakeTheShorterDiagonal) {
    EXPECT_EQ(polygon({0, 0, 0, 2, 0, 0, 3, 1, 0, 1, 1, 0}).faces, (Indices{0, 1, 3, 1, 2, 3}));
    EXPECT_EQ(polygon({0, 0, 0, 2, 0, 0, 1, 1, 0, -1, 1, 0}).faces, (Indices{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(polygon({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).faces, (Indices{0, 1, 2, 0, 2, 3}));
}

TEST(Polygons, DegenerateOnesNeverFail) {
    const Values square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    Values around;
    for (int i = 0; i < 200; ++i) around.insert(around.end(), square.begin(), square.end());
    for (const Values& points :
         {Values(18, 0.0), Values{0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0},
          Values{0, 0, 0, NAN, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0, 0},
          Values{0, 0, 0, INFINITY, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0, 0}, Values{0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0},
          Values{0, 0, 0, 2, 2, 0, 2, 0, 0, 0, 2, 0, -1, 1, 0}, around}) {
        const Geometry g = polygon(points);
        EXPECT_EQ(g.face_count(), points.size() / 3 - 2);
        EXPECT_EQ(g.polygon_of, Indices(g.face_count(), 0));
    }
}

TEST(Polygons, MillionCornersTakeNoLongerThanReadingThem) {
    constexpr int n = 300000;
    Values points;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n, r = i % 2 ? 1 : 0.5;
        points.insert(points.end(), {r * std::cos(angle), r * std::sin(angle), 0});
    }
    EXPECT_EQ(polygon(points).face_count(), n - 2u);
}

TEST(Polygons, CornersKnowTheirPolygon) {
    const Geometry g = gaussmap::read_bytes(
        "OFF\n6 3 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n1 1 0\n5 5 5\n3 5 1 0\n5 0 1 2 3 4\n3 1 2 5\n", "p.off", Format::off);
    ASSERT_EQ(g.face_count(), 5u);
    EXPECT_EQ(g.polygon_of, (Indices{0, 1, 1, 1, 2}));
    for (std::size_t i = 0; i < g.faces.size(); ++i) {
        EXPECT_EQ(g.polygons.corners[g.polygons.offsets[g.polygon_of[i / 3]] + g.polygon_corner[i]], g.faces[i]);
    }
}

/// Two quads that meet in an edge of separate vertices, and a sliver between them that welding closes.
Geometry two_quads() {
    Geometry g = gaussmap::read_bytes(
        "OFF\n9 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 -0\n2 0 0\n2 1 0\n1 1 0\n1 0 0\n4 0 1 2 3\n4 4 5 6 7\n4 1 8 7 3\n",
        "q.off", Format::off);
    g.vertex_properties = {gaussmap::make_property("id", {0, 1, 2, 3, 4, 5, 6, 7, 8})};
    Property uv = gaussmap::make_property("texcoord", {});
    Values values;
    for (int i = 0; i < 24; ++i) values.push_back(i);
    uv = gaussmap::make_property("texcoord", values);
    uv.list = true;
    uv.offsets = {0, 8, 16, 24};
    g.face_properties = {gaussmap::make_property("label", {10, 20, 30}), uv};
    return g;
}

TEST(Weld, FirstVertexStandsForTheOthers) {
    Geometry g = two_quads();
    g.elements = {{"edge", 1, {gaussmap::make_property("vertex1", {8}, gaussmap::Type::int32)}},
                  {"material", 1, {gaussmap::make_property("shine", {1})}}};
    const Geometry w = gaussmap::weld(g);
    EXPECT_EQ(w.vertices, (Values{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0}));
    EXPECT_EQ(values_of(w.vertex_properties, "id"), (Values{0, 1, 2, 3, 5, 6}));
    EXPECT_EQ(w.polygons.corners, (Indices{0, 1, 2, 3, 1, 4, 5, 2, 1, 2, 3}));
    EXPECT_EQ(w.polygons.offsets, (std::vector<std::uint64_t>{0, 4, 8, 11}));
    EXPECT_EQ(values_of(w.face_properties, "label"), (Values{10, 20, 30}));
    const Values uv = values_of(w.face_properties, "texcoord");
    EXPECT_EQ(Values(uv.begin() + 16, uv.end()), (Values{16, 17, 20, 21, 22, 23}));  // the second corner is gone
    EXPECT_TRUE(has_note(w, "3 vertices merged into another at the same place"));
    ASSERT_EQ(w.elements.size(), 1u);
    EXPECT_EQ(w.elements[0].name, "material");
    EXPECT_TRUE(has_note(w, "element edge left out: its vertices have new numbers"));
}

TEST(Weld, TrianglesThatLoseACornerGo) {
    Geometry g;
    g.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, -0.0, NAN, 0, 0, NAN, 0, 0};
    g.normals = {0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0, 6};
    g.faces = {0, 2, 3, 0, 1, 3, 0, 4, 5};
    g.face_properties = {gaussmap::make_property("label", {1, 2, 3})};
    const Geometry w = gaussmap::weld(g);
    EXPECT_EQ(w.faces, (Indices{0, 1, 2, 0, 3, 4}));
    EXPECT_EQ(values_of(w.face_properties, "label"), (Values{2, 3}));
    EXPECT_EQ(w.vertex_count(), 5u);  // what is not finite stays
    EXPECT_EQ(w.normals[8], 3);
    EXPECT_TRUE(has_note(w, "1 vertex merged"));
    EXPECT_TRUE(has_note(w, "1 face of fewer than 3 corners left out"));
}

TEST(Weld, AgreesWithComparingAllPairs) {
    support::Random random(11);
    Geometry g;
    for (int i = 0; i < 3000; ++i) g.vertices.push_back(static_cast<double>(random.below(7)) - 3);
    Values expected;
    for (std::size_t i = 0; i < 1000; ++i) {
        bool first = true;
        for (std::size_t j = 0; j < i; ++j)
            first = first && !std::equal(&g.vertices[3 * i], &g.vertices[3 * i] + 3, &g.vertices[3 * j]);
        if (first) expected.insert(expected.end(), &g.vertices[3 * i], &g.vertices[3 * i] + 3);
    }
    EXPECT_EQ(gaussmap::weld(g).vertices, expected);
}

TEST(Triangulate, PropertiesFollowTheTriangles) {
    const Geometry t = gaussmap::triangulate(two_quads());
    EXPECT_TRUE(t.polygons.empty());
    EXPECT_TRUE(t.polygon_of.empty());
    EXPECT_EQ(t.face_count(), 6u);
    EXPECT_EQ(values_of(t.face_properties, "label"), (Values{10, 10, 20, 20, 30, 30}));
    const Geometry q = two_quads();
    const Values uv = values_of(t.face_properties, "texcoord");
    ASSERT_EQ(uv.size(), 36u);
    for (std::size_t i = 0; i < 18; ++i) {
        EXPECT_EQ(uv[2 * i], 8 * q.polygon_of[i / 3] + 2 * q.polygon_corner[i]);
        EXPECT_EQ(uv[2 * i + 1], uv[2 * i] + 1);
    }
    EXPECT_EQ(gaussmap::triangulate(t).faces, t.faces);
}

}  // namespace
