// Points as rows of numbers: XYZ, PWN, PTS, ASC and lists separated by commas or semicolons.
#include <array>
#include <optional>
#include <set>

#include "io/colors.h"
#include "io/rows.h"
#include "io/types.h"

namespace gaussmap::io {

namespace {

bool is_separator(char c) {
    return is_blank(c) || c == ',' || c == ';';
}

/// Cut the next word off the front of `text`; empty where there is none, or where a comment begins.
std::string_view next_field(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && is_separator(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_separator(text[end])) ++end;
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word.starts_with('#') || word.starts_with("//") ? std::string_view() : word;
}

std::vector<std::string> fields_of(std::string_view text) {
    std::vector<std::string> fields;
    for (auto word = next_field(text); !word.empty(); word = next_field(text)) fields.emplace_back(word);
    return fields;
}

/// A comment without the marks that begin it.
std::string_view without_marks(std::string_view comment) {
    return comment.substr(std::min(comment.size(), comment.find_first_not_of("#;/ \t")));
}

/// The rows of a file, and what stood above them.
struct Table {
    std::vector<double> values;
    std::size_t columns = 0;
    std::vector<std::string> heading;     // words of the last comment or heading above the first row
    std::optional<std::int64_t> claimed;  // rows that the file says it has (PTS, PWN)

    std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
    double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
    std::vector<double> column(std::size_t c) const {
        std::vector<double> out(rows());
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = at(i, c);
        return out;
    }
};

class TableReader {
  public:
    explicit TableReader(const Source& source) : source_(source), lines_(text_of(source)) {}

    Table read() {
        std::string_view line;
        while (lines_.next(line)) {
            report(source_, lines_);
            const std::size_t mark = line.find_first_not_of(" \t");
            if (mark == line.npos) continue;
            line.remove_prefix(mark);
            if (line[0] == '#' || line[0] == ';' || line.starts_with("//")) {
                if (table_.columns == 0) table_.heading = fields_of(without_marks(line));
            } else {
                read_row(line);
            }
        }
        if (table_.columns == 0 && heading_line_) {
            fail(source_, lines_.where(), "no row of numbers", "check what kind of file this is");
        }
        return std::move(table_);
    }

  private:
    void read_row(std::string_view line) {
        const std::size_t begin = table_.values.size();
        std::string_view rest = line;
        for (auto word = next_field(rest); !word.empty(); word = next_field(rest)) {
            double value = 0;
            if (!parse(word, value)) {
                if (table_.columns > 0 || heading_line_) {
                    fail(source_, lines_.where(), quoted(word) + " is no number");
                }
                heading_line_ = true;  // one line of names may stand above the numbers
                table_.heading = fields_of(line);
                table_.values.resize(begin);
                return;
            }
            table_.values.push_back(value);
        }
        take_row(table_.values.size() - begin);
    }

    /// The last `count` values are a row, or a claim of how many rows follow.
    void take_row(std::size_t count) {
        if (count == 0) return;                                        // separators alone
        const bool may_claim = table_.columns == 0 || table_.claimed;  // PTS files of several scans repeat it
        const double value = table_.values.back();
        const bool whole = value >= 0 && value < 0x1p32 && value == std::floor(value);
        if (count == 1 && may_claim && whole) {
            if (table_.columns == 0 && table_.claimed) too_few(count);
            table_.claimed = table_.claimed.value_or(0) + static_cast<std::int64_t>(value);
            table_.values.pop_back();
        } else if (table_.columns == 0) {
            if (count < 3) too_few(count);
            table_.columns = count;
        } else if (count != table_.columns) {
            fail(source_, lines_.where(),
                 counted(count, "number") + " where the rows above have " + std::to_string(table_.columns));
        }
    }

    [[noreturn]] void too_few(std::size_t count) const {
        fail(source_, lines_.where(), "a row of " + counted(count, "number") + " is no point x y z",
             "check what kind of file this is");
    }

    const Source& source_;
    Lines lines_;
    Table table_;
    bool heading_line_ = false;
};

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// The column of any of these names, in capitals or not.
std::size_t find(const std::vector<std::string>& names, std::initializer_list<std::string_view> spellings) {
    for (std::size_t c = 0; c < names.size(); ++c) {
        if (std::find(spellings.begin(), spellings.end(), lower(names[c])) != spellings.end()) return c;
    }
    return none;
}

std::vector<std::size_t> find_coordinates(const std::vector<std::string>& names) {
    return {find(names, {"x"}), find(names, {"y"}), find(names, {"z"})};
}

bool complete(const std::vector<std::size_t>& columns) {
    return std::find(columns.begin(), columns.end(), none) == columns.end();
}

/// The names of the columns as the file gives them; empty where its heading is none, or no whole one.
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names = table.heading;
    for (std::string& word : names) {
        if (word.size() > 2 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
    }
    const bool distinct = std::set<std::string>(names.begin(), names.end()).size() == names.size();
    if (names.size() != table.columns || !distinct || !complete(find_coordinates(names))) names.clear();
    return names;
}

/// Three columns are normals where every row is 0 0 0, not a number, or of length 1 (|n|² within 2 %); one must be so.
bool are_normals(const Table& table, std::size_t c) {
    bool any = false;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double x = table.at(i, c), y = table.at(i, c + 1), z = table.at(i, c + 2);
        const double squared = x * x + y * y + z * z;
        if (std::abs(squared - 1) <= 0.02)
            any = true;
        else if (squared != 0 && !std::isnan(squared))
            return false;
    }
    return any;
}

/// Whether columns hold whole numbers from 0 to 255 alone.
bool are_bytes(const Table& table, std::size_t c, std::size_t columns) {
    for (std::size_t i = 0; i < table.rows(); ++i) {
        for (std::size_t k = c; k < c + columns; ++k) {
            const double v = table.at(i, k);
            if (!(v >= 0 && v <= 255 && v == std::floor(v))) return false;
        }
    }
    return true;
}

bool is_constant(const Table& table, std::size_t c, double value) {
    for (std::size_t i = 0; i < table.rows(); ++i) {
        if (table.at(i, c) != value) return false;
    }
    return true;
}

/// Three columns are colours where they hold bytes, not all 0: some programs write zeros where normals should be.
bool are_colors(const Table& table, std::size_t c) {
    const bool zero = is_constant(table, c, 0) && is_constant(table, c + 1, 0) && is_constant(table, c + 2, 0);
    return !zero && are_bytes(table, c, 3);
}

/// What columns without names hold, by their number and values.
std::vector<std::string> guess_names(const Table& table) {
    std::vector<std::string> names = {"x", "y", "z"};
    const auto add = [&](std::initializer_list<const char*> more) {
        names.insert(names.end(), more.begin(), more.end());
    };
    if (table.columns == 4) add({"intensity"});
    if (table.columns == 7) {
        if (are_bytes(table, 3, 3) && is_constant(table, 6, 255))
            add({"red", "green", "blue", "alpha"});
        else if (are_bytes(table, 4, 3))
            add({"intensity", "red", "green", "blue"});  // PTS
    }
    bool normals = false, colors = false;
    while (names.size() < table.columns) {
        const std::size_t c = names.size();
        if (!normals && c + 3 <= table.columns && are_normals(table, c)) {
            normals = true;
            add({"nx", "ny", "nz"});
        } else if (!colors && c + 3 <= table.columns && are_colors(table, c)) {
            colors = true;
            add({"red", "green", "blue"});
        } else {
            names.push_back("scalar_" + std::to_string(c));
        }
    }
    return names;
}

/// Columns to their places in the geometry, by name.
class Columns {
  public:
    Columns(Table&& table, std::vector<std::string>&& names) : table_(std::move(table)), names_(std::move(names)) {}

    void move_to(Geometry& geometry) {
        const std::vector<std::size_t> xyz = find_coordinates(names_);
        take_normals(geometry);
        take_colors(geometry);
        for (const std::size_t c : xyz) names_[c].clear();
        for (std::size_t c = 0; c < names_.size(); ++c) {
            if (names_[c].empty()) continue;
            geometry.vertex_properties.push_back(make_property(names_[c], table_.column(c), Type::float64));
        }
        const bool bare = table_.columns == 3 && xyz == std::vector<std::size_t>{0, 1, 2};
        geometry.vertices = bare ? std::move(table_.values) : rows_of(xyz);
    }

  private:
    std::vector<double> rows_of(const std::vector<std::size_t>& columns) const {
        std::vector<double> out;
        out.reserve(table_.rows() * columns.size());
        for (std::size_t i = 0; i < table_.rows(); ++i) {
            for (const std::size_t c : columns) out.push_back(table_.at(i, c));
        }
        return out;
    }

    void take_normals(Geometry& geometry) {
        const std::vector<std::size_t> at = {find(names_, {"nx", "normal_x", "normalx"}),
                                             find(names_, {"ny", "normal_y", "normaly"}),
                                             find(names_, {"nz", "normal_z", "normalz"})};
        if (!complete(at)) return;
        geometry.normals = rows_of(at);
        for (const std::size_t c : at) names_[c].clear();
    }

    /// Whole numbers to 255, or fractions; columns of these names with other values stay plain numbers.
    void take_colors(Geometry& geometry) {
        std::vector<std::size_t> at = {find(names_, {"red", "r"}), find(names_, {"green", "g"}),
                                       find(names_, {"blue", "b"})};
        if (!complete(at)) return;
        if (const std::size_t alpha = find(names_, {"alpha", "a"}); alpha != none) at.push_back(alpha);
        const bool whole = std::all_of(at.begin(), at.end(), [&](std::size_t c) { return are_bytes(table_, c, 1); });
        const std::vector<double> values = rows_of(at);
        const bool fractions = std::all_of(values.begin(), values.end(), [](double v) { return v >= 0 && v <= 1; });
        if (!whole && !fractions) return;
        add_colors(geometry, geometry.vertex_properties, values, at.size(), !whole);
        for (const std::size_t c : at) names_[c].clear();
    }

    Table table_;
    std::vector<std::string> names_;  // emptied as they are taken
};

}  // namespace

Geometry read_xyz(const Source& source) {
    Table table = TableReader(source).read();
    Geometry geometry;
    geometry.normal_type = Type::float64;
    if (table.claimed && static_cast<std::size_t>(*table.claimed) != table.rows()) {
        geometry.notes.push_back("the file claims " + std::to_string(*table.claimed) + " points but holds " +
                                 std::to_string(table.rows()));
    }
    if (table.columns == 0) return geometry;
    std::vector<std::string> names = names_of(table);
    if (names.empty()) names = guess_names(table);
    Columns(std::move(table), std::move(names)).move_to(geometry);
    return geometry;
}

std::string write_xyz(const Geometry& geometry, const WriteOptions&) {
    const Type type = geometry.vertex_type == Type::float32 ? Type::float32 : Type::float64;
    const Type normal_type = geometry.normal_type == Type::float32 ? Type::float32 : Type::float64;
    const bool normals = !geometry.normals.empty();
    std::string heading = normals ? "# x y z nx ny nz" : "# x y z";
    std::vector<const Property*> scalars;
    for (const Property& p : geometry.vertex_properties) {
        if (p.list) continue;
        scalars.push_back(&p);
        heading += ' ';
        for (const char c : p.name) heading += is_separator(c) ? '_' : c;
    }
    // Bare coordinates need no heading, and some programs read no comments.
    std::string out = normals || !scalars.empty() ? heading + "\n" : "";
    for (std::size_t i = 0; i < geometry.vertex_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            if (c > 0) out += ' ';
            append_number(out, geometry.vertices[3 * i + c], type);
        }
        for (std::size_t c = 0; c < 3 && normals; ++c) {
            out += ' ';
            append_number(out, geometry.normals[3 * i + c], normal_type);
        }
        for (const Property* p : scalars) out += ' ', append_number(out, p->at(i), p->type);
        out += '\n';
    }
    return out;
}

}  // namespace gaussmap::io
