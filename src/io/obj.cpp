// Wavefront OBJ: v, vt, vn and f; groups, materials, points and lines are passed over.
#include <array>
#include <limits>
#include <optional>
#include <span>

#include "io/colors.h"
#include "io/face_rows.h"
#include "io/polygons.h"
#include "io/rows.h"

namespace gaussmap::io {

namespace {

/// One corner of a face as written: counted from 1, or back from the end by negative numbers; 0: not given.
struct Corner {
    std::int64_t vertex = 0, texcoord = 0, normal = 0;
};

/// "v", "v/vt", "v//vn" or "v/vt/vn" (empty parts are not given); nothing where the word is none of these.
std::optional<Corner> parse_corner(std::string_view word) {
    Corner corner;
    const char* at = word.data();
    const char* const end = at + word.size();
    for (std::int64_t* const part : {&corner.vertex, &corner.texcoord, &corner.normal}) {
        if (at != end && *at != '/') {
            const auto [after, error] = std::from_chars(at, end, *part);
            if (error != std::errc() || (after != end && *after != '/')) return std::nullopt;
            at = after;
        } else if (part == &corner.vertex) {
            return std::nullopt;
        }
        if (at == end) return corner;
        ++at;
    }
    return std::nullopt;
}

/// What every corner of the faces taken so far refers to, from 0; −1 where it is not given or not there.
/// Empty until a first corner refers to anything.
struct CornerIndices {
    std::vector<std::int32_t> of_corner;

    void append(std::size_t corners_before, std::span<const std::int32_t> indices) {
        if (of_corner.empty()) {
            if (std::all_of(indices.begin(), indices.end(), [](std::int32_t i) { return i < 0; })) return;
            of_corner.resize(corners_before, -1);
        }
        of_corner.insert(of_corner.end(), indices.begin(), indices.end());
    }
    /// Corners without an index in [0, count).
    std::size_t missing(std::size_t count) const {
        return static_cast<std::size_t>(std::count_if(of_corner.begin(), of_corner.end(), [&](std::int32_t i) {
            return i < 0 || static_cast<std::size_t>(i) >= count;
        }));
    }
};

class ObjReader {
  public:
    explicit ObjReader(const Source& source) : source_(source), lines_(text_of(source)) {}

    Geometry read() {
        std::string_view line;
        while (lines_.next(line)) {
            report(source_, lines_);
            const std::string_view keyword = next_word(line);
            if (keyword == "v") {
                read_vertex(joined(line));
            } else if (keyword == "f") {
                read_face(joined(line));
            } else if (keyword == "vn") {
                for (const double v : read_numbers(joined(line), 3, 3)) normals_.push_back(v);
            } else if (keyword == "vt") {
                const std::span<const double> uv = read_numbers(joined(line), 1, 2);
                texcoords_.push_back(static_cast<float>(uv[0]));
                texcoords_.push_back(uv.size() > 1 ? static_cast<float>(uv[1]) : 0);
            } else if (!keyword.empty() && keyword[0] != '#') {
                other_lines_ += is_known(keyword) ? 1 : 0;
                unknown_lines_ += is_known(keyword) ? 0 : 1;
            }
        }
        return finish();
    }

  private:
    static bool is_known(std::string_view keyword) {
        static constexpr std::array<std::string_view, 8> known = {"l", "p", "g", "o", "s", "usemtl", "mtllib", "vp"};
        return std::find(known.begin(), known.end(), keyword) != known.end();
    }

    /// The line with those that follow it after a backslash.
    std::string_view joined(std::string_view line) {
        if (line.empty() || line.back() != '\\') return line;
        joined_.assign(line);
        while (!joined_.empty() && joined_.back() == '\\' && lines_.next(line)) {
            joined_.back() = ' ';
            joined_ += line;
        }
        return joined_;
    }

    /// The numbers of a line, up to a comment or `most` of them; fewer than `least` are an error.
    std::span<const double> read_numbers(std::string_view text, std::size_t least, std::size_t most) {
        std::size_t count = 0;
        for (std::string_view word; count < most; ++count) {
            word = next_word(text);
            if (word.empty() || word[0] == '#') break;
            numbers_[count] = number(source_, lines_, word);
        }
        if (count < least) {
            fail(source_, lines_.where(), counted(count, "number") + " where " + std::to_string(least) + " are needed");
        }
        return {numbers_.data(), count};
    }

    /// Three coordinates, then nothing, or a weight (ignored), or a colour.
    void read_vertex(std::string_view text) {
        const std::span<const double> row = read_numbers(text, 3, 6);
        vertices_.insert(vertices_.end(), row.begin(), row.begin() + 3);
        if (row.size() == 6) colors_.insert(colors_.end(), row.begin() + 3, row.end());
    }

    void read_face(std::string_view text) {
        face_.clear(), face_texcoords_.clear(), face_normals_.clear();
        for (auto word = next_word(text); !word.empty() && word[0] != '#'; word = next_word(text)) {
            const std::optional<Corner> corner = parse_corner(word);
            if (!corner) {
                fail(source_, lines_.where(), quoted(word) + " is no corner of a face (v, v/vt, v//vn or v/vt/vn)");
            }
            face_.push_back(vertex_index(corner->vertex));
            face_texcoords_.push_back(attribute_index(corner->texcoord, texcoords_.size() / 2));
            face_normals_.push_back(attribute_index(corner->normal, normals_.size() / 3));
        }
        if (!faces_.add(face_)) return;
        corner_texcoords_.append(corners_, face_texcoords_);
        corner_normals_.append(corners_, face_normals_);
        corners_ += face_.size();
    }

    std::int32_t vertex_index(std::int64_t index) {
        const auto count = static_cast<std::int64_t>(vertices_.size() / 3);
        if (index == 0) fail(source_, lines_.where(), "a face refers to vertex 0, but OBJ counts from 1");
        const std::int64_t from_0 = index > 0 ? index - 1 : count + index;
        if (from_0 < 0 || from_0 > std::numeric_limits<std::int32_t>::max()) no_such_vertex(index, lines_.number());
        if (index > count && index > furthest_) furthest_ = index, furthest_line_ = lines_.number();
        return static_cast<std::int32_t>(from_0);
    }

    [[noreturn]] void no_such_vertex(std::int64_t index, std::size_t line) const {
        const std::string there = index < 0 ? " so far" : "";
        fail(source_, "line " + std::to_string(line),
             "a face refers to vertex " + std::to_string(index) + ", but there are " +
                 std::to_string(vertices_.size() / 3) + there,
             "mend the file or write it anew");
    }

    /// Texture coordinates and normals that are not there are told once, at the end.
    static std::int32_t attribute_index(std::int64_t index, std::size_t count) {
        const std::int64_t from_0 = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
        const bool given = index != 0 && from_0 >= 0 && from_0 <= std::numeric_limits<std::int32_t>::max();
        return given ? static_cast<std::int32_t>(from_0) : -1;
    }

    Geometry finish() {
        Geometry geometry;
        if (vertices_.empty() && faces_.count() == 0 && other_lines_ == 0 && unknown_lines_ > 0) {
            fail(source_, "", "no line of it is OBJ (v, vt, vn, f, …)", "check what kind of file this is");
        }
        if (furthest_ > static_cast<std::int64_t>(vertices_.size() / 3)) no_such_vertex(furthest_, furthest_line_);
        if (unknown_lines_ > 0) geometry.notes.push_back(counted(unknown_lines_, "line") + " of unknown kind ignored");
        geometry.vertices = std::move(vertices_);
        geometry.normal_type = Type::float64;
        faces_.finish(geometry, source_);
        finish_colors(geometry);
        finish_normals(geometry);
        finish_texcoords(geometry);
        return geometry;
    }

    void finish_colors(Geometry& geometry) {
        if (colors_.empty()) return;
        if (colors_.size() != geometry.vertices.size()) {
            geometry.notes.push_back("only " + std::to_string(colors_.size() / 3) + " of " +
                                     std::to_string(geometry.vertex_count()) +
                                     " vertices have a colour: colours left out");
            return;
        }
        add_colors(geometry, geometry.vertex_properties, colors_, 3, are_fractions(colors_));
    }

    /// Normals belong to corners; they become normals of vertices where all corners of a vertex agree.
    void finish_normals(Geometry& geometry) {
        if (normals_.empty() && corner_normals_.of_corner.empty()) return;
        const std::size_t count = normals_.size() / 3;
        const std::vector<std::int32_t>& corners = corners_of(geometry);
        const std::vector<std::int32_t>& of_corner = corner_normals_.of_corner;
        if (count == geometry.vertex_count() && of_corner == corners) {  // also: points with normals, no faces
            geometry.normals = std::move(normals_);
            return;
        }
        if (of_corner.empty() || corner_normals_.missing(count) > 0) {
            const std::size_t missing = of_corner.empty() ? corners.size() : corner_normals_.missing(count);
            geometry.notes.push_back(std::to_string(missing) + " of " + counted(corners.size(), "corner") +
                                     " have no normal: normals left out");
            return;
        }
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        std::vector<double> normals(geometry.vertices.size(), nan);
        std::vector<std::int32_t> normal_of(geometry.vertex_count(), -1);
        std::vector<bool> crease(geometry.vertex_count());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const double* const normal = normals_.data() + 3 * static_cast<std::size_t>(of_corner[i]);
            std::int32_t& taken = normal_of[corners[i]];
            double* const slot = normals.data() + 3 * static_cast<std::size_t>(corners[i]);
            if (taken < 0)
                std::copy_n(normal, 3, slot);
            else if (taken != of_corner[i] && !std::equal(normal, normal + 3, slot))
                crease[corners[i]] = true;
            taken = of_corner[i];
        }
        const auto creases = static_cast<std::size_t>(std::count(crease.begin(), crease.end(), true));
        if (creases == 0) {
            geometry.normals = std::move(normals);
            return;
        }
        geometry.notes.push_back("corner normals differ at " + std::to_string(creases) +
                                 (creases == 1 ? " vertex" : " vertices") + " (creases): normals left out");
    }

    /// Texture coordinates become the list `texcoord` of every face.
    void finish_texcoords(Geometry& geometry) {
        const std::vector<std::int32_t>& of_corner = corner_texcoords_.of_corner;
        if (of_corner.empty()) return;
        if (const std::size_t missing = corner_texcoords_.missing(texcoords_.size() / 2); missing > 0) {
            geometry.notes.push_back(std::to_string(missing) + " of " + counted(of_corner.size(), "corner") +
                                     " have no texture coordinates: texture coordinates left out");
            return;
        }
        Property property;
        property.name = "texcoord";
        property.list = true;
        property.bytes.resize(of_corner.size() * 2 * sizeof(float));
        for (std::size_t i = 0; i < of_corner.size(); ++i) {
            std::memcpy(property.bytes.data() + i * 2 * sizeof(float),
                        texcoords_.data() + 2 * static_cast<std::size_t>(of_corner[i]), 2 * sizeof(float));
        }
        const FaceRows faces(geometry);
        std::size_t longest = 0;
        property.offsets.assign(1, 0);
        property.offsets.reserve(faces.count() + 1);
        for (std::size_t i = 0; i < faces.count(); ++i) {
            property.offsets.push_back(property.offsets.back() + 2 * faces[i].size());
            longest = std::max(longest, 2 * faces[i].size());
        }
        if (longest > 255) property.count_type = Type::int32;
        geometry.face_properties.push_back(std::move(property));
    }

    /// Vertices of all corners in the order of the file.
    static const std::vector<std::int32_t>& corners_of(const Geometry& geometry) {
        return geometry.polygons.empty() ? geometry.faces : geometry.polygons.corners;
    }

    const Source& source_;
    Lines lines_;
    std::vector<double> vertices_, normals_, colors_;
    std::vector<float> texcoords_;
    FaceList faces_;
    std::size_t corners_ = 0;
    CornerIndices corner_texcoords_, corner_normals_;
    std::vector<std::int32_t> face_, face_texcoords_, face_normals_;
    std::array<double, 6> numbers_;
    std::string joined_;
    std::int64_t furthest_ = 0;  // the largest vertex that a face referred to ahead of it
    std::size_t furthest_line_ = 0;
    std::size_t other_lines_ = 0, unknown_lines_ = 0;
};

/// The list property `texcoord` where it holds two values a corner of every face.
const Property* find_texcoords(const Geometry& geometry, const FaceRows& faces) {
    const auto found = std::find_if(geometry.face_properties.begin(), geometry.face_properties.end(),
                                    [](const Property& p) { return p.name == "texcoord" && p.list; });
    if (found == geometry.face_properties.end() || found->offsets.size() != faces.count() + 1) return nullptr;
    for (std::size_t i = 0; i < faces.count(); ++i) {
        if (found->offsets[i + 1] - found->offsets[i] != 2 * faces[i].size()) return nullptr;
    }
    return &*found;
}

void write_row(std::string& out, const char* keyword, const double* values, std::size_t count, Type type) {
    out += keyword;
    for (std::size_t i = 0; i < count; ++i) out += ' ', append_number(out, values[i], type);
}

}  // namespace

Geometry read_obj(const Source& source) {
    return ObjReader(source).read();
}

std::string write_obj(const Geometry& geometry, const WriteOptions&) {
    const Type type = geometry.vertex_type == Type::float32 ? Type::float32 : Type::float64;
    const Type normal_type = geometry.normal_type == Type::float32 ? Type::float32 : Type::float64;
    const std::vector<const Property*> colors = find_colors(geometry.vertex_properties);
    std::string out;
    for (std::size_t i = 0; i < geometry.vertex_count(); ++i) {
        write_row(out, "v", geometry.vertices.data() + 3 * i, 3, type);
        for (std::size_t c = 0; c < std::min<std::size_t>(3, colors.size()); ++c) {
            out += ' ';
            append_number(out, colors[c]->at(i) / 255, Type::float32);
        }
        out += '\n';
    }
    for (std::size_t i = 0; i < geometry.normals.size(); i += 3) {
        write_row(out, "vn", geometry.normals.data() + i, 3, normal_type);
        out += '\n';
    }
    const FaceRows faces(geometry);
    const Property* const texcoords = find_texcoords(geometry, faces);
    for (std::size_t i = 0; texcoords && i < faces.count(); ++i) {
        for (std::uint64_t at = texcoords->offsets[i]; at < texcoords->offsets[i + 1]; at += 2) {
            const double uv[2] = {texcoords->at(at), texcoords->at(at + 1)};
            write_row(out, "vt", uv, 2, texcoords->type == Type::float32 ? Type::float32 : Type::float64);
            out += '\n';
        }
    }
    std::size_t corner = 0;
    for (std::size_t i = 0; i < faces.count(); ++i) {
        out += 'f';
        for (const std::int32_t index : faces[i]) {
            const std::string vertex = std::to_string(index + std::int64_t{1});
            out.append(" ").append(vertex);
            if (texcoords) out.append("/").append(std::to_string(++corner));
            if (!geometry.normals.empty()) out.append(texcoords ? "/" : "//").append(vertex);
        }
        out += '\n';
    }
    return out;
}

}  // namespace gaussmap::io
