// STL, binary and text: loose triangles, joined where corners are at exactly the same position.
#include <bit>
#include <span>

#include "gaussmap/neighbors.h"
#include "io/rows.h"
#include "io/types.h"
#include "vec.h"

namespace gaussmap::io {

namespace {

static_assert(std::endian::native == std::endian::little, "STL is little-endian and so is every machine we build for");

constexpr std::size_t header_bytes = 84;  // 80 of free text, then the number of triangles
constexpr std::size_t record_bytes = 50;  // normal, three corners (12 floats), 2 bytes of no fixed meaning

std::size_t claimed_triangles(std::string_view bytes) {
    return value_at<std::uint32_t>(bytes.data() + 80);
}

/// Text begins with "solid", but so do some binary files: their size gives them away, or their zeros.
bool is_text(std::string_view bytes) {
    if (bytes.size() >= header_bytes && bytes.size() == header_bytes + record_bytes * claimed_triangles(bytes)) {
        return false;
    }
    const std::string_view front = bytes.substr(0, 1024);
    std::string_view probe = front;
    return lower(next_word(probe)) == "solid" && front.find('\0') == std::string_view::npos;
}

std::vector<double> read_binary(const Source& source, std::vector<std::string>& notes) {
    const std::string_view bytes = source.bytes;
    if (bytes.size() < header_bytes) {
        fail(source, "", "neither a text STL nor long enough (84 bytes) for a binary one",
             "check what kind of file this is");
    }
    const std::size_t triangles = claimed_triangles(bytes);
    const std::size_t there = (bytes.size() - header_bytes) / record_bytes;
    if (there < triangles) {
        fail(source, "",
             "the file ends after " + std::to_string(there) + " of " + std::to_string(triangles) + " triangles",
             "it is cut short, or no STL");
    }
    if (const std::size_t rest = bytes.size() - header_bytes - triangles * record_bytes; rest > 0) {
        notes.push_back(counted(rest, "byte") + " after the last triangle ignored");
    }
    std::vector<double> corners(9 * triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
        const char* const record = bytes.data() + header_bytes + t * record_bytes;
        const auto xyz = value_at<std::array<float, 9>>(record + 12);
        std::copy(xyz.begin(), xyz.end(), corners.begin() + static_cast<std::ptrdiff_t>(9 * t));
    }
    return corners;
}

/// The words of a text STL in their order; line ends matter only after "solid" and "endsolid", whose rest is a name.
class TextReader {
  public:
    explicit TextReader(const Source& source) : source_(source), lines_(text_of(source)) {}

    std::vector<double> read() {
        std::string_view line;
        while (lines_.next(line)) {
            report(source_, lines_);
            for (auto word = lower(next_word(line)); !word.empty(); word = lower(next_word(line))) {
                if (take(word, line)) break;
            }
        }
        if (in_solid_) {
            fail(source_, "", "the text ends within a solid, after " + counted(corners_.size() / 9, "triangle"),
                 "it is cut short");
        }
        return std::move(corners_);
    }

  private:
    /// One word and its arguments from the rest of the line; true where that rest is a name.
    bool take(const std::string& word, std::string_view& line) {
        if (word == "solid" || word == "endsolid") {
            if (facet_corners_ >= 0) unexpected(word, "endfacet");
            in_solid_ = word == "solid";
            return true;
        }
        if (word == "facet") {
            if (facet_corners_ >= 0) unexpected(word, "endfacet");
            facet_corners_ = 0;
            for (int i = 0; i < 4; ++i) next_word(line);  // "normal" and its numbers, computed anew on writing
        } else if (word == "vertex") {
            if (facet_corners_ < 0) unexpected(word, "facet");
            for (int i = 0; i < 3; ++i) corners_.push_back(number(source_, lines_, next_word(line)));
            ++facet_corners_;
        } else if (word == "endfacet") {
            if (facet_corners_ != 3) {
                fail(source_, lines_.where(),
                     "a facet of " + counted(static_cast<std::size_t>(std::max(0, facet_corners_)), "corner"),
                     "STL holds triangles");
            }
            facet_corners_ = -1;
        } else if (word != "outer" && word != "loop" && word != "endloop") {
            unexpected(word, facet_corners_ < 0 ? "facet or endsolid" : "vertex");
        }
        return false;
    }

    [[noreturn]] void unexpected(const std::string& word, const std::string& wanted) const {
        fail(source_, lines_.where(), quoted(word) + " where " + wanted + " should be");
    }

    const Source& source_;
    Lines lines_;
    std::vector<double> corners_;
    int facet_corners_ = -1;  // −1: outside a facet
    bool in_solid_ = false;
};

/// Triangles from loose corners, 9 values each. Corners that are not finite stay alone.
void join(Geometry& geometry, const std::vector<double>& corners, const Source& source) {
    const std::size_t count = corners.size() / 3;
    if (count > std::numeric_limits<std::int32_t>::max()) fail(source, "", "more than 2147483647 corners");
    DistinctPoints distinct = distinct_points(Points(corners));
    geometry.vertices = std::move(distinct.points);
    geometry.faces = std::move(distinct.target);
    for (std::size_t i = 0; i < count; ++i) {
        if (geometry.faces[i] >= 0) continue;
        geometry.faces[i] = static_cast<std::int32_t>(geometry.vertex_count());
        geometry.vertices.insert(geometry.vertices.end(), corners.begin() + static_cast<std::ptrdiff_t>(3 * i),
                                 corners.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    }
    if (count > geometry.vertex_count()) {
        geometry.notes.push_back(counted(count, "corner") + " joined to " + std::to_string(geometry.vertex_count()) +
                                 " vertices");
    }
}

/// Unit normal of a triangle, zero where it has none.
Vec3 facet_normal(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 normal = cross(b - a, c - a);
    const double size = length(normal);
    return size > 0 && std::isfinite(size) ? (1 / size) * normal : Vec3{};
}

std::string write_binary(const Geometry& geometry) {
    std::string out(header_bytes + record_bytes * geometry.face_count(), '\0');
    constexpr std::string_view title = "binary STL by gaussmap";  // must not begin with "solid"
    title.copy(out.data(), title.size());
    put(out.data() + 80, static_cast<std::uint32_t>(geometry.face_count()));
    for (std::size_t t = 0; t < geometry.face_count(); ++t) {
        Vec3 corner[4];
        for (int i = 0; i < 3; ++i)
            corner[i + 1] = load(geometry.vertices.data() + 3 * std::size_t(geometry.faces[3 * t + i]));
        corner[0] = facet_normal(corner[1], corner[2], corner[3]);
        char* to = out.data() + header_bytes + t * record_bytes;
        for (const Vec3& p : corner) {
            for (const double v : {p.x, p.y, p.z}) put(to, static_cast<float>(v)), to += sizeof(float);
        }
    }
    return out;
}

std::string write_text(const Geometry& geometry) {
    const Type type = geometry.vertex_type == Type::float32 ? Type::float32 : Type::float64;
    std::string out = "solid gaussmap\n";
    const auto row = [&](const char* words, Vec3 p, Type as) {
        out += words;
        for (const double v : {p.x, p.y, p.z}) out += ' ', append_number(out, v, as);
        out += '\n';
    };
    for (std::size_t t = 0; t < geometry.face_count(); ++t) {
        Vec3 corner[3];
        for (int i = 0; i < 3; ++i)
            corner[i] = load(geometry.vertices.data() + 3 * std::size_t(geometry.faces[3 * t + i]));
        row("facet normal", facet_normal(corner[0], corner[1], corner[2]), Type::float32);
        out += "outer loop\n";
        for (const Vec3& p : corner) row("vertex", p, type);
        out += "endloop\nendfacet\n";
    }
    return out + "endsolid gaussmap\n";
}

}  // namespace

Geometry read_stl(const Source& source) {
    Geometry geometry;
    if (is_text(source.bytes)) {
        join(geometry, TextReader(source).read(), source);
    } else {
        join(geometry, read_binary(source, geometry.notes), source);
        geometry.vertex_type = Type::float32;
    }
    return geometry;
}

std::string write_stl(const Geometry& geometry, const WriteOptions& options) {
    if (geometry.faces.empty() && !geometry.vertices.empty()) {
        throw std::invalid_argument(
            "STL holds triangles alone, and there are none; write points as .ply, .xyz or .pcd");
    }
    return options.ascii ? write_text(geometry) : write_binary(geometry);
}

}  // namespace gaussmap::io
