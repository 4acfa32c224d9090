// OFF and its kin: COFF, NOFF, STOFF and their mixtures, as text.
#include <array>
#include <span>

#include "io/colors.h"
#include "io/face_rows.h"
#include "io/polygons.h"
#include "io/rows.h"

namespace gaussmap::io {

namespace {

class OffReader {
  public:
    explicit OffReader(const Source& source) : source_(source), lines_(text_of(source)) {}

    Geometry read() {
        read_header();
        geometry_.vertices.reserve(3 * vertices_);
        for (std::size_t i = 0; i < vertices_; ++i) read_vertex(i);
        faces_.reserve(face_count_);
        for (std::size_t i = 0; i < face_count_; ++i) read_face(i);
        std::string_view row;
        if (next_row(row)) geometry_.notes.push_back("text after the last face ignored (" + lines_.where() + ")");
        return finish();
    }

  private:
    /// The next line with anything but blanks before its comment; the comment is cut off.
    bool next_row(std::string_view& row) {
        while (lines_.next(row)) {
            report(source_, lines_);
            row = row.substr(0, row.find('#'));
            std::string_view probe = row;
            if (!next_word(probe).empty()) return true;
        }
        return false;
    }

    /// The keyword (which may be left out), and the counts after it or on the next line.
    void read_header() {
        std::string_view row;
        if (!next_row(row)) fail(source_, "", "no OFF header", "check what kind of file this is");
        std::string_view rest = row;
        const std::string_view word = next_word(rest);
        double value = 0;
        if (!parse(word, value)) {
            read_keyword(word);
            row = rest;
            const std::string_view after = next_word(rest);
            if (after == "BINARY")
                fail(source_, lines_.where(), "binary OFF is not read", "convert it to text OFF or PLY");
            if (after.empty() && !next_row(row)) fail(source_, "", "the file ends before its counts");
        }
        vertices_ = count_of(next_word(row));
        face_count_ = count_of(next_word(row));
        check_counts();
    }

    std::size_t count_of(std::string_view word) const {
        std::int64_t count = 0;
        if (!parse(word, count) || count < 0) fail(source_, lines_.where(), quoted(word) + " is no count");
        return static_cast<std::size_t>(count);
    }

    /// [ST][C][N]OFF; four and n dimensions are refused.
    void read_keyword(std::string_view word) {
        std::string_view prefix = word;
        if (!prefix.ends_with("OFF")) {
            fail(source_, lines_.where(), quoted(word) + " where OFF, COFF, NOFF or the like should be",
                 "check what kind of file this is");
        }
        prefix.remove_suffix(3);
        const auto take = [&](std::string_view letters) {
            const bool there = prefix.starts_with(letters);
            if (there) prefix.remove_prefix(letters.size());
            return there;
        };
        has_texcoords_ = take("ST");
        take("C");  // colours are known by their numbers: many files have them without the letter
        has_normals_ = take("N");
        if (!prefix.empty()) fail(source_, lines_.where(), quoted(word) + ": only points in three dimensions are read");
    }

    /// A vertex takes at least 6 bytes ("0 0 0" and a line's end), a face 2, whatever the header claims.
    void check_counts() const {
        const std::size_t left = lines_.rest().size() + 1;
        if (vertices_ > left / 6 || face_count_ > (left - 6 * vertices_) / 2) {
            fail(source_, lines_.where(),
                 std::to_string(vertices_) + " vertices and " + std::to_string(face_count_) +
                     " faces are claimed, but only " + counted(left - 1, "byte") + " follow",
                 "the file is cut short or its counts are wrong");
        }
    }

    /// x y z, then a normal, a colour and texture coordinates as far as they are there.
    void read_vertex(std::size_t i) {
        std::string_view row;
        if (!next_row(row)) cut_short(i, vertices_, "vertices");
        for (int c = 0; c < 3; ++c) geometry_.vertices.push_back(value_of(row));
        for (int c = 0; c < 3 && has_normals_; ++c) geometry_.normals.push_back(value_of(row));
        extra_.clear();
        for (auto word = next_word(row); !word.empty(); word = next_word(row)) {
            extra_.push_back(number(source_, lines_, word));
        }
        if (has_texcoords_) {
            if (extra_.size() < 2) fail(source_, lines_.where(), "texture coordinates of the vertex are missing");
            texcoords_.insert(texcoords_.end(), extra_.end() - 2, extra_.end());
            extra_.resize(extra_.size() - 2);
        }
        vertex_colors_.add(extra_, i);
    }

    /// The number of corners, the corners, then a colour as far as it is there.
    void read_face(std::size_t i) {
        std::string_view row;
        if (!next_row(row)) cut_short(i, face_count_, "faces");
        const std::int32_t corners = index(source_, lines_, next_word(row));
        corners_.clear();
        for (std::int32_t c = 0; c < corners; ++c) {
            const std::string_view word = next_word(row);
            if (word.empty()) {
                fail(source_, lines_.where(),
                     "a face of " + std::to_string(corners) + " corners with only " + std::to_string(c) + " of them");
            }
            corners_.push_back(index(source_, lines_, word));
        }
        extra_.clear();
        for (auto word = next_word(row); !word.empty(); word = next_word(row)) {
            extra_.push_back(number(source_, lines_, word));
        }
        if (faces_.add(corners_)) face_colors_.add(extra_, faces_.count() - 1);
    }

    double value_of(std::string_view& row) const {
        const std::string_view word = next_word(row);
        if (word.empty()) fail(source_, lines_.where(), "a vertex of too few numbers");
        return number(source_, lines_, word);
    }

    [[noreturn]] void cut_short(std::size_t there, std::size_t claimed, const std::string& what) const {
        fail(source_, "",
             "the file ends after " + std::to_string(there) + " of " + std::to_string(claimed) + " " + what,
             "it is cut short or its counts are wrong");
    }

    Geometry finish() {
        geometry_.normal_type = Type::float64;
        faces_.finish(geometry_, source_);
        vertex_colors_.finish(geometry_, geometry_.vertex_properties, "vertices");
        face_colors_.finish(geometry_, geometry_.face_properties, "faces");
        for (std::size_t c = 0; c < 2 && has_texcoords_; ++c) {
            std::vector<double> channel(vertices_);
            for (std::size_t i = 0; i < vertices_; ++i) channel[i] = texcoords_[2 * i + c];
            geometry_.vertex_properties.push_back(make_property(c == 0 ? "s" : "t", channel));
        }
        return std::move(geometry_);
    }

    /// The numbers after what a row must hold: a colour where all rows have 3 or all have 4.
    struct ExtraNumbers {
        std::vector<double> values;
        std::size_t channels = 0;
        bool uniform = true;

        void add(const std::vector<double>& row, std::size_t i) {
            if (i == 0) channels = row.size();
            uniform = uniform && row.size() == channels;
            if (uniform) values.insert(values.end(), row.begin(), row.end());
        }
        void finish(Geometry& geometry, std::vector<Property>& properties, const std::string& of) const {
            if (uniform && channels == 0) return;
            if (!uniform || channels < 3 || channels > 4) {
                geometry.notes.push_back("numbers after the " + of + " that are no colour of each left out");
                return;
            }
            add_colors(geometry, properties, values, channels, are_fractions(values));
        }
    };

    const Source& source_;
    Lines lines_;
    Geometry geometry_;
    FaceList faces_;
    std::size_t vertices_ = 0, face_count_ = 0;
    bool has_normals_ = false, has_texcoords_ = false;
    ExtraNumbers vertex_colors_, face_colors_;
    std::vector<double> texcoords_, extra_;
    std::vector<std::int32_t> corners_;
};

void append_color(std::string& out, const std::vector<const Property*>& colors, std::size_t i) {
    for (const Property* channel : colors) out += ' ', append_number(out, channel->at(i), Type::uint8);
}

}  // namespace

Geometry read_off(const Source& source) {
    return OffReader(source).read();
}

std::string write_off(const Geometry& geometry, const WriteOptions&) {
    const Type type = geometry.vertex_type == Type::float32 ? Type::float32 : Type::float64;
    const Type normal_type = geometry.normal_type == Type::float32 ? Type::float32 : Type::float64;
    const std::vector<const Property*> colors = find_colors(geometry.vertex_properties);
    const std::vector<const Property*> face_colors = find_colors(geometry.face_properties);
    const FaceRows faces(geometry);

    std::string out = colors.empty() ? "" : "C";
    out += geometry.normals.empty() ? "OFF\n" : "NOFF\n";
    out += std::to_string(geometry.vertex_count()) + " " + std::to_string(faces.count()) + " 0\n";
    for (std::size_t i = 0; i < geometry.vertex_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            if (c > 0) out += ' ';
            append_number(out, geometry.vertices[3 * i + c], type);
        }
        for (std::size_t c = 0; c < 3 && !geometry.normals.empty(); ++c) {
            out += ' ';
            append_number(out, geometry.normals[3 * i + c], normal_type);
        }
        append_color(out, colors, i);
        out += '\n';
    }
    for (std::size_t i = 0; i < faces.count(); ++i) {
        out += std::to_string(faces[i].size());
        for (const std::int32_t corner : faces[i]) out += ' ', out += std::to_string(corner);
        append_color(out, face_colors, i);
        out += '\n';
    }
    return out;
}

}  // namespace gaussmap::io
