// OFF and its kin.
#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using support::has_note;
using support::values_of;

namespace {

using Indices = std::vector<std::int32_t>;
using Values = std::vector<double>;

Geometry read_off(const std::string& text) {
    return gaussmap::read_bytes(text, "t.off", Format::off);
}

std::string error_of(const std::string& text) {
    return support::read_error(text, "t.off", Format::off);
}

Geometry again(const Geometry& geometry) {
    return read_off(gaussmap::write_bytes(geometry, {.format = Format::off}));
}

const std::string three = "0 0 0\n1 0 0\n0 1 0\n";

TEST(Off, HeadersOfEveryShape) {
    for (const char* header : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF\n3 1\n", "3 1 0\n",
                               "# c\n\n OFF # c\n# c\n\n3 1 7 # c\n", "OFF\r\n3 1 0\r\n", "\xEF\xBB\xBFOFF\n3 1 0\n"}) {
        const Geometry g = read_off(header + three + "\n# faces\n\n3 0 1 2");
        EXPECT_EQ(g.vertices, (Values{0, 0, 0, 1, 0, 0, 0, 1, 0})) << header;
        EXPECT_EQ(g.faces, (Indices{0, 1, 2})) << header;
        EXPECT_TRUE(g.notes.empty()) << header;
    }
    EXPECT_TRUE(has_note(read_off("OFF\n3 0 0\n" + three + "3 0 1 2\n"), "text after the last face ignored (line 6)"));
    EXPECT_EQ(read_off("OFF\n0 0 0\n").vertex_count(), 0u);
}

TEST(Off, PolygonsAndSmallFaces) {
    const Geometry g = read_off("OFF\n4 3 0\n" + three + "1 1 0\n4 0 1 3 2\n2 0 1\n3 0 1 2\n");
    EXPECT_EQ(g.polygons.corners, (Indices{0, 1, 3, 2, 0, 1, 2}));
    EXPECT_EQ(g.face_count(), 3u);
    EXPECT_TRUE(has_note(g, "1 face of fewer than 3 corners left out"));
}

TEST(Off, NormalsColoursAndTextureCoordinates) {
    const Geometry normals = read_off("NOFF\n1 0 0\n1 2 3 0 0 1\n");
    EXPECT_EQ(normals.normals, (Values{0, 0, 1}));
    EXPECT_TRUE(normals.vertex_properties.empty());
    const Geometry all = read_off("STCNOFF\n2 0 0\n1 2 3 0 0 1 255 0 9 128 0.5 0.25\n1 2 3 0 1 0 1 2 3 4 0 1\n");
    EXPECT_EQ(all.normals, (Values{0, 0, 1, 0, 1, 0}));
    EXPECT_EQ(values_of(all.vertex_properties, "red"), (Values{255, 1}));
    EXPECT_EQ(values_of(all.vertex_properties, "alpha"), (Values{128, 4}));
    EXPECT_EQ(values_of(all.vertex_properties, "s"), (Values{0.5, 0}));
    EXPECT_EQ(values_of(all.vertex_properties, "t"), (Values{0.25, 1}));
    EXPECT_EQ(error_of("STOFF\n1 0 0\n1 2 3 0.5\n"), "t.off: line 3: texture coordinates of the vertex are missing");
}

TEST(Off, ColoursWithoutTheLetter) {
    const Geometry g = read_off("OFF\n2 0 0\n1 2 3 0.2 0 1\n1 2 3 1 0.4 0 # c\n");
    EXPECT_EQ(values_of(g.vertex_properties, "red"), (Values{51, 255}));
    EXPECT_EQ(values_of(g.vertex_properties, "green"), (Values{0, 102}));
    EXPECT_TRUE(values_of(g.vertex_properties, "alpha").empty());
    EXPECT_TRUE(has_note(read_off("OFF\n2 0 0\n1 2 3 1\n1 2 3 1\n"), "numbers after the vertices that are no colour"));
    EXPECT_TRUE(
        has_note(read_off("OFF\n2 0 0\n1 2 3 1 1 1\n1 2 3\n"), "numbers after the vertices that are no colour"));
    EXPECT_TRUE(has_note(read_off("OFF\n1 0 0\n1 2 3 0 -1 0\n"), "colours outside 0 to 255 left out"));
}

TEST(Off, ColoursOfFaces) {
    const Geometry g = read_off("OFF\n3 3 0\n" + three + "3 0 1 2 255 0 0 128\n2 0 1 9 9 9 9\n3 2 1 0 0 7 0 255\n");
    EXPECT_EQ(values_of(g.face_properties, "red"), (Values{255, 0}));
    EXPECT_EQ(values_of(g.face_properties, "green"), (Values{0, 7}));
    EXPECT_EQ(values_of(g.face_properties, "alpha"), (Values{128, 255}));
    const Geometry some = read_off("OFF\n3 2 0\n" + three + "3 0 1 2 255 0 0\n3 2 1 0\n");
    EXPECT_TRUE(some.face_properties.empty());
    EXPECT_TRUE(has_note(some, "numbers after the faces that are no colour"));
}

TEST(Off, Errors) {
    EXPECT_EQ(error_of("# nothing\n"), "t.off: no OFF header; check what kind of file this is");
    EXPECT_EQ(error_of("ply\n"),
              "t.off: line 1: \"ply\" where OFF, COFF, NOFF or the like should be; check what kind of file this is");
    EXPECT_EQ(error_of("4OFF\n1 0 0\n"), "t.off: line 1: \"4OFF\": only points in three dimensions are read");
    EXPECT_EQ(error_of("nOFF\n3\n"), "t.off: line 1: \"nOFF\": only points in three dimensions are read");
    EXPECT_EQ(error_of("OFF BINARY\n"), "t.off: line 1: binary OFF is not read; convert it to text OFF or PLY");
    EXPECT_EQ(error_of("OFF\n"), "t.off: the file ends before its counts");
    EXPECT_EQ(error_of("OFF\n3\n"), "t.off: line 2: \"\" is no count");
    EXPECT_EQ(error_of("OFF\n-3 1 0\n"), "t.off: line 2: \"-3\" is no count");
    EXPECT_EQ(error_of("OFF\n353535235358 6 0\n0 0 0\n"),
              "t.off: line 2: 353535235358 vertices and 6 faces are claimed, but only 6 bytes follow; "
              "the file is cut short or its counts are wrong");
    EXPECT_NE(error_of("OFF\n1 9223372036854775807 0\n0 0 0\n").find("are claimed"), std::string::npos);
    EXPECT_EQ(error_of("OFF\n3 0 0\n0.00000 0 0\n1.00000 0 0\n"),
              "t.off: the file ends after 2 of 3 vertices; it is cut short or its counts are wrong");
    EXPECT_EQ(error_of("OFF\n3 2 0\n" + three + "3 0 1 2\n"),
              "t.off: the file ends after 1 of 2 faces; it is cut short or its counts are wrong");
    EXPECT_EQ(error_of("OFF\n1 0 0\n0 x 0\n"), "t.off: line 3: \"x\" is no number");
    EXPECT_EQ(error_of("OFF\n1 0 0\n0 0 # 0 0\n"), "t.off: line 3: a vertex of too few numbers");
    EXPECT_EQ(error_of("OFF\n3 1 0\n" + three + "3 0 1\n"), "t.off: line 6: a face of 3 corners with only 2 of them");
    EXPECT_EQ(error_of("OFF\n3 1 0\n" + three + "2000000000 0 1\n"),
              "t.off: line 6: a face of 2000000000 corners with only 2 of them");
    EXPECT_EQ(error_of("OFF\n3 1 0\n" + three + "3 0 1 -2\n"),
              "t.off: line 6: \"-2\" is no whole number from 0 to 2147483647");
    EXPECT_NE(error_of("OFF\n3 1 0\n" + three + "3 0 1 3\n").find("face 1, corner 3: vertex index 3"),
              std::string::npos);
    EXPECT_EQ(error_of("\xFF\xFEO"), "t.off: the text is UTF-16; save it as UTF-8");
}

TEST(Off, RoundTrips) {
    Geometry g = read_off("OFF\n4 2 0\n" + three + "1 1 0.1\n4 0 1 3 2 1 2 3 4\n3 0 1 2 255 0 7 9\n");
    EXPECT_EQ(gaussmap::write_bytes(g, {.format = Format::off}),
              "OFF\n4 2 0\n" + three + "1 1 0.1\n4 0 1 3 2 1 2 3 4\n3 0 1 2 255 0 7 9\n");
    for (const char* header : {"OFF", "NOFF", "COFF", "CNOFF"}) {
        const std::string name = header;
        g.normals = name.find('N') == name.npos ? Values() : Values{0, 0, 1, 0, 1, 0, 1, 0, 0, 0.6, 0.8, 0};
        g.vertex_properties.clear();
        for (const char* channel : {"red", "green", "blue"}) {
            if (name[0] == 'C') g.vertex_properties.push_back(support::bytes_property(channel, {0, 2, 128, 255}));
        }
        g.normal_type = gaussmap::Type::float64;
        EXPECT_TRUE(gaussmap::write_bytes(g, {.format = Format::off}).starts_with(name + "\n4 2 0\n"));
        const Geometry back = again(g);
        EXPECT_EQ(back.vertices, g.vertices);
        EXPECT_EQ(back.normals, g.normals);
        EXPECT_EQ(back.polygons.corners, g.polygons.corners);
        EXPECT_EQ(values_of(back.vertex_properties, "blue"), values_of(g.vertex_properties, "blue"));
        EXPECT_EQ(values_of(back.face_properties, "alpha"), (Values{4, 9}));
    }
    EXPECT_TRUE(gaussmap::write_bytes(g, {.format = Format::off, .triangles = true}).starts_with("CNOFF\n4 3 0\n"));
}

TEST(Off, CutAndDamagedFilesAreReadOrRefused) {
    const std::string text =
        "STCNOFF # c\n2 2 0\n1 2 3 0 0 1 255 0 9 128 0.5 0.25\n1 2 3 0 1 0 1 2 3 4 0 1\n4 0 1 1 0 1\n3 0 1 0\n";
    support::check_cuts(text, "t.off", Format::off);
    support::check_damage(text, "t.off", Format::off);
}

TEST(Off, RealFiles) {
    NEED_DATA();
    support::check_listed(".off");
    const auto colored = gaussmap::read((support::data_folder() / "nasty/mesh_with_colors.off").string());
    EXPECT_EQ(values_of(colored.vertex_properties, "red"), (Values{230, 0, 230, 0, 230, 0, 230, 0}));
    EXPECT_EQ(values_of(colored.face_properties, "blue"), (Values{0, 0, 0, 230}));
    EXPECT_EQ(gaussmap::read((support::data_folder() / "nasty/spheres_intersecting.off").string()).normals.size(),
              3 * 324u);
}

}  // namespace
