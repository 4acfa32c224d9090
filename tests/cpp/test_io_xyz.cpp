// Rows of numbers: XYZ, PWN, PTS and their kin.
#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using support::has_note;
using support::values_of;

namespace {

using Values = std::vector<double>;
using Names = std::vector<std::string>;

Geometry read_xyz(const std::string& text) {
    return gaussmap::read_bytes(text, "t.xyz", Format::xyz);
}

std::string error_of(const std::string& text) {
    return support::read_error(text, "t.xyz", Format::xyz);
}

Names names_of(const Geometry& geometry) {
    Names names;
    for (const gaussmap::Property& p : geometry.vertex_properties) names.push_back(p.name);
    return names;
}

TEST(Xyz, RowsOfEveryShape) {
    for (const char* text :
         {"0 1 2\n3 4 5\n", "0 1 2\r\n3 4 5", "\t0\t1\t2\t \n\n 3 +4 5.0e0 # c\n", "0,1,2\n3,4,5,\n",
          "0; 1; 2\n3;4;5\n", "# a\n; b\n// c\n0 1 2\n# d\n3 4 5 // e\n", "X,Y,Z\n0,1,2\n3,4,5\n", "2\n0 1 2\n3 4 5\n",
          "\xEF\xBB\xBF"
          "0 1 2\r3 4 5\r",
          "some words\n0 1 2\n3 4 5\n", "1\n0 1 2\n1\n3 4 5\n"}) {
        const Geometry g = read_xyz(text);
        EXPECT_EQ(g.vertices, (Values{0, 1, 2, 3, 4, 5})) << text;
        EXPECT_TRUE(g.normals.empty() && g.vertex_properties.empty() && g.notes.empty()) << text;
    }
    EXPECT_TRUE(std::isnan(read_xyz("nan inf 1\n").vertices[0]));
    EXPECT_EQ(read_xyz("# nothing\n").vertex_count(), 0u);
}

TEST(Xyz, ACountThatLiesIsNoted) {
    EXPECT_TRUE(has_note(read_xyz("7\n0 1 2\n"), "the file claims 7 points but holds 1"));
}

TEST(Xyz, ColumnsWithoutNames) {
    EXPECT_EQ(names_of(read_xyz("0 0 0 -7\n")), (Names{"intensity"}));
    EXPECT_EQ(names_of(read_xyz("0 0 0 1 2\n")), (Names{"scalar_3", "scalar_4"}));

    const Geometry normals = read_xyz("0 0 0 0.6 0.8 0\n1 1 1 0 0 0\n2 2 2 0.6 0.79 0\n");
    EXPECT_EQ(normals.normals, (Values{0.6, 0.8, 0, 0, 0, 0, 0.6, 0.79, 0}));
    EXPECT_TRUE(normals.vertex_properties.empty());

    const Geometry colors = read_xyz("0 0 0 255 0 7\n0 0 0 1 2 3\n");
    EXPECT_EQ(values_of(colors.vertex_properties, "red"), (Values{255, 1}));
    EXPECT_EQ(colors.vertex_properties[0].type, gaussmap::Type::uint8);
    EXPECT_TRUE(colors.normals.empty());

    const Names scalars = {"scalar_3", "scalar_4", "scalar_5"};
    EXPECT_EQ(names_of(read_xyz("0 0 0 256 0 7\n")), scalars);
    EXPECT_EQ(names_of(read_xyz("0 0 0 0.5 0 7\n")), scalars);
    EXPECT_EQ(names_of(read_xyz("0 0 0 0 0 0\n1 1 1 0 0 0\n")), scalars);

    const Geometry pts = read_xyz("0 0 0 9 97 59 38\n1 1 1 8 1 2 3\n");
    EXPECT_EQ(names_of(pts), (Names{"red", "green", "blue", "intensity"}));
    EXPECT_EQ(values_of(pts.vertex_properties, "intensity"), (Values{9, 8}));
    EXPECT_EQ(names_of(read_xyz("0 0 0 117.0 73.0 49.0 255.0\n")), (Names{"red", "green", "blue", "alpha"}));

    const Geometry both = read_xyz("0 0 0 9 8 7 0 0 1 0.25\n");
    EXPECT_EQ(both.normals, (Values{0, 0, 1}));
    EXPECT_EQ(names_of(both), (Names{"red", "green", "blue", "scalar_9"}));
}

TEST(Xyz, ColumnsWithNames) {
    for (const char* heading : {"# x y z nx ny nz quality\n", "//X,Y,Z,Nx,Ny,Nz,quality\n",
                                "\"x\";\"y\";\"z\";\"normal_x\";\"normal_y\";\"normal_z\";\"quality\"\n"}) {
        const Geometry g = read_xyz(std::string(heading) + "1 2 3 4 5 6 7\n");
        EXPECT_EQ(g.vertices, (Values{1, 2, 3}));
        EXPECT_EQ(g.normals, (Values{4, 5, 6})) << heading;
        EXPECT_EQ(names_of(g), (Names{"quality"}));
        EXPECT_EQ(values_of(g.vertex_properties, "quality"), (Values{7}));
    }
    const Geometry moved = read_xyz("id R G B Z Y X\n1 0.2 0 1 3 2 1\n");
    EXPECT_EQ(moved.vertices, (Values{1, 2, 3}));
    EXPECT_EQ(values_of(moved.vertex_properties, "red"), (Values{51}));
    EXPECT_EQ(values_of(moved.vertex_properties, "id"), (Values{1}));
    // Values that are no colours stay as they are; a heading of another number of names is none.
    EXPECT_EQ(values_of(read_xyz("x y z r g b\n0 0 0 1 2 300\n").vertex_properties, "b"), (Values{300}));
    EXPECT_EQ(names_of(read_xyz("# x y z q r\n0 0 0 9\n")), (Names{"intensity"}));
    EXPECT_EQ(names_of(read_xyz("# x y z q q\n0 0 0 9 8\n")), (Names{"scalar_3", "scalar_4"}));
}

TEST(Xyz, Errors) {
    EXPECT_EQ(error_of("0 1 2\n\n3 4\n"), "t.xyz: line 3: 2 numbers where the rows above have 3");
    EXPECT_EQ(error_of("0 1 2\n3 4 5 6\n"), "t.xyz: line 2: 4 numbers where the rows above have 3");
    EXPECT_EQ(error_of("0 1 2\n9\n"), "t.xyz: line 2: 1 number where the rows above have 3");
    EXPECT_EQ(error_of("0 1 2\nend of file\n"), "t.xyz: line 2: \"end\" is no number");
    EXPECT_EQ(error_of("3\nmethane\nC 0 0 0\n"), "t.xyz: line 3: \"C\" is no number");
    const std::string no_point = " is no point x y z; check what kind of file this is";
    EXPECT_EQ(error_of("0.5\n0.25\n"), "t.xyz: line 1: a row of 1 number" + no_point);
    EXPECT_EQ(error_of("5\n7\n"), "t.xyz: line 2: a row of 1 number" + no_point);
    EXPECT_EQ(error_of("5 7\n"), "t.xyz: line 1: a row of 2 numbers" + no_point);
    EXPECT_EQ(error_of("hello\n"), "t.xyz: line 1: no row of numbers; check what kind of file this is");
    EXPECT_EQ(error_of("\xFF\xFE"
                       "0"),
              "t.xyz: the text is UTF-16; save it as UTF-8");
}

TEST(Xyz, RoundTrip) {
    Geometry g;
    g.vertices = {665187.522077, 5648349.895035, 0.1, -1e-300, NAN, 3};
    g.normals = {0, 0, 1, 2, 0, 0};
    g.vertex_properties = {support::bytes_property("red", {0, 1}), support::bytes_property("green", {0, 1}),
                           support::bytes_property("blue", {0, 1}),
                           gaussmap::make_property("my quality", {0.1, -7}, gaussmap::Type::float32)};
    const std::string text = gaussmap::write_bytes(g, {.format = Format::xyz});
    EXPECT_TRUE(
        text.starts_with("# x y z nx ny nz red green blue my_quality\n"
                         "665187.522077 5648349.895035 0.1 0 0 1 0 0 0 0.1\n"))
        << text;
    const Geometry back = read_xyz(text);
    EXPECT_TRUE(std::isnan(back.vertices[4]));
    EXPECT_EQ(Values(back.vertices.begin(), back.vertices.begin() + 4),
              Values(g.vertices.begin(), g.vertices.begin() + 4));
    EXPECT_EQ(back.normals, g.normals);
    EXPECT_EQ(values_of(back.vertex_properties, "blue"), (Values{0, 1}));
    EXPECT_EQ(values_of(back.vertex_properties, "my_quality"), (Values{0.1, -7}));
    EXPECT_EQ(gaussmap::write_bytes(read_xyz("1 2 3\n"), {.format = Format::xyz}), "1 2 3\n");
}

TEST(Xyz, CutAndDamagedFilesAreReadOrRefused) {
    const std::string text = "# x y z nx ny nz quality\n2\n1 2 3 0 0 1 7\n-1,2;3 0 1e0 0 8 // c\n";
    support::check_cuts(text, "t.xyz", Format::xyz);
    support::check_damage(text, "t.xyz", Format::xyz);
}

TEST(Xyz, RealFiles) {
    NEED_DATA();
    for (const char* extension : {".xyz", ".pwn", ".pts"}) support::check_listed(extension);
    const auto cloud = [](const char* name) {
        return gaussmap::read((support::data_folder() / "clouds" / name).string());
    };
    EXPECT_TRUE(has_note(cloud("bunny5000.pts"), "the file claims 1500 points but holds 35947"));
    for (const char* name : {"kitten.xyz", "oni.pwn", "sphere_20k_normal.xyz"}) {
        EXPECT_FALSE(cloud(name).normals.empty()) << name;
    }
    EXPECT_EQ(values_of(cloud("points_agisoft.xyz").vertex_properties, "red")[0], 117);
    EXPECT_EQ(values_of(cloud("points_cloudcompare.xyz").vertex_properties, "alpha")[0], 255);
    EXPECT_EQ(values_of(cloud("test.pts").vertex_properties, "intensity")[0], -1035);
    EXPECT_EQ(cloud("points_agisoft.xyz").vertices[1], 5648349.895035);
    EXPECT_THROW(gaussmap::read((support::data_folder() / "meshes/seed/cow_mesh.txt").string()), gaussmap::FormatError);
}

}  // namespace
