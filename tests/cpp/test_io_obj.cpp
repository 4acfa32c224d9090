// OBJ: what is read, what is left out with a note, what is refused, and the way back.
#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using support::has_note;
using support::values_of;

namespace {

using Indices = std::vector<std::int32_t>;
using Values = std::vector<double>;

Geometry read_obj(const std::string& text) {
    return gaussmap::read_bytes(text, "t.obj", Format::obj);
}

std::string error_of(const std::string& text) {
    return support::read_error(text, "t.obj", Format::obj);
}

Geometry again(const Geometry& geometry) {
    return read_obj(gaussmap::write_bytes(geometry, {.format = Format::obj}));
}

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(Obj, ReadsEveryFormOfCorner) {
    const std::string attributes = three + "vt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n";
    for (const char* face : {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/2/1 3/3/1", "f -3 -2 -1",
                             "f 1// 2// 3//", "f 1/ 2/ 3/", "  f\t1  2 3  # a face", "f -3/-3/-1 2/2/-1 3/3/-1"}) {
        const Geometry g = read_obj(attributes + face);
        EXPECT_EQ(g.faces, (Indices{0, 1, 2})) << face;
        EXPECT_EQ(g.vertices, (Values{0, 0, 0, 1, 0, 0, 0, 1, 0})) << face;
        EXPECT_TRUE(g.polygons.empty());
    }
}

TEST(Obj, LineEndsContinuationsAndOtherKeywords) {
    const Geometry g = read_obj(
        "\xEF\xBB\xBF# one\r\nmtllib C:\\x\\\r\no a\r\nv 0 0 \\\r\n0\r\nv +1 0 0 # x\r\nv 0 1e0 0\r\n"
        "\r\ng b\r\ns off\r\nusemtl m\r\np 1\r\nl 1 2\r\nf 1 \\\r\n 2 \\\r\n 3");
    EXPECT_EQ(g.vertices, (Values{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(g.faces, (Indices{0, 1, 2}));
    EXPECT_TRUE(g.notes.empty());
    EXPECT_EQ(read_obj("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").faces, (Indices{0, 1, 2}));
    EXPECT_TRUE(has_note(read_obj(three + "curv 1\nweird\n"), "2 lines of unknown kind ignored"));
}

TEST(Obj, VerticesMayFollowTheFacesAndHoldAWeight) {
    const Geometry g = read_obj("f 1 2 3\nv 0 0 0 1\nv 1 0 0 0.5\nv 0 1 nan 1\n");
    EXPECT_EQ(g.faces, (Indices{0, 1, 2}));
    EXPECT_EQ(g.vertex_count(), 3u);
    EXPECT_TRUE(std::isnan(g.vertices[8]));
    EXPECT_TRUE(g.vertex_properties.empty());
}

TEST(Obj, PolygonsAreKeptAndCut) {
    const Geometry g = read_obj(three + "v 1 1 0\nf 1 2 3\nf 1 2 4 3\nf 1 2\nf 4\n");
    EXPECT_EQ(g.polygons.offsets, (std::vector<std::uint64_t>{0, 3, 7}));
    EXPECT_EQ(g.polygons.corners, (Indices{0, 1, 2, 0, 1, 3, 2}));
    EXPECT_EQ(g.face_count(), 3u);
    EXPECT_TRUE(has_note(g, "2 faces of fewer than 3 corners left out"));
}

TEST(Obj, Colours) {
    const Geometry fractions = read_obj("v 0 0 0 1 0 0.5\nv 0 0 0 0 1 0.2\n");
    EXPECT_EQ(values_of(fractions.vertex_properties, "red"), (Values{255, 0}));
    EXPECT_EQ(values_of(fractions.vertex_properties, "green"), (Values{0, 255}));
    EXPECT_EQ(values_of(fractions.vertex_properties, "blue"), (Values{128, 51}));
    const Geometry bytes = read_obj("v 0 0 0 255 0 1\nv 0 0 0 7 8 nan\n");
    EXPECT_EQ(values_of(bytes.vertex_properties, "red"), (Values{255, 7}));
    EXPECT_EQ(values_of(bytes.vertex_properties, "blue"), (Values{1, 0}));
    EXPECT_TRUE(has_note(bytes, "1 colour value not a number: set to 0"));
    EXPECT_TRUE(has_note(read_obj("v 0 0 0 1 1 -1\n"), "colours outside 0 to 255 left out"));
    const Geometry some = read_obj("v 0 0 0 1 0 0\nv 0 0 0\n");
    EXPECT_TRUE(has_note(some, "only 1 of 2 vertices have a colour"));
    EXPECT_TRUE(some.vertex_properties.empty());
}

TEST(Obj, NormalsWhereTheCornersOfAVertexAgree) {
    // Two lines of the same normal agree; the unused fourth vertex has none.
    const Geometry g = read_obj(three + "v 9 9 9\nvn 0 0 1\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//3 3//1\nf 1//2 2//3 3//2\n");
    ASSERT_EQ(g.normals.size(), 12u);
    EXPECT_EQ(Values(g.normals.begin(), g.normals.begin() + 9), (Values{0, 0, 1, 1, 0, 0, 0, 0, 1}));
    EXPECT_TRUE(std::isnan(g.normals[9]) && std::isnan(g.normals[11]));
    EXPECT_TRUE(g.notes.empty());

    const Geometry crease = read_obj(three + "vn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1//2 2//1 3//1\n");
    EXPECT_TRUE(crease.normals.empty());
    EXPECT_TRUE(has_note(crease, "corner normals differ at 1 vertex (creases): normals left out"));

    EXPECT_TRUE(has_note(read_obj(three + "vn 0 0 1\nf 1//1 2//1 3\n"), "1 of 3 corners have no normal"));
    EXPECT_TRUE(has_note(read_obj(three + "vn 0 0 1\nf 1//1 2//1 3//7\n"), "1 of 3 corners have no normal"));
    EXPECT_TRUE(has_note(read_obj(three + "vn 0 0 1\nf 1 2 3\n"), "3 of 3 corners have no normal"));
}

TEST(Obj, NormalsOfPoints) {
    EXPECT_EQ(read_obj("v 0 0 0\nvn 0 0 1\nv 1 0 0\nvn 0 1 0\n").normals, (Values{0, 0, 1, 0, 1, 0}));
    const Geometry g = read_obj("v 0 0 0\nvn 0 0 1\nv 1 0 0\n");
    EXPECT_TRUE(g.normals.empty());
}

TEST(Obj, TextureCoordinatesOfCorners) {
    const Geometry g =
        read_obj(three + "v 1 1 0\nvt 0 0.5\nvt 1 0 9\nvt 0.25\nf 1/1 2/2 3/3\nf 1/1\nf 1/3 2/2 4/1 3/1\n");
    ASSERT_EQ(g.face_properties.size(), 1u);
    const gaussmap::Property& p = g.face_properties[0];
    EXPECT_EQ(p.name, "texcoord");
    EXPECT_TRUE(p.list);
    EXPECT_EQ(p.offsets, (std::vector<std::uint64_t>{0, 6, 14}));
    EXPECT_EQ(p.as_double(), (Values{0, 0.5, 1, 0, 0.25, 0, 0.25, 0, 1, 0, 0, 0.5, 0, 0.5}));
    const Geometry some = read_obj(three + "vt 0 0\nf 1 2 3\nf 1/1 2/1 3/1\n");
    EXPECT_TRUE(some.face_properties.empty());
    EXPECT_TRUE(has_note(some, "3 of 6 corners have no texture coordinates"));
    EXPECT_TRUE(has_note(read_obj(three + "f 1/1 2/2 3/3\n"), "3 of 3 corners have no texture coordinates"));
}

TEST(Obj, ErrorsNameTheLine) {
    EXPECT_EQ(error_of(three + "f 1 2 0\n"), "t.obj: line 4: a face refers to vertex 0, but OBJ counts from 1");
    EXPECT_EQ(error_of(three + "\nf 1 2 5\nf 1 2 4\n"),
              "t.obj: line 5: a face refers to vertex 5, but there are 3; mend the file or write it anew");
    EXPECT_EQ(error_of(three + "f 1 2 -4\n"),
              "t.obj: line 4: a face refers to vertex -4, but there are 3 so far; mend the file or write it anew");
    EXPECT_NE(error_of(three + "f 1 2 99999999999\n").find("line 4: a face refers to vertex 99999999999"),
              std::string::npos);
    for (const char* corner : {"x", "3x", "3/x", "3/1/1/1", "/3", "3.5", "99999999999999999999"}) {
        EXPECT_EQ(error_of(three + "f 1 2 " + corner),
                  "t.obj: line 4: \"" + std::string(corner) + "\" is no corner of a face (v, v/vt, v//vn or v/vt/vn)");
    }
    EXPECT_EQ(error_of("v 1 2\n"), "t.obj: line 1: 2 numbers where 3 are needed");
    EXPECT_EQ(error_of("v 1 2 # 3\n"), "t.obj: line 1: 2 numbers where 3 are needed");
    EXPECT_EQ(error_of("vt\n"), "t.obj: line 1: 0 numbers where 1 are needed");
    EXPECT_EQ(error_of("v 1 2 x\x01\n"), "t.obj: line 1: \"x?\" is no number");
    EXPECT_EQ(error_of("lorem ipsum\ndolor\n"),
              "t.obj: no line of it is OBJ (v, vt, vn, f, …); check what kind of file this is");
    EXPECT_EQ(error_of(std::string("\xFE\xFF\0v", 4)), "t.obj: the text is UTF-16; save it as UTF-8");
}

TEST(Obj, RoundTrip) {
    Geometry g;
    g.vertices = {0, 0, 0, 1, 0, 0.1, 0, 1, 1e-300, 1, 1, 0, 5, 5, 5};
    g.normals = {0, 0, 1, 0, 1, 0, 1, 0, 0, 0.6, 0.8, 0, 0, 0, -1};
    g.normal_type = gaussmap::Type::float64;
    for (const char* name : {"red", "green", "blue"}) {
        g.vertex_properties.push_back(support::bytes_property(name, {0, 1, 128, 254, 255}));
    }
    g.faces = {0, 1, 2, 1, 3, 2};
    const Geometry back = again(g);
    EXPECT_EQ(back.vertices, g.vertices);
    EXPECT_EQ(back.normals, g.normals);
    EXPECT_EQ(back.faces, g.faces);
    ASSERT_EQ(back.vertex_properties.size(), 3u);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(back.vertex_properties[c].bytes, g.vertex_properties[c].bytes);
}

TEST(Obj, RoundTripOfPolygonsAndTextureCoordinates) {
    const Geometry g = read_obj(three + "v 1 1 0\nvt 0 0.5\nvt 1 0\nf 1/1 2/2 3/1\nf 1/2 2/2 4/1 3/1\n");
    const Geometry back = again(g);
    EXPECT_EQ(back.polygons.corners, g.polygons.corners);
    EXPECT_EQ(back.polygons.offsets, g.polygons.offsets);
    EXPECT_EQ(values_of(back.face_properties, "texcoord"), values_of(g.face_properties, "texcoord"));
    const Geometry cut = read_obj(gaussmap::write_bytes(g, {.format = Format::obj, .triangles = true}));
    EXPECT_TRUE(cut.polygons.empty());
    EXPECT_EQ(cut.faces, g.faces);
    EXPECT_EQ(values_of(cut.face_properties, "texcoord").size(), 18u);
}

TEST(Obj, WritesTheShortestNumbersOfTheType) {
    Geometry g;
    g.vertices = {static_cast<double>(0.1f), 1, 2};
    g.vertex_type = gaussmap::Type::float32;
    EXPECT_EQ(gaussmap::write_bytes(g, {.format = Format::obj}), "v 0.1 1 2\n");
}

TEST(Obj, CutAndDamagedFilesAreReadOrRefused) {
    const std::string text =
        three + "v 1 1 0 \\\n 1\nvt 0 0.5\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf -4/1/-1 2/1/1 4/1/1 3/1/1\n";
    support::check_cuts(text, "t.obj", Format::obj);
    support::check_damage(text, "t.obj", Format::obj);
}

TEST(Obj, TellsHowFarItIsAndCanBeCancelled) {
    std::string text;
    for (int i = 0; i < 200000; ++i) text += "v 0 0 0\n";
    std::vector<double> seen;
    gaussmap::read_bytes(text, "t.obj", Format::obj, {1, [&](double fraction) {
                                                          seen.push_back(fraction);
                                                          return true;
                                                      }});
    ASSERT_EQ(seen.size(), 3u);
    EXPECT_NEAR(seen[0], 65536.0 / 200000, 1e-12);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_THROW(gaussmap::read_bytes(text, "t.obj", Format::obj, {1, [](double) { return false; }}),
                 gaussmap::Cancelled);
}

TEST(Obj, RealFiles) {
    NEED_DATA();
    support::check_listed(".obj", {"malformed.obj", "issue-140-zero-face-idx.obj"}, {{"notenoughindices.obj", 1}});
    const auto folder = support::data_folder();
    EXPECT_EQ(gaussmap::read((folder / "meshes/classic/suzanne.obj").string()).normals.size(), 3 * 507u);
    EXPECT_EQ(gaussmap::read((folder / "meshes/classic/spot.obj").string()).face_properties.size(), 1u);
    EXPECT_TRUE(has_note(gaussmap::read((folder / "nasty/nancolor.obj").string()), "3 colour values"));
    EXPECT_TRUE(has_note(gaussmap::read((folder / "nasty/negative_indices.obj").string()), "at 8 vertices (creases)"));
}

}  // namespace
