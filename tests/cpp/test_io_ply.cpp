// PLY in: every type and byte order, what makes faces, and what each malformed file is told.
#include <bit>
#include <cstring>

#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using gaussmap::Type;
using support::has_note;
using support::values_of;

namespace {

using Indices = std::vector<std::int32_t>;
using Values = std::vector<double>;

Geometry read_ply(const std::string& bytes) {
    return gaussmap::read_bytes(bytes, "t.ply", Format::ply);
}

std::string error_of(const std::string& bytes) {
    return support::read_error(bytes, "t.ply", Format::ply);
}

/// The bytes of a value, the most significant one first where `big`.
template <class T>
std::string raw(T value, bool big = false) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big == (std::endian::native == std::endian::little)) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string header(const std::string& format, const std::string& lines, const std::string& end = "\n") {
    std::string text = "ply\nformat " + format + " 1.0\n" + lines + "end_header\n", out;
    for (const char c : text) out += c == '\n' ? end : std::string(1, c);
    return out;
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string three = "element vertex 3\n" + xyz;
const std::string one_face = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string three_rows = "0 0 0\n1 0 0\n0 1 0\n";
const std::string binary = "binary_little_endian";

std::string three_points(bool big = false) {
    std::string body;
    for (const float v : {0, 0, 0, 1, 0, 0, 0, 1, 0}) body += raw<float>(v, big);
    return body;
}

template <class T>
void check_type(const std::string& name, Type type) {
    const Values expected = {1, 0, static_cast<double>(std::numeric_limits<T>::max())};
    for (const bool big : {false, true}) {
        std::string bytes = header(big ? "binary_big_endian" : binary,
                                   "element vertex 1\nproperty " + name + " x\nproperty " + name + " y\nproperty " +
                                       name + " z\nproperty " + name + " q\nproperty list uchar " + name + " l\n");
        for (const double v : expected) bytes += raw<T>(v == expected[2] ? std::numeric_limits<T>::max() : T(v), big);
        bytes += raw<T>(7, big) + "\2" + raw<T>(8, big) + raw<T>(9, big);
        const Geometry g = read_ply(bytes);
        EXPECT_EQ(g.vertices, expected) << name;
        EXPECT_EQ(g.vertex_type, type == Type::float32 ? type : Type::float64) << name;
        ASSERT_EQ(g.vertex_properties.size(), 2u);
        EXPECT_EQ(g.vertex_properties[0].type, type) << name;
        EXPECT_EQ(values_of(g.vertex_properties, "q"), Values{7}) << name;
        EXPECT_EQ(values_of(g.vertex_properties, "l"), (Values{8, 9})) << name;
        EXPECT_TRUE(g.vertex_properties[1].list);
    }
}

TEST(PlyRead, EveryTypeInBothByteOrders) {
    for (const char* name : {"char", "int8"}) check_type<std::int8_t>(name, Type::int8);
    for (const char* name : {"uchar", "uint8"}) check_type<std::uint8_t>(name, Type::uint8);
    for (const char* name : {"short", "int16"}) check_type<std::int16_t>(name, Type::int16);
    for (const char* name : {"ushort", "uint16"}) check_type<std::uint16_t>(name, Type::uint16);
    for (const char* name : {"int", "int32"}) check_type<std::int32_t>(name, Type::int32);
    for (const char* name : {"uint", "uint32"}) check_type<std::uint32_t>(name, Type::uint32);
    for (const char* name : {"float", "float32"}) check_type<float>(name, Type::float32);
    for (const char* name : {"double", "float64"}) check_type<double>(name, Type::float64);
    check_type<std::int64_t>("int64", Type::int64);
    check_type<std::uint64_t>("uint64", Type::uint64);
}

TEST(PlyRead, EveryLineEnd) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const Geometry text = read_ply(header("ascii", three + one_face, end) + "0 0 0" + end + "1 0 0" + end +
                                       "0 1 0" + end + "3 0 1 2" + end);
        EXPECT_EQ(text.vertices, (Values{0, 0, 0, 1, 0, 0, 0, 1, 0}));
        EXPECT_EQ(text.faces, (Indices{0, 1, 2}));
        // A body whose first byte is that of a line end.
        for (const char first : {'\n', '\r', ' '}) {
            std::string body = three_points();
            body[0] = first;
            const Geometry g = read_ply(header(binary, three, end) + body);
            EXPECT_EQ(g.vertex_count(), 3u);
            EXPECT_TRUE(g.notes.empty()) << g.notes[0];
            float x = 0;
            std::memcpy(&x, body.data(), 4);
            EXPECT_EQ(g.vertices[0], std::endian::native == std::endian::little ? x : g.vertices[0]);
        }
    }
}

TEST(PlyRead, AsciiNumbersAndBlanks) {
    const Geometry g = read_ply(header("ascii", " element   vertex\t3\n\n" + xyz + "property uchar q \n") +
                                "\n  +1e0\t-0.5   .25 3.0\n\nnan inf -INF 255\n 1e999 -1e999 1e-999 0");
    EXPECT_EQ(g.vertices[0], 1);
    EXPECT_EQ(g.vertices[1], -0.5);
    EXPECT_EQ(g.vertices[2], 0.25);
    EXPECT_TRUE(std::isnan(g.vertices[3]));
    EXPECT_EQ(g.vertices[4], INFINITY);
    EXPECT_EQ(g.vertices[5], -INFINITY);
    EXPECT_EQ(g.vertices[6], INFINITY);
    EXPECT_EQ(g.vertices[7], -INFINITY);
    EXPECT_EQ(g.vertices[8], 0);
    EXPECT_EQ(values_of(g.vertex_properties, "q"), (Values{3, 255, 0}));
}

TEST(PlyRead, NormalsNeedAllThree) {
    const std::string n = "property double nx\nproperty double ny\n";
    const Geometry g =
        read_ply(header("ascii", "element vertex 1\n" + n + xyz + "property double nz\n") + "1 2 3 4 5 6");
    EXPECT_EQ(g.vertices, (Values{3, 4, 5}));
    EXPECT_EQ(g.normals, (Values{1, 2, 6}));
    EXPECT_EQ(g.normal_type, Type::float64);
    EXPECT_TRUE(g.vertex_properties.empty());
    const Geometry h = read_ply(header("ascii", "element vertex 1\n" + n + xyz) + "1 2 3 4 5");
    EXPECT_TRUE(h.normals.empty());
    EXPECT_EQ(values_of(h.vertex_properties, "ny"), Values{2});
}

TEST(PlyRead, ElementsInAnyOrderAndUnknownOnesKept) {
    const Geometry g =
        read_ply(header("ascii", "comment  two words \nobj_info made by hand\n" + one_face +
                                     "element edge 2\nproperty int vertex1\nproperty list int float w\n" + three +
                                     "element nothing 1000000000000\n") +
                 "3 2 1 0\n5 2 0.5 0.25\n6 0\n" + three_rows);
    EXPECT_EQ(g.faces, (Indices{2, 1, 0}));
    EXPECT_EQ(g.comments, (std::vector<std::string>{"two words ", "obj_info made by hand"}));
    ASSERT_EQ(g.elements.size(), 2u);
    EXPECT_EQ(g.elements[0].name, "edge");
    EXPECT_EQ(values_of(g.elements[0].properties, "vertex1"), (Values{5, 6}));
    EXPECT_EQ(g.elements[0].properties[1].offsets, (std::vector<std::uint64_t>{0, 2, 2}));
    EXPECT_EQ(values_of(g.elements[0].properties, "w"), (Values{0.5, 0.25}));
    EXPECT_EQ(g.elements[1].count, 1000000000000u);
}

TEST(PlyRead, FacesOfEveryIndexTypeAndName) {
    for (const char* name : {"vertex_indices", "vertex_index"}) {
        for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint", "int64", "uint64"}) {
            const std::string face =
                "element face 1\nproperty list " + std::string(type) + " " + type + " " + name + "\n";
            EXPECT_EQ(read_ply(header("ascii", three + face) + three_rows + "3 0 1 2").faces, (Indices{0, 1, 2}))
                << type;
        }
    }
}

TEST(PlyRead, SmallFacesGoWithTheirProperties) {
    const std::string face =
        "element face 5\nproperty list uchar int vertex_indices\nproperty int label\n"
        "property list uchar float texcoord\n";
    const std::string rows = "2 0 1 10 0\n3 0 1 2 11 1 0.5\n0 12 0\n1 1 13 0\n3 2 1 0 14 2 0.25 0.75\n";
    const Geometry g = read_ply(header("ascii", three + face) + three_rows + rows);
    EXPECT_EQ(g.faces, (Indices{0, 1, 2, 2, 1, 0}));
    EXPECT_EQ(values_of(g.face_properties, "label"), (Values{11, 14}));
    EXPECT_EQ(values_of(g.face_properties, "texcoord"), (Values{0.5, 0.25, 0.75}));
    EXPECT_EQ(g.face_properties[1].offsets, (std::vector<std::uint64_t>{0, 1, 3}));
    EXPECT_TRUE(has_note(g, "3 faces of fewer than 3 corners left out"));
}

TEST(PlyRead, PolygonsOfMixedSizeInBinary) {
    for (const bool big : {false, true}) {
        std::string bytes = header(big ? "binary_big_endian" : binary,
                                   "element vertex 4\n" + xyz +
                                       "element face 3\nproperty uchar a\n"
                                       "property list uchar uint vertex_indices\nproperty short b\n");
        for (const float v : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) bytes += raw<float>(v, big);
        const auto add = [&](char a, const std::vector<std::uint32_t>& corners, std::int16_t b) {
            bytes += a;
            bytes += static_cast<char>(corners.size());
            for (const std::uint32_t c : corners) bytes += raw(c, big);
            bytes += raw(b, big);
        };
        add(1, {0, 1, 2}, -1);
        add(2, {0, 1, 2, 3}, -2);
        add(3, {0, 2, 3}, -3);
        const Geometry g = read_ply(bytes);
        EXPECT_EQ(g.polygons.offsets, (std::vector<std::uint64_t>{0, 3, 7, 10}));
        EXPECT_EQ(g.polygons.corners, (Indices{0, 1, 2, 0, 1, 2, 3, 0, 2, 3}));
        EXPECT_EQ(g.polygon_of, (Indices{0, 1, 1, 2}));
        EXPECT_EQ(values_of(g.face_properties, "a"), (Values{1, 2, 3}));
        EXPECT_EQ(values_of(g.face_properties, "b"), (Values{-1, -2, -3}));
    }
}

TEST(PlyRead, StripsTurnEverySecondTriangle) {
    const std::string points = "element vertex 5\n" + xyz, rows = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n";
    const std::string strips = "element tristrips 2\nproperty list int int vertex_indices\n";
    const Geometry g = read_ply(header("ascii", points + strips) + rows + "9 0 1 2 3 -1 1 2 3 4\n5 0 1 1 2 3\n");
    EXPECT_EQ(g.faces, (Indices{0, 1, 2, 2, 1, 3, 1, 2, 3, 3, 2, 4, 1, 2, 3}));
    EXPECT_TRUE(g.elements.empty());
    // Faces that are there already are the surface; the strips are carried along.
    const Geometry h = read_ply(header("ascii", points + one_face + strips) + rows + "3 0 1 2\n3 0 1 2\n3 1 2 3\n");
    EXPECT_EQ(h.faces, (Indices{0, 1, 2}));
    EXPECT_EQ(h.elements.size(), 1u);
}

TEST(PlyRead, BytesBehindTheEndAreTold) {
    EXPECT_TRUE(
        has_note(read_ply(header(binary, three) + three_points() + "abc"), "3 bytes after the last element left out"));
    EXPECT_TRUE(
        has_note(read_ply(header("ascii", three) + three_rows + "\n x"), "1 byte after the last element left out"));
    EXPECT_TRUE(read_ply(header("ascii", three) + three_rows + " \n\n").notes.empty());
}

TEST(PlyRead, MalformedHeaders) {
    const std::string mend = "; mend the file or write it anew";
    EXPECT_EQ(error_of("plx\n"), "t.ply: line 1: a PLY file begins with the word ply" + mend);
    EXPECT_EQ(error_of("ply\nformat foo 1.0\n"),
              "t.ply: line 2: format \"foo\" is not ascii, binary_little_endian or binary_big_endian" + mend);
    EXPECT_EQ(error_of("ply\nelement vertex 0\nend_header\n"), "t.ply: line 3: the header has no format line" + mend);
    EXPECT_EQ(error_of("ply\nformat ascii 1.0\n"), "t.ply: line 2: the header has no end_header" + mend);
    EXPECT_EQ(error_of(header("ascii", "elemental\n")),
              "t.ply: line 3: \"elemental\" is no keyword of a PLY header" + mend);
    EXPECT_EQ(error_of(header("ascii", "element vertex -1\n")),
              "t.ply: line 3: element \"vertex\" with the count \"-1\"" + mend);
    EXPECT_EQ(error_of(header("ascii", "element a 1\nelement a 1\n")), "t.ply: line 4: a second element \"a\"" + mend);
    EXPECT_EQ(error_of(header("ascii", xyz)), "t.ply: line 3: a property before any element" + mend);
    EXPECT_EQ(error_of(header("ascii", "element a 1\nproperty real x\n")), "t.ply: line 4: \"real\" is no type" + mend);
    EXPECT_EQ(error_of(header("ascii", "element a 1\nproperty int\n")),
              "t.ply: line 4: a property without a name" + mend);
    EXPECT_EQ(error_of(header("ascii", "element a 1\nproperty list float int x\n")),
              "t.ply: line 4: \"float\" is no type for the length of a list" + mend);
    EXPECT_EQ(error_of(header("ascii", "element face 0\n")),
              "t.ply: header: no element vertex; give a file of points or of a surface");
    EXPECT_EQ(error_of(header("ascii", "element vertex 0\nproperty float y\n")),
              "t.ply: header: element vertex has no property x, z" + mend);
    EXPECT_EQ(error_of(header("ascii", three + "element face 1\nproperty int a\n") + three_rows + "1"),
              "t.ply: header: element face has no list vertex_indices" + mend);
    EXPECT_EQ(error_of(header("ascii", three + "element face 1\nproperty list uchar float vertex_indices\n") +
                       three_rows + "3 0 1 2"),
              "t.ply: header: the list vertex_indices is not of whole numbers" + mend);
}

TEST(PlyRead, MalformedBodies) {
    const std::string mend = "; mend the file or write it anew";
    const std::string start = header("ascii", three + one_face);
    EXPECT_EQ(error_of(start + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
              "t.ply: line 11: too few values for element vertex: no z" + mend);
    EXPECT_EQ(error_of(start + "0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n"),
              "t.ply: line 11: more values than the header declares for element vertex" + mend);
    EXPECT_EQ(error_of(start + "0 0 0\n\n1 0 x0\n0 1 0\n3 0 1 2\n"),
              "t.ply: line 12: \"x0\" is no value for property z of element vertex" + mend);
    EXPECT_EQ(error_of(start + three_rows + "3 0 1 2.5\n"),
              "t.ply: line 13: \"2.5\" is no value for property vertex_indices of element face" + mend);
    EXPECT_EQ(error_of(start + three_rows + "-3 0 1 2\n"),
              "t.ply: line 13: the list vertex_indices has the length -3" + mend);
    EXPECT_EQ(error_of(header("ascii", "element vertex 1\n" + xyz + "property uchar q\n") + "0 0 0 256"),
              "t.ply: line 9: \"256\" is no value for property q of element vertex" + mend);
    EXPECT_EQ(
        error_of(start + three_rows + "3 0 1 3\n"),
        "t.ply: face 1, corner 3: vertex index 3 (counted from 0) is outside [0, 3); mend the file or write it anew");
    EXPECT_EQ(
        error_of(start + three_rows + "3 0 -1 2\n"),
        "t.ply: face 1, corner 2: vertex index -1 (counted from 0) is outside [0, 3); mend the file or write it anew");
    EXPECT_EQ(error_of(header("ascii", three + "element face 3\nproperty list uchar uint vertex_indices\n") +
                       three_rows + "2 0 1\n3 0 1 2\n3 0 1 4294967295\n"),
              "t.ply: face 3, corner 3: vertex index 4294967295 is beyond 32 bits" + mend);
    EXPECT_EQ(error_of(header(binary, three + "element face 1\nproperty list char int vertex_indices\n") +
                       three_points() + "\xFF"),
              "t.ply: element face, item 1: the list vertex_indices has the length -1" + mend);
    // The face keeps its number in the file behind one that was left out.
    EXPECT_EQ(
        error_of(header("ascii", three + "element face 3\nproperty list uchar int vertex_indices\n") + three_rows +
                 "2 0 1\n4 0 1 2 0\n3 0 9 2\n"),
        "t.ply: face 3, corner 2: vertex index 9 (counted from 0) is outside [0, 3); mend the file or write it anew");
}

TEST(PlyRead, CutShort) {
    const std::string get = "; get the whole file";
    EXPECT_EQ(error_of(header("ascii", three) + "0 0 0\n1 0 0\n"),
              "t.ply: element vertex: the file ends after 2 of 3" + get);
    EXPECT_EQ(error_of(header("ascii", three) + "0 0 0\n1 0"),
              "t.ply: element vertex: the file ends after 1 of 3" + get);
    EXPECT_EQ(error_of(header(binary, three) + three_points().substr(0, 35)),
              "t.ply: element vertex: the file ends after 2 of 3" + get);
    const std::string faces = "element face 2\nproperty list uchar int vertex_indices\n";
    const std::string face = "\3" + raw<int>(0) + raw<int>(1) + raw<int>(2);
    EXPECT_EQ(error_of(header(binary, three + faces) + three_points() + face + face.substr(0, 12)),
              "t.ply: element face: the file ends after 1 of 2" + get);
    const std::string whole = header(binary, three + faces) + three_points() + face + face;
    EXPECT_EQ(read_ply(whole).face_count(), 2u);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_TRUE(error_of(whole.substr(0, size)).starts_with("t.ply: ")) << size;
    }
    support::check_damage(whole, "t.ply", Format::ply);
    const std::string text = header("ascii", three + faces) + three_rows + "3 0 1 2\n3 2 1 0";
    for (std::size_t size = 0; size + 1 < text.size(); ++size) {
        EXPECT_TRUE(error_of(text.substr(0, size)).starts_with("t.ply: ")) << size;
    }
    support::check_damage(text, "t.ply", Format::ply);
}

TEST(PlyRead, CountsThatTheFileDoesNotJustify) {
    for (const char* count : {"1000000000000", "9223372036854775807"}) {
        const std::string many = std::string(count) + "\n";
        for (const std::string& format : {std::string("ascii"), binary}) {
            const std::string vertices = header(format, "element vertex " + many + xyz);
            EXPECT_EQ(error_of(vertices),
                      "t.ply: element vertex: the file ends after 0 of " + std::string(count) + "; get the whole file");
            const std::string faces =
                header(format, three + "element face " + many +
                                   "property list uchar int vertex_indices\nproperty list uchar int b\n");
            EXPECT_EQ(error_of(faces + (format == "ascii" ? three_rows : three_points())),
                      "t.ply: element face: the file ends after 0 of " + std::string(count) + "; get the whole file");
        }
    }
    // A list of two billion values in a file of a few bytes.
    const std::string list = header(binary, "element vertex 1\n" + xyz + "property list int double l\n");
    EXPECT_EQ(error_of(list + three_points().substr(0, 12) + raw<int>(2000000000)),
              "t.ply: element vertex: the file ends after 0 of 1; get the whole file");
}

TEST(PlyRead, RealFiles) {
    NEED_DATA();
    support::check_listed(".ply", {"unsized_dims.ply"});
}

TEST(PlyRead, ThreadsDoNotMatter) {
    NEED_DATA();
    for (const char* name : {"meshes/classic/horse.ply", "meshes/seed/bunny.ply", "nasty/fuze.ply"}) {
        const std::string path = (support::data_folder() / name).string();
        const Geometry one = gaussmap::read(path, Format::ply, {1, {}}),
                       seven = gaussmap::read(path, Format::ply, {7, {}});
        EXPECT_TRUE(support::same_bits(one.vertices, seven.vertices));
        EXPECT_EQ(gaussmap::write_bytes(one, {.format = Format::ply}),
                  gaussmap::write_bytes(seven, {.format = Format::ply}));
    }
}

TEST(PlyRead, ProgressAndCancelling) {
    std::string text = header("ascii", "element vertex 200000\n" + xyz);
    for (int i = 0; i < 200000; ++i) text += "1 2 3\n";
    double last = 0;
    const auto progress = [&](double fraction) {
        EXPECT_LE(last, fraction);
        return (last = fraction) < 0.3;
    };
    EXPECT_THROW(gaussmap::read_bytes(text, "t.ply", Format::ply, {1, progress}), gaussmap::Cancelled);
    EXPECT_GE(last, 0.3);
}

}  // namespace
