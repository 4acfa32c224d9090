// Properties of any type, names of formats, and which format some bytes are.
#include "io_support.h"

using gaussmap::Format;
using gaussmap::Property;
using gaussmap::Type;

namespace {

using Values = std::vector<double>;

TEST(Property, RoundedAndClampedToItsType) {
    const Values values = {0.4, 0.6, -1.5, 300, -1e30, 1e30, NAN, INFINITY};
    const auto stored = [&](Type type) { return gaussmap::make_property("p", values, type).as_double(); };
    EXPECT_EQ(stored(Type::uint8), (Values{0, 1, 0, 255, 0, 255, 0, 255}));
    EXPECT_EQ(stored(Type::int8), (Values{0, 1, -2, 127, -128, 127, 0, 127}));
    EXPECT_EQ(stored(Type::uint16), (Values{0, 1, 0, 300, 0, 65535, 0, 65535}));
    EXPECT_EQ(stored(Type::int32), (Values{0, 1, -2, 300, -2147483648.0, 2147483647, 0, 2147483647}));
    EXPECT_EQ(stored(Type::int64), (Values{0, 1, -2, 300, -0x1p63, 0x1p63, 0, 0x1p63}));
    EXPECT_EQ(stored(Type::uint64), (Values{0, 1, 0, 300, 0, 0x1p64, 0, 0x1p64}));
    const Property exact = gaussmap::make_property("p", values, Type::float64);
    EXPECT_TRUE(support::same_bits(exact.as_double(), values));
    const Property single = gaussmap::make_property("p", values);
    EXPECT_EQ(single.type, Type::float32);
    EXPECT_EQ(single.values(), 8u);
    EXPECT_EQ(single.at(0), static_cast<double>(0.4f));
    EXPECT_EQ(single.at(5), static_cast<double>(1e30f));
    EXPECT_TRUE(std::isnan(single.at(6)));
}

TEST(Property, FoundByName) {
    gaussmap::Geometry g;
    g.vertex_properties = {gaussmap::make_property("a", {1}), gaussmap::make_property("b", {2})};
    ASSERT_NE(g.vertex_property("b"), nullptr);
    EXPECT_EQ(g.vertex_property("b")->at(0), 2);
    EXPECT_EQ(g.vertex_property("c"), nullptr);
}

TEST(Format, ByExtension) {
    EXPECT_EQ(gaussmap::format_of("a/b.c.PLY"), Format::ply);
    EXPECT_EQ(gaussmap::format_of("b.pwn"), Format::xyz);
    EXPECT_EQ(gaussmap::format_of("b.Pcd"), Format::pcd);
    for (const char* name : {"ply", "", "a.ply.gz", "-", "a.las"})
        EXPECT_EQ(gaussmap::format_of(name), Format::detect) << name;
    EXPECT_TRUE(gaussmap::known_extensions().starts_with(".ply, .obj, "));
}

const std::string vertex_obj = "# a\n\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string vertex_off = "# a\nOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string vertex_stl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid\n";
const std::string vertex_ply =
    "ply\rformat ascii 1.0\relement vertex 1\rproperty float x\rproperty float y\rproperty float z\r"
    "end_header\r1 2 3\r";

TEST(Format, ContentBeforeExtension) {
    EXPECT_EQ(gaussmap::read_bytes(vertex_obj, "a.stl").face_count(), 1u);
    EXPECT_EQ(gaussmap::read_bytes("\xEF\xBB\xBF" + vertex_obj, "a").face_count(), 1u);
    EXPECT_EQ(gaussmap::read_bytes(vertex_off, "a.obj").face_count(), 1u);
    EXPECT_EQ(gaussmap::read_bytes(vertex_stl, "a.obj").face_count(), 1u);
    EXPECT_EQ(gaussmap::read_bytes(vertex_ply, "a.off").vertex_count(), 1u);
    EXPECT_EQ(gaussmap::read_bytes("1 2 3\n4 5 6\n", "a").vertex_count(), 2u);
    EXPECT_EQ(gaussmap::read_bytes("# x y z\n1,2,3\n", "a").vertices, (Values{1, 2, 3}));
    const std::string pcd =
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n"
        "DATA ascii\n1 2 3\n";
    EXPECT_EQ(gaussmap::read_bytes(pcd, "a").vertices, (Values{1, 2, 3}));
    EXPECT_EQ(gaussmap::read_bytes("# .PCD v.7\n" + pcd, "a.xyz").vertices, (Values{1, 2, 3}));
    // Rows of numbers alone go by the extension: an OFF without its first word, say.
    EXPECT_NE(support::read_error("1 2 3\n", "a.ply", Format::detect), "");
}

TEST(Format, BinaryStlThatBeginsWithSolid) {
    std::string bytes = "solid facet" + std::string(69, ' ') + std::string("\1\0\0\0", 4) + std::string(50, '\0');
    EXPECT_EQ(gaussmap::read_bytes(bytes, "a").face_count(), 1u);
}

TEST(Format, OtherFilesAreNamed) {
    const auto error_of = [](const std::string& bytes, const std::string& name) {
        return support::read_error(bytes, name, Format::detect);
    };
    const std::string list = gaussmap::known_extensions();
    EXPECT_EQ(error_of("LASF\1\2", "a.laz"),
              "a.laz: a LAS or LAZ file, which is not read; convert it to one of " + list);
    EXPECT_EQ(error_of("ASTM-E57", "a.e57"), "a.e57: an E57 file, which is not read; convert it to one of " + list);
    EXPECT_EQ(error_of("\x1F\x8B zip", "a.ply"),
              "a.ply: a file compressed by gzip, which is not read; unpack it, or convert it to one of " + list);
    EXPECT_EQ(error_of("hello\n", "a.doc"), "a.doc: the format is not known; convert it to one of " + list);
    EXPECT_EQ(error_of("", "a.ply"), "a.ply: the file is empty (0 bytes); write it anew");
    EXPECT_EQ(error_of("\xFE\xFF\0v", "a.obj"), "a.obj: the text is UTF-16; save it as UTF-8");
    EXPECT_EQ(error_of(std::string("1 2\0 3", 6), "a.xyz"),
              "a.xyz: byte 4: a zero byte, so this is no text; give a text file in UTF-8, or the format that it is of");
}

TEST(Format, FilesOfTheFolderThatAreNotRead) {
    NEED_DATA();
    for (const char* name :
         {"clouds/redrocks.drc", "clouds/urban.las", "clouds/indoor.laz", "clouds/A4.e57", "large/S33W071.tif",
          "nasty/broken_size.laz", "nasty/empty.off", "nasty/box_UTF16BE.obj"}) {
        const std::string path = (support::data_folder() / name).string();
        try {
            gaussmap::read(path);
            ADD_FAILURE() << name;
        } catch (const gaussmap::FormatError& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(path + ": ")) << error.what();
        }
    }
}

}  // namespace
