// What the tests of file formats share: messages of errors, properties by name, and the list of real files.
#pragma once

#include <algorithm>
#include <fstream>
#include <sstream>

#include "gaussmap/io.h"
#include "support.h"

namespace support {

/// The message of the FormatError that reading these bytes ends in; empty where it succeeds.
inline std::string read_error(const std::string& bytes, const std::string& name, gaussmap::Format format) {
    try {
        gaussmap::read_bytes(bytes, name, format);
    } catch (const gaussmap::FormatError& error) { return error.what(); }
    return "";
}

inline std::vector<double> values_of(const std::vector<gaussmap::Property>& properties, const std::string& name) {
    for (const gaussmap::Property& p : properties) {
        if (p.name == name) return p.as_double();
    }
    return {};
}

inline bool has_note(const gaussmap::Geometry& geometry, const std::string& part) {
    return std::any_of(geometry.notes.begin(), geometry.notes.end(),
                       [&](const std::string& note) { return note.find(part) != note.npos; });
}

/// A property of uint8 values.
inline gaussmap::Property bytes_property(const std::string& name, const std::vector<double>& values) {
    return gaussmap::make_property(name, values, gaussmap::Type::uint8);
}

/// A file of the list of real files; vertices or faces −1 where it cannot be read.
struct ListedFile {
    std::string path;
    long vertices = -1, faces = -1;
};

/// The files whose names end in `extension` (lower case), in the order of MANIFEST.tsv.
inline std::vector<ListedFile> listed_files(const std::string& extension) {
    std::vector<ListedFile> files;
    std::ifstream manifest(data_folder() / "MANIFEST.tsv");
    for (std::string line; std::getline(manifest, line);) {
        std::vector<std::string> columns;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, '\t');) columns.push_back(cell);
        if (columns.size() < 6) continue;
        std::string name = columns[0];
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
        if (!name.ends_with(extension)) continue;
        const auto count = [](const std::string& cell) {
            return cell.find_first_not_of("0123456789") == cell.npos && !cell.empty() ? std::stol(cell) : -1;
        };
        files.push_back({columns[0], count(columns[4]), count(columns[5])});
    }
    return files;
}

/// Read every listed file of an extension: those with counts must have them, the others must end in a FormatError that
/// begins with their path. Files named in `refused` are known to the list but malformed: errors too.
/// `dropped`: faces of fewer than three corners that the list counts and reading leaves out.
inline void check_listed(const std::string& extension, const std::vector<std::string>& refused = {},
                         const std::vector<std::pair<std::string, long>>& dropped = {}) {
    const std::vector<ListedFile> files = listed_files(extension);
    ASSERT_FALSE(files.empty());
    for (const ListedFile& file : files) {
        SCOPED_TRACE(file.path);
        const std::string path = (data_folder() / file.path).string();
        const bool bad = std::any_of(refused.begin(), refused.end(),
                                     [&](const std::string& end) { return file.path.ends_with(end); });
        if (file.vertices < 0 || bad) {
            try {
                gaussmap::read(path);
                ADD_FAILURE() << "should not be readable";
            } catch (const gaussmap::FormatError& error) {
                EXPECT_TRUE(std::string(error.what()).starts_with(path + ": ")) << error.what();
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            }
            continue;
        }
        const gaussmap::Geometry geometry = gaussmap::read(path);
        long faces = static_cast<long>(geometry.polygons.empty() ? geometry.face_count() : geometry.polygons.count());
        for (const auto& [end, count] : dropped) faces += file.path.ends_with(end) ? count : 0;
        EXPECT_EQ(static_cast<long>(geometry.vertex_count()), file.vertices);
        EXPECT_EQ(faces, file.faces);
        EXPECT_TRUE(geometry.normals.empty() || geometry.normals.size() == geometry.vertices.size());
    }
}

/// Every beginning of a file is either read or refused by a FormatError: nothing else, whatever the cut.
inline void check_cuts(const std::string& bytes, const std::string& name, gaussmap::Format format) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        try {
            gaussmap::read_bytes(bytes.substr(0, size), name, format);
        } catch (const gaussmap::FormatError& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(name + ": ")) << error.what();
        }
    }
}

/// Bytes changed at random: again read or refused.
inline void check_damage(const std::string& bytes, const std::string& name, gaussmap::Format format,
                         int rounds = 2000) {
    Random random(7);
    for (int round = 0; round < rounds; ++round) {
        std::string damaged = bytes;
        for (std::size_t i = 0; i <= random.below(4); ++i) {
            damaged[random.below(damaged.size())] = static_cast<char>(random.next());
        }
        try {
            gaussmap::read_bytes(damaged, name, format);
        } catch (const gaussmap::FormatError& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(name + ": ")) << error.what();
        }
    }
}

}  // namespace support
