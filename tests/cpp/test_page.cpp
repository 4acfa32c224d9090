// The page: what it holds, read back by a decoder of its own, and what it refuses.
#include "gaussmap/page.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <limits>

#include "gaussmap/surfaces.h"
#include "support.h"

namespace {

using gaussmap::PageScene;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The text between `begin` and `end`, the first after `from`.
std::string between(const std::string& text, const std::string& begin, const std::string& end, std::size_t from = 0) {
    const std::size_t at = text.find(begin, from);
    if (at == std::string::npos) return "(no " + begin + ")";
    const std::size_t first = at + begin.size();
    return text.substr(first, text.find(end, first) - first);
}

std::string head_of(const std::string& page) {
    return between(page, R"(<script type="application/json" id="gaussmap">)", "</script>");
}

std::vector<unsigned char> bytes_of_base64(const std::string& text) {
    const auto digit = [](char c) -> unsigned {
        if (c >= 'A' && c <= 'Z') return c - 'A';
        if (c >= 'a' && c <= 'z') return c - 'a' + 26;
        if (c >= '0' && c <= '9') return c - '0' + 52;
        return c == '+' ? 62 : 63;
    };
    std::vector<unsigned char> out;
    unsigned bits = 0;
    int held = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | digit(c), held += 6;
        if (held >= 8) held -= 8, out.push_back(bits >> held & 255);
    }
    return out;
}

/// The numbers of the array that the head names after `key`, as words of that many bytes.
std::vector<std::uint64_t> array_of(const std::string& page, const std::string& key, std::size_t width,
                                    std::size_t from = 0) {
    const std::string head = head_of(page);
    const std::string array = between(head, "\"" + key + "\":{", "}", from);
    std::size_t block = std::stoul(between(array, "\"block\":", ","));
    const std::size_t rows = std::stoul(between(array, "\"rows\":", ",")),
                      columns = std::stoul(between(array, "\"columns\":", ",")),
                      per_block = std::stoul(between(head, "\"rows_a_block\":", ","));
    const bool triangles = array.find("\"triangles\"") != std::string::npos;
    std::vector<std::uint64_t> out(rows * columns);
    for (std::size_t begin = 0; begin < rows; begin += per_block, ++block) {
        const std::size_t n = std::min(per_block, rows - begin);
        const auto packed = bytes_of_base64(
            between(page, "<script type=\"text/plain\" id=\"gaussmap-" + std::to_string(block) + "\">", "</script>"));
        std::vector<unsigned char> planes(n * columns * width);
        uLongf size = planes.size();
        EXPECT_EQ(uncompress(planes.data(), &size, packed.data(), packed.size()), Z_OK);
        EXPECT_EQ(size, planes.size());
        for (std::size_t c = 0; c < columns; ++c)
            for (std::size_t r = 0; r < n; ++r) {
                std::uint64_t coded = 0;
                for (std::size_t b = 0; b < width; ++b)
                    coded |= std::uint64_t{planes[(c * width + b) * n + r]} << (8 * b);
                const std::uint64_t difference = coded >> 1 ^ (0 - (coded & 1));
                std::uint64_t base = r > 0 ? out[(begin + r - 1) * columns + c] : 0;
                if (triangles && c > 0) base = out[(begin + r) * columns];
                out[(begin + r) * columns + c] = (base + difference) & (~std::uint64_t{0} >> (64 - 8 * width));
            }
    }
    return out;
}

std::vector<double> floats_of(const std::string& page, const std::string& key, std::size_t from = 0) {
    std::vector<double> out;
    for (const std::uint64_t word : array_of(page, key, 4, from))
        out.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(word)));
    return out;
}

std::string message_of(const std::vector<PageScene>& scenes, const gaussmap::PageOptions& options = {}) {
    try {
        gaussmap::page_html(scenes, options);
    } catch (const std::invalid_argument& error) { return error.what(); }
    return "nothing thrown";
}

struct Page : testing::Test {
    std::vector<double> vertices = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5};
    std::vector<std::int32_t> faces = {0, 1, 2, 0, 2, 3};
    std::vector<double> normals = {0, 0, 1, 0, 2, 0, -3, 0, -1e-3, nan, 0, 0};
    PageScene scene;

    void SetUp() override {
        if (!gaussmap::page_obstacle().empty()) GTEST_SKIP() << gaussmap::page_obstacle();
        scene.name = "a.ply";
        scene.vertices = vertices;
        scene.faces = faces;
        gaussmap::add_field(scene, "density", {1, nan, 0.5F, 1e-30F});
    }
};

TEST_F(Page, HoldsWhatItWasGiven) {
    scene.normals = normals;
    gaussmap::add_field(scene, "kappa", {0.25, 3}, true);
    const std::string page = gaussmap::page_html({scene});
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_EQ(floats_of(page, "positions"), vertices);
    const auto corners = array_of(page, "triangles", 4);
    EXPECT_TRUE(std::equal(corners.begin(), corners.end(), faces.begin(), faces.end()));
    const std::string head = head_of(page);
    const auto density = floats_of(page, "values", head.find("\"name\":\"density\""));
    EXPECT_EQ(density[0], 1);
    EXPECT_TRUE(std::isnan(density[1]));
    EXPECT_EQ(density[3], 1e-30F);
    EXPECT_EQ(floats_of(page, "values", head.find("\"name\":\"kappa\"")), (std::vector<double>{0.25, 3}));
    const auto directions = array_of(page, "normals", 2);
    const std::vector<std::uint64_t> expected = {0, 0, 0, 32767, 0x8001, 0, 0x8000, 0x8000};
    for (const std::size_t i : {0, 1, 2, 3, 6, 7}) EXPECT_EQ(directions[i], expected[i]) << i;
    EXPECT_NE(head.find("\"label\":\"total curvature k1² + k2²\",\"unit\":\"1/unit²\",\"of\":\"vertex\""),
              std::string::npos);
}

TEST_F(Page, KeepsValuesThatNeedDoublePrecision) {
    gaussmap::add_field(scene, "time", {0.1, 1e300, -nan, 4});
    const std::string page = gaussmap::page_html({scene});
    const auto words = array_of(page, "values", 8, head_of(page).find("\"name\":\"time\""));
    EXPECT_EQ(std::bit_cast<double>(words[0]), 0.1);
    EXPECT_EQ(std::bit_cast<double>(words[1]), 1e300);
    EXPECT_EQ(std::bit_cast<double>(words[3]), 4);
}

TEST_F(Page, CoordinatesFarFromTheOriginKeepTheirDetail) {
    for (std::size_t i = 0; i < vertices.size(); i += 3) vertices[i] += 4.5e6 + 0.1;
    const std::string page = gaussmap::page_html({scene});
    const double origin = std::stod(between(head_of(page), "\"origin\":[", ","));
    const auto positions = floats_of(page, "positions");
    for (std::size_t i = 0; i < vertices.size(); i += 3) EXPECT_NEAR(origin + positions[i], vertices[i], 1e-7);
}

TEST_F(Page, LargeArraysAreCutIntoBlocksThatStandAlone) {
    const gaussmap::Surface sphere = gaussmap::sphere(7, 1);  // 327,680 faces: two blocks
    PageScene large;
    large.name = "sphere";
    large.vertices = sphere.vertices, large.faces = sphere.faces, large.normals = sphere.normals;
    std::vector<double> values(sphere.vertices.size() / 3);
    for (std::size_t v = 0; v < values.size(); ++v) values[v] = static_cast<double>(v % 1000);
    gaussmap::add_field(large, "density", values);
    gaussmap::PageOptions one, many;
    one.run.threads = 1, many.run.threads = 5;
    const std::string page = gaussmap::page_html({large}, one);
    EXPECT_EQ(page, gaussmap::page_html({large}, many)) << "the same bytes for any number of threads";
    EXPECT_EQ(floats_of(page, "values", head_of(page).find("\"name\":\"density\"")), values);
    const auto corners = array_of(page, "triangles", 4);
    EXPECT_TRUE(std::equal(corners.begin(), corners.end(), sphere.faces.begin(), sphere.faces.end()));
    const std::size_t ply = 16 * values.size() + 13 * sphere.faces.size() / 3;
    EXPECT_LT(static_cast<double>(page.size()), 1.3 * static_cast<double>(ply));
}

TEST_F(Page, NamesCannotBreakOutOfTheHead) {
    scene.name = "</script>\"\\\n<b>";
    const std::string head = head_of(gaussmap::page_html({scene}));
    EXPECT_NE(head.find(R"("name":"\u003c/script>\"\\\u000a\u003cb>")"), std::string::npos) << head;
}

TEST_F(Page, KnowsFieldsByName) {
    gaussmap::add_field(scene, "k1", {1, 2, 3, 4});
    gaussmap::add_field(scene, "intensity", {1, 2, 3, 4});
    EXPECT_EQ(scene.fields[1].unit, "1/unit");
    EXPECT_TRUE(scene.fields[1].diverging);
    EXPECT_EQ(scene.fields[2].label, "");
    EXPECT_EQ(scene.fields[2].noise, 0);
    EXPECT_NEAR(scene.fields[0].noise, 1e-9 / 2.25, 1e-24);
    EXPECT_NEAR(scene.fields[1].noise, std::sqrt(1e-9) / 1.5, 1e-18);
}

TEST_F(Page, CloudsTellTheirSpacing) {
    std::vector<double> grid;
    for (int i = 0; i < 400; ++i) grid.insert(grid.end(), {i % 20 * 1.0, std::floor(i / 20.0), 0});
    PageScene cloud;
    cloud.vertices = grid;
    gaussmap::add_field(cloud, "density", std::vector<double>(400, 0));
    const double spacing = std::stod(between(head_of(gaussmap::page_html({cloud})), "\"spacing\":", ","));
    EXPECT_NEAR(spacing, 0.7 * std::sqrt(2), 1e-12) << "0.7 of the way to the sixth neighbour";
}

TEST_F(Page, RefusesWhatItCannotShow) {
    EXPECT_EQ(message_of({}), "page_html: 0 scenes; a page shows one or two");
    EXPECT_EQ(message_of({scene, scene, scene}), "page_html: 3 scenes; a page shows one or two");
    EXPECT_EQ(message_of({PageScene{}}), "nothing to draw: there are no vertices");
    gaussmap::PageOptions options;
    options.field = "k9";
    EXPECT_EQ(message_of({scene}, options), "page_html: no scene has a field 'k9'");
    options = {};
    options.low = 2, options.high = 1;
    EXPECT_EQ(message_of({scene}, options),
              "page_html: a range from low = 2 to high = 1; low must be less than high, and both finite (or NaN: "
              "automatic)");
    PageScene wrong = scene;
    wrong.fields[0].values.pop_back();
    EXPECT_EQ(message_of({wrong}), "field 'density' has 3 entries, but there are 4 vertices");
    wrong = scene;
    wrong.fields.push_back(scene.fields[0]);
    EXPECT_EQ(message_of({wrong}), "page_html: two fields are called 'density'");
    faces[4] = 7;
    EXPECT_EQ(message_of({scene}), "faces[1][1] = 7 is outside [0, 4)");
    faces[4] = 2;
    std::fill(vertices.begin(), vertices.end(), nan);
    EXPECT_EQ(message_of({scene}), "nothing to draw: no face has three finite corners");
}

TEST_F(Page, CanBeCancelled) {
    gaussmap::PageOptions options;
    options.run.progress = [](double) { return false; };
    EXPECT_THROW(gaussmap::page_html({scene}, options), gaussmap::Cancelled);
}

}  // namespace
