// STL, binary and text.
#include <cstring>

#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using support::has_note;

namespace {

using Indices = std::vector<std::int32_t>;
using Values = std::vector<double>;

Geometry read_stl(const std::string& bytes) {
    return gaussmap::read_bytes(bytes, "t.stl", Format::stl);
}

std::string error_of(const std::string& bytes) {
    return support::read_error(bytes, "t.stl", Format::stl);
}

/// A binary file of these corners (9 floats a triangle) that claims `claimed` triangles.
std::string binary(const std::vector<float>& corners, std::uint32_t claimed, const std::string& title = "") {
    std::string out = title;
    out.resize(80);
    out.append(reinterpret_cast<const char*>(&claimed), 4);
    for (std::size_t t = 0; t < corners.size(); t += 9) {
        out.append(12, '\x7f');  // a senseless normal
        out.append(reinterpret_cast<const char*>(corners.data() + t), 36);
        out.append("ab");
    }
    return out;
}

const std::vector<float> quad = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, -0.0f, 0, 1, 1, 0, -0.0f, 1, 0};
const std::string facet =
    "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n endloop\nendfacet\n";

TEST(Stl, BinaryCornersAtOnePositionBecomeOneVertex) {
    for (const char* title : {"", "solid cube", "SOLID"}) {
        const Geometry g = read_stl(binary(quad, 2, title));
        EXPECT_EQ(g.vertices, (Values{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
        EXPECT_EQ(g.faces, (Indices{0, 1, 2, 1, 3, 2}));
        EXPECT_EQ(g.vertex_type, gaussmap::Type::float32);
        EXPECT_TRUE(g.normals.empty());
        EXPECT_TRUE(has_note(g, "6 corners joined to 4 vertices"));
    }
}

TEST(Stl, DegenerateTrianglesAndUndefinedCornersAreKept) {
    const float nan = NAN;
    const Geometry g = read_stl(binary({0, 0, 0, 0, 0, 0, 1, 0, 0, nan, 0, 0, 1, 0, 0, nan, 0, 0}, 2));
    EXPECT_EQ(g.faces, (Indices{0, 0, 1, 2, 1, 3}));
    EXPECT_EQ(g.vertex_count(), 4u);
    EXPECT_TRUE(std::isnan(g.vertices[6]) && std::isnan(g.vertices[9]));
}

TEST(Stl, TextOfEveryKind) {
    const Geometry g =
        read_stl("solid a facet name\n" + facet +
                 "endsolid a\n\nsolid\nendsolid\nSOLID b\r\n  FACET NORMAL 0 0 nan "
                 "OUTER LOOP\r\nVertex 1 0 0 vertex 1E0 1.0e+00 0\tvertex -0 1 0\r\nEndLoop EndFacet\r\nENDSOLID b");
    EXPECT_EQ(g.vertices, (Values{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
    EXPECT_EQ(g.faces, (Indices{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(read_stl("solid Empty\nendsolid Empty").vertex_count(), 0u);
}

TEST(Stl, BinaryOfAnotherLength) {
    const std::string whole = binary(quad, 2);
    EXPECT_TRUE(has_note(read_stl(whole + "xyz"), "3 bytes after the last triangle ignored"));
    EXPECT_EQ(error_of(whole.substr(0, 134)),
              "t.stl: the file ends after 1 of 2 triangles; it is cut short, or no STL");
    EXPECT_EQ(error_of(binary(quad, 4294967295u, "solid")),
              "t.stl: the file ends after 2 of 4294967295 triangles; it is cut short, or no STL");
    EXPECT_EQ(error_of("hello"),
              "t.stl: neither a text STL nor long enough (84 bytes) for a binary one; "
              "check what kind of file this is");
}

TEST(Stl, ErrorsOfText) {
    EXPECT_EQ(error_of("solid a\n" + facet), "t.stl: the text ends within a solid, after 1 triangle; it is cut short");
    EXPECT_EQ(error_of("solid a\nfacet normal 0 0 1\nvertex 0 0 0\nendfacet\nendsolid"),
              "t.stl: line 4: a facet of 1 corner; STL holds triangles");
    EXPECT_EQ(error_of("solid a\nendfacet\nendsolid"), "t.stl: line 2: a facet of 0 corners; STL holds triangles");
    EXPECT_EQ(error_of("solid a\nvertex 0 0 0\n"), "t.stl: line 2: \"vertex\" where facet should be");
    EXPECT_EQ(error_of("solid a\nfacet normal 0 0 1\nendsolid\n"),
              "t.stl: line 3: \"endsolid\" where endfacet should be");
    EXPECT_EQ(error_of("solid a\nfacet normal 0 0 1\nfacet\n"), "t.stl: line 3: \"facet\" where endfacet should be");
    EXPECT_EQ(error_of("solid a\nbanana\n"), "t.stl: line 2: \"banana\" where facet or endsolid should be");
    EXPECT_EQ(error_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n"), "t.stl: line 4: \"x\" is no number");
    EXPECT_EQ(error_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"), "t.stl: line 4: \"\" is no number");
}

TEST(Stl, RoundTrips) {
    Geometry g = read_stl(binary(quad, 2));
    g.faces.insert(g.faces.end(), {0, 0, 1});
    for (const bool ascii : {false, true}) {
        const Geometry back = read_stl(gaussmap::write_bytes(g, {.format = Format::stl, .ascii = ascii}));
        EXPECT_EQ(back.vertices, g.vertices);
        EXPECT_EQ(back.faces, g.faces);
    }
    EXPECT_EQ(gaussmap::write_bytes(g, {.format = Format::stl}).size(), 84u + 3 * 50);
    g.vertex_type = gaussmap::Type::float64;
    g.vertices[3] = 0.1;
    EXPECT_EQ(read_stl(gaussmap::write_bytes(g, {.format = Format::stl, .ascii = true})).vertices, g.vertices);
}

TEST(Stl, WritesNormalsOfFacets) {
    Geometry g;
    g.vertices = {0, 0, 0, 2, 0, 0, 0, 0, 3};
    g.faces = {0, 1, 2, 0, 0, 1};
    const std::string bytes = gaussmap::write_bytes(g, {.format = Format::stl});
    float normals[2][3];
    for (int t = 0; t < 2; ++t) std::memcpy(normals[t], bytes.data() + 84 + 50 * t, 12);
    EXPECT_EQ(Values(normals[0], normals[0] + 3), (Values{0, -1, 0}));
    EXPECT_EQ(Values(normals[1], normals[1] + 3), (Values{0, 0, 0}));
    EXPECT_NE(gaussmap::write_bytes(g, {.format = Format::stl, .ascii = true}).find("facet normal 0 -1 0\n"),
              std::string::npos);
}

TEST(Stl, PointsAloneAreRefused) {
    Geometry g;
    EXPECT_EQ(read_stl(gaussmap::write_bytes(g, {.format = Format::stl})).vertex_count(), 0u);
    g.vertices = {0, 0, 0};
    try {
        gaussmap::write_bytes(g, {.format = Format::stl});
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "STL holds triangles alone, and there are none; write points as .ply, .xyz or .pcd");
    }
}

TEST(Stl, CutAndDamagedFilesAreReadOrRefused) {
    const std::string text = "solid a\n" + facet + facet + "endsolid a\nsolid\nendsolid\n";
    support::check_cuts(text, "t.stl", Format::stl);
    support::check_damage(text, "t.stl", Format::stl);
    support::check_cuts(binary(quad, 2), "t.stl", Format::stl);
    support::check_damage(binary(quad, 2, "solid"), "t.stl", Format::stl);
}

TEST(Stl, RealFiles) {
    NEED_DATA();
    support::check_listed(".stl");
}

}  // namespace
