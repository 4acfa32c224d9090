// PLY out, and back in as the same geometry to the bit.
#include <limits>

#include "io_support.h"

using gaussmap::Format;
using gaussmap::Geometry;
using gaussmap::Property;
using gaussmap::Type;

namespace {

constexpr std::array all_types = {Type::int8,   Type::uint8, Type::int16,  Type::uint16,  Type::int32,
                                  Type::uint32, Type::int64, Type::uint64, Type::float32, Type::float64};

/// Random bytes as the values of a property; NaNs, whose text has no bits, become 1.
Property random_property(support::Random& random, const std::string& name, Type type, std::size_t count) {
    Property p;
    p.name = name;
    p.type = type;
    p.bytes.resize(count * size_of(type));
    for (std::byte& b : p.bytes) b = static_cast<std::byte>(random.next());
    const Property one = gaussmap::make_property(name, {1}, type);
    for (std::size_t i = 0; i < count; ++i) {
        if (std::isnan(p.at(i))) std::copy(one.bytes.begin(), one.bytes.end(), p.bytes.begin() + i * one.bytes.size());
    }
    return p;
}

Property random_list(support::Random& random, const std::string& name, Type type, std::size_t items) {
    std::vector<std::uint64_t> offsets{0};
    for (std::size_t i = 0; i < items; ++i) offsets.push_back(offsets.back() + random.below(4));
    Property p = random_property(random, name, type, offsets.back());
    p.list = true;
    p.offsets = offsets;
    return p;
}

Geometry everything(Type vertex_type, bool polygons) {
    support::Random random(3);
    std::string text = "OFF\n200 100 0\n";
    for (int i = 0; i < 600; ++i)
        text += std::to_string((static_cast<double>(random.below(2000)) - 1000) / 64) + (i % 3 == 2 ? "\n" : " ");
    for (int i = 0; i < 100; ++i) {
        const std::size_t n = polygons ? 3 + random.below(4) : 3;
        text += std::to_string(n);
        for (std::size_t c = 0; c < n; ++c) text += " " + std::to_string(1 + random.below(199));
        text += "\n";
    }
    Geometry g = gaussmap::read_bytes(text, "g.off", Format::off);
    g.vertex_type = vertex_type;
    g.normal_type = vertex_type == Type::float32 ? Type::float64 : Type::float32;
    for (std::size_t i = 0; i < 600; ++i) g.normals.push_back(random.normal());
    if (g.normal_type == Type::float32) {
        for (double& v : g.normals) v = static_cast<float>(v);
    }
    g.vertices[0] = INFINITY;  // of a vertex that no face has
    g.vertices[1] = -0.0;
    g.comments = {"one", "obj_info two", ""};
    for (const Type type : all_types) {
        const std::string name = "p" + std::to_string(static_cast<int>(type));
        g.vertex_properties.push_back(random_property(random, name, type, 200));
        g.face_properties.push_back(random_property(random, name, type, 100));
        g.vertex_properties.push_back(random_list(random, name + "list", type, 200));
        g.face_properties.push_back(random_list(random, name + "list", type, 100));
    }
    g.elements.push_back(
        {"edge", 7, {random_property(random, "a", Type::int32, 7), random_list(random, "b", Type::float64, 7)}});
    return g;
}

void expect_same(const std::vector<Property>& a, const std::vector<Property>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].name, b[i].name);
        EXPECT_EQ(a[i].type, b[i].type);
        EXPECT_EQ(a[i].list, b[i].list);
        EXPECT_EQ(a[i].offsets, b[i].offsets) << a[i].name;
        EXPECT_TRUE(a[i].bytes == b[i].bytes) << a[i].name;
        EXPECT_EQ(a[i].count_type, b[i].count_type);
    }
}

void expect_same(const Geometry& a, const Geometry& b) {
    EXPECT_TRUE(support::same_bits(a.vertices, b.vertices));
    EXPECT_TRUE(support::same_bits(a.normals, b.normals));
    EXPECT_EQ(a.vertex_type, b.vertex_type);
    if (!a.normals.empty()) { EXPECT_EQ(a.normal_type, b.normal_type); }
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_EQ(a.polygons.offsets, b.polygons.offsets);
    EXPECT_EQ(a.polygons.corners, b.polygons.corners);
    EXPECT_EQ(a.polygon_of, b.polygon_of);
    EXPECT_EQ(a.polygon_corner, b.polygon_corner);
    EXPECT_EQ(a.comments, b.comments);
    expect_same(a.vertex_properties, b.vertex_properties);
    expect_same(a.face_properties, b.face_properties);
    ASSERT_EQ(a.elements.size(), b.elements.size());
    for (std::size_t i = 0; i < a.elements.size(); ++i) {
        EXPECT_EQ(a.elements[i].name, b.elements[i].name);
        EXPECT_EQ(a.elements[i].count, b.elements[i].count);
        expect_same(a.elements[i].properties, b.elements[i].properties);
    }
}

Geometry again(const Geometry& g, bool ascii, bool triangles = false) {
    return gaussmap::read_bytes(gaussmap::write_bytes(g, {Format::ply, ascii, triangles}), "again.ply");
}

TEST(PlyWrite, RoundTripOfEverything) {
    for (const Type type : {Type::float32, Type::float64}) {
        for (const bool polygons : {false, true}) {
            const Geometry g = everything(type, polygons);
            EXPECT_NE(g.polygons.empty(), polygons);
            for (const bool ascii : {false, true}) expect_same(g, again(g, ascii));
        }
    }
}

TEST(PlyWrite, HeaderAndAsciiText) {
    Geometry g = gaussmap::read_bytes("v 0 0.5 1e10\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "g.obj", Format::obj);
    g.vertex_type = Type::float32;
    g.vertex_properties = {gaussmap::make_property("my quality", {1, 2.5, NAN})};
    g.comments = {"two\nlines"};
    EXPECT_EQ(gaussmap::write_bytes(g, {Format::ply, true, false}),
              "ply\nformat ascii 1.0\ncomment two lines\nelement vertex 3\nproperty float x\nproperty float "
              "y\nproperty float z\n"
              "property float my_quality\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
              "0 0.5 1e+10 1\n1 0 0 2.5\n0 1 0 nan\n3 0 1 2\n");
    const std::string bytes = gaussmap::write_bytes(g, {.format = Format::ply});
    EXPECT_TRUE(bytes.starts_with("ply\nformat binary_"));
    EXPECT_EQ(bytes.size(), bytes.find("end_header\n") + 11 + 3 * 16 + 13);
}

TEST(PlyWrite, LongPolygonsGetWiderCounts) {
    for (const std::size_t n : {255u, 256u, 65536u}) {
        std::string text = "OFF\n" + std::to_string(n) + " 1 0\n", corners = std::to_string(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
            text += std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
            corners += " " + std::to_string(i);
        }
        const Geometry g = gaussmap::read_bytes(text + corners + "\n", "g.off");
        const std::string bytes = gaussmap::write_bytes(g, {.format = Format::ply});
        const char* type = n == 255 ? "list uchar int" : n == 256 ? "list ushort int" : "list uint int";
        EXPECT_NE(bytes.find(type), bytes.npos) << n;
        expect_same(g, gaussmap::read_bytes(bytes, "again.ply"));
    }
}

TEST(PlyWrite, TrianglesInPlaceOfPolygons) {
    const Geometry g = everything(Type::float64, true);
    const Geometry t = again(g, false, true);
    EXPECT_TRUE(t.polygons.empty());
    EXPECT_EQ(t.faces, g.faces);
    expect_same(t, again(gaussmap::triangulate(g), false));
}

TEST(PlyWrite, EmptyGeometry) {
    const Geometry g = again({}, false);
    EXPECT_EQ(g.vertex_count(), 0u);
    EXPECT_EQ(g.face_count(), 0u);
}

TEST(PlyWrite, RealFilesComeBack) {
    NEED_DATA();
    for (const support::ListedFile& file : support::listed_files(".ply")) {
        if (file.vertices < 0 || file.path.ends_with("unsized_dims.ply")) continue;
        SCOPED_TRACE(file.path);
        const Geometry g = gaussmap::read((support::data_folder() / file.path).string());
        expect_same(g, again(g, false));
    }
}

TEST(PlyWrite, InconsistentGeometryIsNamed) {
    const auto error_of = [](Geometry g) -> std::string {
        try {
            gaussmap::write_bytes(g, {.format = Format::ply});
        } catch (const std::invalid_argument& error) { return error.what(); }
        return "";
    };
    Geometry g;
    g.vertices.assign(9, 0);
    g.normals.assign(6, 0);
    EXPECT_EQ(error_of(g), "normals has 6 values, but should have 9");
    g.normals.clear();
    g.faces = {0, 1, 3};
    EXPECT_EQ(error_of(g), "faces[2] = 3 is outside [0, 3)");
    g.faces = {0, 1};
    EXPECT_EQ(error_of(g), "faces has 2 values, but should have 0");
    g.faces = {0, 1, 2};
    g.vertex_properties = {gaussmap::make_property("q", {1, 2})};
    EXPECT_EQ(error_of(g), "vertex property q has 2 entries, but there are 3");
    g.vertex_properties.clear();
    g.face_properties = {gaussmap::make_property("q", {1, 2})};
    EXPECT_EQ(error_of(g), "face property q has 2 entries, but there are 1");
    g.face_properties[0].list = true;
    g.face_properties[0].offsets = {0, 3};
    EXPECT_EQ(error_of(g), "face property q: offsets do not rise to at most 2");
    g.face_properties.clear();
    g.elements = {{"edge", 3, {gaussmap::make_property("q", {1, 2})}}};
    EXPECT_EQ(error_of(g), "element edge: property q has 2 entries, but there are 3");
    g.elements.clear();
    g.polygons = {{0, 4}, {0, 1, 2, 0}};
    EXPECT_EQ(error_of(g), "polygon_of has 0 values, but should have 1");
    g.polygon_of = {0};
    g.polygon_corner = {0, 1, 4};
    EXPECT_EQ(error_of(g), "polygon_corner[2] = 4 is outside [0, 4)");
    g.polygons.offsets = {0, 5};
    EXPECT_EQ(error_of(g), "polygons.offsets do not rise to at most 4");
}

}  // namespace
