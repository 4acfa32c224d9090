// Files in and out: PLY, OBJ, OFF, STL, XYZ/PWN/PTS text, PCD.
//
// Reading never allocates more than the size of the file justifies, and ends in a whole result or one FormatError.
// Writing goes beside the destination and renames when whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// A file that cannot be read, in one line: "FILE: where: what is wrong; what to do".
struct FormatError : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

enum class Format { detect, ply, obj, off, stl, xyz, pcd };
enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Bytes of one value.
std::size_t size_of(Type type);

/// One named value, or list of values, for each item of an element; the bytes are native-endian values of `type`.
struct Property {
    std::string name;
    Type type = Type::float32;
    bool list = false;
    Type count_type = Type::uint8;  ///< of a list's length in PLY
    std::vector<std::byte> bytes;
    std::vector<std::uint64_t> offsets;  ///< lists: item i holds values offsets[i] … offsets[i+1] − 1

    std::size_t values() const { return bytes.size() / size_of(type); }
    /// Value i of the property as double.
    double at(std::size_t i) const;
    /// All values as double.
    std::vector<double> as_double() const;
};

/// A scalar property made from doubles, stored as `type` (rounded to float32, or to the nearest integer).
Property make_property(std::string name, const std::vector<double>& values, Type type = Type::float32);

/// An element of a PLY file that is neither vertices nor faces; carried from PLY to PLY.
struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

/// The faces as the file had them, kept only where one of them is no triangle.
struct Polygons {
    std::vector<std::uint64_t> offsets;  ///< count + 1
    std::vector<std::int32_t>
        corners;  ///< vertex indices of polygon i: corners[offsets[i]] … corners[offsets[i+1] − 1]

    std::size_t count() const { return offsets.empty() ? 0 : offsets.size() - 1; }
    bool empty() const { return offsets.empty(); }
};

/// What a file holds.
struct Geometry {
    std::vector<double> vertices;      ///< 3 a vertex
    std::vector<std::int32_t> faces;   ///< 3 a triangle; empty: a cloud
    std::vector<double> normals;       ///< 3 a vertex as the file gave them, or empty
    Type vertex_type = Type::float64;  ///< of the coordinates in the file, and of those written
    Type normal_type = Type::float32;

    /// Other vertex properties by name: red green blue alpha (uint8), intensity, quality, … One value (or list) a
    /// vertex.
    std::vector<Property> vertex_properties;
    /// Other face properties: one a triangle, or one a polygon where `polygons` is kept. Texture coordinates of
    /// corners are the list `texcoord` (u v a corner), MeshLab's convention.
    std::vector<Property> face_properties;

    Polygons polygons;
    std::vector<std::int32_t> polygon_of;      ///< with polygons: triangle → polygon
    std::vector<std::int32_t> polygon_corner;  ///< with polygons: 3 a triangle, the corners within that polygon

    std::vector<Element> elements;      ///< further PLY elements
    std::vector<std::string> comments;  ///< PLY comments; those that begin with "obj_info " are its obj_info lines
    std::size_t width = 0;              ///< points a row of an organised PCD; 0: unorganised
    Format format = Format::detect;     ///< of the file it was read from, as its content told
    std::vector<std::string>
        notes;  ///< what reading had to do, each a sentence for a person ("3 faces of fewer than 3 corners left out")

    std::size_t vertex_count() const { return vertices.size() / 3; }
    std::size_t face_count() const { return faces.size() / 3; }
    const Property* vertex_property(std::string_view name) const;
};

/// The format of a file name ("x.PLY" → ply), or Format::detect where the extension is none of ours.
Format format_of(std::string_view path);

/// Names of the extensions that can be read and written, for messages: ".ply, .obj, …".
std::string known_extensions();

/// Read a file. Format::detect goes by the content first, then by the extension. "-" is standard input.
/// \throw FormatError  the file does not exist, is empty, is of no known format, is cut short, or is malformed.
Geometry read(const std::string& path, Format format = Format::detect, const Execution& run = {});

/// Read bytes already in memory; `name` is what messages call them (its extension helps to detect text formats).
Geometry read_bytes(std::string_view bytes, const std::string& name, Format format = Format::detect,
                    const Execution& run = {});

struct WriteOptions {
    Format format = Format::detect;  ///< by the extension
    bool ascii = false;              ///< text where the format has both
    bool triangles = false;          ///< write the triangles even where the polygons are known
};

/// Write a file: beside `path` first, renamed when whole, so a crash leaves the old file or none. "-" is standard
/// output (the format must then be given). What the format cannot hold is left out.
/// \throw std::invalid_argument  unknown extension. \throw std::runtime_error  the system's reason, with the path.
void write(const std::string& path, const Geometry& geometry, const WriteOptions& options = {});

/// The bytes `write` would put into the file.
std::string write_bytes(const Geometry& geometry, const WriteOptions& options);

/// Write any bytes atomically ("-": standard output). \throw std::runtime_error with the path and the system's reason.
void write_file(const std::string& path, std::string_view bytes);

/// For a program's handler of SIGINT or SIGTERM (async-signal-safe): remove the temporary file of a `write` under way.
void remove_unfinished() noexcept;

/// Vertices at exactly the same position become one (the first); faces follow, properties of the first are kept.
/// Triangles that lose a corner are dropped with their properties. The number merged is added to `notes`.
Geometry weld(const Geometry& geometry);

/// The triangles as the faces: polygons forgotten, face properties repeated for each triangle of a polygon
/// (`texcoord` lists cut to its corners).
Geometry triangulate(const Geometry& geometry);

}  // namespace gaussmap
