// PCD: text, records and compressed columns.
#include <cstring>

#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using gaussmap::Type;
using support::has_note;
using support::values_of;

namespace {

using Values = std::vector<double>;

Geometry read_pcd(const std::string& bytes) {
    return gaussmap::read_bytes(bytes, "t.pcd", Format::pcd);
}

std::string error_of(const std::string& bytes) {
    return support::read_error(bytes, "t.pcd", Format::pcd);
}

const std::string xyz = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

template <class... T>
std::string packed(T... values) {
    std::string out;
    (out.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
    return out;
}

TEST(Pcd, TextOfOldAndNewVersions) {
    for (const char* header :
         {"# .PCD v.5 - Point Cloud Data file format\nVERSION .5\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
          "COUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n",
          "VERSION .7\r\nCOLUMNS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 2\r\nDATA ASCII\r\n"}) {
        const Geometry g = read_pcd(std::string(header) + "0 1 2\n\n# c\n3 nan 0.1\n");
        EXPECT_EQ(g.vertex_count(), 2u);
        EXPECT_EQ(g.vertices[2], 2);
        EXPECT_TRUE(std::isnan(g.vertices[4]));
        EXPECT_EQ(g.vertices[5], static_cast<double>(0.1f));
        EXPECT_EQ(g.vertex_type, Type::float32);
        EXPECT_EQ(g.width, 0u);
        EXPECT_TRUE(g.notes.empty());
    }
    EXPECT_TRUE(
        has_note(read_pcd(xyz + "WIDTH 1\nDATA ascii\n0 0 0\n1 1 1\n"), "text after the last point ignored (line 9)"));
}

const std::string mixed =
    "FIELDS x y z _ normal_x normal_y normal_z rgba label big h\nSIZE 4 4 4 1 4 4 4 4 2 8 1\n"
    "TYPE F F F U F F F U I U U\nCOUNT 1 1 1 3 1 1 1 1 1 1 2\nWIDTH 1\nHEIGHT 2\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";

void expect_mixed(const Geometry& g) {
    EXPECT_EQ(g.vertices, (Values{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(g.normals, (Values{0, 0, 1, 0, 1, 0}));
    EXPECT_EQ(g.width, 1u);
    ASSERT_EQ(g.vertex_properties.size(), 7u);
    EXPECT_EQ(values_of(g.vertex_properties, "red"), (Values{0x22, 0}));
    EXPECT_EQ(values_of(g.vertex_properties, "green"), (Values{0x33, 0}));
    EXPECT_EQ(values_of(g.vertex_properties, "blue"), (Values{0x44, 255}));
    EXPECT_EQ(values_of(g.vertex_properties, "alpha"), (Values{0x11, 0}));
    EXPECT_EQ(values_of(g.vertex_properties, "label"), (Values{-300, 300}));
    const gaussmap::Property& big = *g.vertex_property("big");
    EXPECT_EQ(big.type, Type::uint64);
    std::uint64_t value = 0;
    std::memcpy(&value, big.bytes.data(), 8);
    EXPECT_EQ(value, 18446744073709551615u);
    const gaussmap::Property& list = *g.vertex_property("h");
    EXPECT_TRUE(list.list);
    EXPECT_EQ(list.offsets, (std::vector<std::uint64_t>{0, 2, 4}));
    EXPECT_EQ(list.as_double(), (Values{7, 8, 9, 255}));
}

TEST(Pcd, FieldsOfEveryType) {
    expect_mixed(read_pcd(mixed + "DATA ascii\n1 2 3 0 0 0 0 0 1 287454020 -300 18446744073709551615 7 8\n"
                                  "4 5 6 0 0 0 0 1 0 255 300 1 9 255\n"));
    const auto pad = packed(std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3});
    const std::string first = packed(1.f, 2.f, 3.f) + pad +
                              packed(0.f, 0.f, 1.f, 0x11223344u, std::int16_t{-300}, ~0ull) +
                              packed(std::uint8_t{7}, std::uint8_t{8});
    const std::string second = packed(4.f, 5.f, 6.f) + pad + packed(0.f, 1.f, 0.f, 255u, std::int16_t{300}, 1ull) +
                               packed(std::uint8_t{9}, std::uint8_t{255});
    const Geometry g = read_pcd(mixed + "DATA binary\n" + first + second);
    expect_mixed(g);
    expect_mixed(read_pcd(gaussmap::write_bytes(g, {.format = Format::pcd})));
    expect_mixed(read_pcd(gaussmap::write_bytes(g, {.format = Format::pcd, .ascii = true})));
}

TEST(Pcd, PackedColoursInAFloat) {
    const std::string header = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 1\nPOINTS 1\nDATA ";
    const Geometry g = read_pcd(header + "ascii\n0 0 0 2.3418053e-38\n");  // 0x00ff0001
    EXPECT_EQ(values_of(g.vertex_properties, "red"), (Values{255}));
    EXPECT_EQ(values_of(g.vertex_properties, "green"), (Values{0}));
    EXPECT_EQ(values_of(g.vertex_properties, "blue"), (Values{1}));
    EXPECT_EQ(g.vertex_property("alpha"), nullptr);
    EXPECT_EQ(values_of(read_pcd(header + "binary\n" + packed(0.f, 0.f, 0.f, 0x00ff0001u)).vertex_properties, "red"),
              (Values{255}));
    // PCL wants rgb as a float in records and as an integer in text.
    EXPECT_NE(gaussmap::write_bytes(g, {.format = Format::pcd}).find("TYPE F F F F\n"), std::string::npos);
    const std::string text = gaussmap::write_bytes(g, {.format = Format::pcd, .ascii = true});
    EXPECT_NE(text.find("FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\n"), std::string::npos);
    EXPECT_TRUE(text.ends_with("DATA ascii\n0 0 0 16711681\n")) << text;
}

TEST(Pcd, WideAndWholeCoordinates) {
    const std::string header = "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 1\nDATA ascii\n";
    const Geometry g = read_pcd(header + "665187.522077 1e-300 3\n");
    EXPECT_EQ(g.vertices, (Values{665187.522077, 1e-300, 3}));
    EXPECT_EQ(g.vertex_type, Type::float64);
    EXPECT_EQ(read_pcd(gaussmap::write_bytes(g, {.format = Format::pcd})).vertices, g.vertices);
    EXPECT_EQ(read_pcd("FIELDS x y z\nSIZE 2 4 1\nTYPE I I U\nWIDTH 1\nDATA ascii\n-5 2147483647 9\n").vertices,
              (Values{-5, 2147483647, 9}));
}

TEST(Pcd, ErrorsOfTheHeader) {
    EXPECT_EQ(error_of("289814.15 1 2\n"),
              "t.pcd: line 1: \"289814.15\" is no word of a PCD header, which ends with DATA; "
              "the header is missing or broken");
    EXPECT_EQ(error_of(xyz), "t.pcd: the PCD header has no DATA line; the file is cut short, or no PCD");
    EXPECT_EQ(error_of("WIDTH 0\nDATA ascii\n"), "t.pcd: header: no FIELDS");
    EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 4\nTYPE F F F\nDATA ascii\n"),
              "t.pcd: header: SIZE has 2 entries for 3 fields");
    EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 4 4\nTYPE F F\nDATA ascii\n"),
              "t.pcd: header: TYPE has 2 entries for 3 fields");
    EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1\nDATA ascii\n"),
              "t.pcd: header: COUNT has 1 entries for 3 fields");
    EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 4 2\nTYPE F F F\nWIDTH 0\nDATA ascii\n"),
              "t.pcd: header: field z has TYPE \"F\" and SIZE \"2\", which PCD does not know");
    EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 2 1\nDATA ascii\n"),
              "t.pcd: header: field y has COUNT 2");
    EXPECT_EQ(error_of("FIELDS x y z q\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 0\nDATA ascii\n"),
              "t.pcd: header: field q has COUNT 0");
    EXPECT_EQ(error_of("FIELDS x y y\nSIZE 4 4 4\nTYPE F F F\nDATA ascii\n"), "t.pcd: header: field y is there twice");
    EXPECT_EQ(error_of("FIELDS x y\nSIZE 4 4\nTYPE F F\nDATA ascii\n"),
              "t.pcd: header: no field z; a cloud needs x, y and z");
    EXPECT_EQ(error_of(xyz + "WIDTH 2\nHEIGHT 3\nPOINTS 5\nDATA ascii\n"),
              "t.pcd: header: WIDTH 2 times HEIGHT 3 is not POINTS 5");
    EXPECT_EQ(error_of(xyz + "WIDTH 2000000000\nHEIGHT 2000000000\nDATA ascii\n"),
              "t.pcd: header: more than 2147483647 points");
    EXPECT_EQ(error_of(xyz + "WIDTH x\nDATA ascii\n"), "t.pcd: line 6: \"x\" is no whole number from 0 to 2147483647");
    EXPECT_EQ(error_of(xyz + "WIDTH 0\nDATA zip\n"),
              "t.pcd: line 7: DATA \"zip\" is not known; it should be ascii, binary or binary_compressed");
}

TEST(Pcd, ErrorsOfTheBody) {
    const std::string two = xyz + "WIDTH 2\nDATA ";
    EXPECT_EQ(error_of(two + "binary\n" + std::string(23, '\0')),
              "t.pcd: the file ends after 1 of 2 points; it is cut short");
    EXPECT_TRUE(has_note(read_pcd(two + "binary\n" + std::string(25, '\0')), "1 byte after the last point ignored"));
    EXPECT_EQ(error_of(two + "ascii\n0.5 0.5 0.5\n"), "t.pcd: the file ends after 1 of 2 points; it is cut short");
    EXPECT_EQ(error_of(xyz + "WIDTH 2000000000\nDATA ascii\n0 0 0\n"),
              "t.pcd: header: 2000000000 points are claimed, but only 6 bytes follow; the file is cut short");
    EXPECT_EQ(error_of(two + "ascii\n0 0\n0 0 0 0\n"), "t.pcd: line 8: fewer than the 3 values of a point");
    EXPECT_EQ(error_of(two + "ascii\n0 0 0 0\n0 0\n"), "t.pcd: line 8: more than the 3 values of a point");
    EXPECT_EQ(error_of(two + "ascii\n0 0 zero\n0 0 0\n"), "t.pcd: line 8: \"zero\" is no value for field z");
    EXPECT_EQ(error_of("FIELDS x y z q\nSIZE 4 4 4 1\nTYPE F F F U\nWIDTH 1\nDATA ascii\n0 0 0 256\n"),
              "t.pcd: line 6: \"256\" is no value for field q");
    // A record whose size times the number of points overflows 64 bits.
    std::string huge = "FIELDS x y z a b c d e\nSIZE 4 4 4 8 8 8 8 8\nTYPE F F F F F F F F\nCOUNT 1 1 1";
    for (int i = 0; i < 5; ++i) huge += " 2147483647";
    for (const char* data : {"ascii", "binary", "binary_compressed"}) {
        EXPECT_NE(error_of(huge + "\nWIDTH 2147483647\nDATA " + data + "\n" + std::string(99, '\1')), "");
    }
}

TEST(Pcd, Compressed) {
    const std::string header = xyz + "WIDTH 2\nDATA binary_compressed\n";
    // One literal run of LZF: its length − 1, then the bytes; columns, not records.
    const std::string body = "\x17" + packed(1.f, 4.f, 2.f, 5.f, 3.f, 6.f);
    const auto file = [&](std::uint32_t compressed, std::uint32_t whole, const std::string& bytes) {
        return header + packed(compressed, whole) + bytes;
    };
    if (error_of(file(25, 24, body)).find("liblzf") != std::string::npos) GTEST_SKIP() << "built without liblzf";
    EXPECT_EQ(read_pcd(file(25, 24, body)).vertices, (Values{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(error_of(file(25, 24, body.substr(1))),
              "t.pcd: the compressed points claim 25 bytes, but only 24 follow; the file is cut short");
    EXPECT_EQ(error_of(file(25, 36, body)),
              "t.pcd: the compressed points claim 36 bytes unpacked, but 2 points of 12 bytes "
              "in 25 are not that; the file is damaged");
    EXPECT_EQ(error_of(file(24, 24, body)), "t.pcd: the compressed points cannot be unpacked; the file is damaged");
    EXPECT_EQ(error_of(header + "abc"), "t.pcd: the file ends after 0 of 2 points; it is cut short");
    // A claim that 25 bytes of LZF can never make is refused before anything is allocated.
    const std::string bomb = xyz + "WIDTH 300000000\nDATA binary_compressed\n" + packed(25u, 3600000000u) + body;
    EXPECT_NE(error_of(bomb).find("the file is damaged"), std::string::npos);
    support::check_damage(file(25, 24, body), "t.pcd", Format::pcd);
}

TEST(Pcd, OrganisedCloudsKeepTheirWidth) {
    Geometry g;
    g.vertices = {0, 0, 0, NAN, NAN, NAN, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0};
    g.width = 3;
    const std::string bytes = gaussmap::write_bytes(g, {.format = Format::pcd});
    EXPECT_NE(bytes.find("WIDTH 3\nHEIGHT 2\n"), std::string::npos);
    const Geometry back = read_pcd(bytes);
    EXPECT_EQ(back.width, 3u);
    EXPECT_EQ(back.vertex_count(), 6u);
    EXPECT_TRUE(std::isnan(back.vertices[3]));
    g.width = 4;  // does not divide the points any more
    EXPECT_NE(gaussmap::write_bytes(g, {.format = Format::pcd}).find("WIDTH 6\nHEIGHT 1\n"), std::string::npos);
    EXPECT_EQ(read_pcd(gaussmap::write_bytes({}, {.format = Format::pcd})).vertex_count(), 0u);
}

TEST(Pcd, WhatItCannotHoldIsLeftOut) {
    Geometry g;
    g.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    g.faces = {0, 1, 2};
    gaussmap::Property ragged = support::bytes_property("ragged", {1, 2, 3});
    ragged.list = true;
    ragged.offsets = {0, 1, 3, 3};
    g.vertex_properties = {ragged, gaussmap::make_property("my quality", {1, 2, 3})};
    const Geometry back = read_pcd(gaussmap::write_bytes(g, {.format = Format::pcd}));
    ASSERT_EQ(back.vertex_properties.size(), 1u);
    EXPECT_EQ(values_of(back.vertex_properties, "my_quality"), (Values{1, 2, 3}));
}

TEST(Pcd, CutAndDamagedFilesAreReadOrRefused) {
    const std::string text =
        mixed + "DATA ascii\n1 2 3 0 0 0 0 0 1 287454020 -300 1 7 8\n4 5 6 0 0 0 0 1 0 255 300 1 9 255\n";
    support::check_cuts(text, "t.pcd", Format::pcd);
    support::check_damage(text, "t.pcd", Format::pcd);
    const std::string binary = gaussmap::write_bytes(read_pcd(text), {.format = Format::pcd});
    support::check_cuts(binary, "t.pcd", Format::pcd);
    support::check_damage(binary, "t.pcd", Format::pcd);
}

TEST(Pcd, RealFiles) {
    NEED_DATA();
    support::check_listed(".pcd");
    const auto cloud = [](const char* name) {
        return gaussmap::read((support::data_folder() / "clouds" / name).string());
    };
    EXPECT_EQ(cloud("bun0.pcd").normals.size(), 3 * 397u);
    EXPECT_EQ(cloud("table_scene_mug_stereo_textured.pcd").width, 640u);
    const Geometry table = cloud("table_scene_mug_stereo_textured.pcd");
    EXPECT_EQ(std::count_if(table.vertices.begin(), table.vertices.end(), [](double v) { return std::isnan(v); }),
              3 * 97920);
    EXPECT_NE(cloud("cturtle.pcd").vertex_property("intensity"), nullptr);
    const Geometry colored = cloud("colored_cloud.pcd");
    EXPECT_EQ(colored.width, 1u);
    for (const bool ascii : {false, true}) {
        const Geometry back = read_pcd(gaussmap::write_bytes(colored, {.format = Format::pcd, .ascii = ascii}));
        EXPECT_EQ(back.vertices, colored.vertices);
        EXPECT_EQ(back.normals, colored.normals);
        EXPECT_EQ(values_of(back.vertex_properties, "green"), values_of(colored.vertex_properties, "green"));
        EXPECT_EQ(values_of(back.vertex_properties, "curvature"), values_of(colored.vertex_properties, "curvature"));
    }
}

}  // namespace
