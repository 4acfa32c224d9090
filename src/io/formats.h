// One reader and one writer a format; read.cpp and write.cpp choose among them.
#pragma once

#include <string>
#include <string_view>

#include "gaussmap/io.h"

namespace gaussmap::io {

/// The bytes of a file being read, and what messages call it.
struct Source {
    std::string_view bytes;
    const std::string& name;
    const Execution& run;
};

/// Throw FormatError "NAME: where: what; what to do" (`where` and `advice` may be empty and are then left out).
[[noreturn]] void fail(const Source& source, const std::string& where, const std::string& what,
                       const std::string& advice = "");

Geometry read_ply(const Source& source);
Geometry read_obj(const Source& source);
Geometry read_off(const Source& source);
Geometry read_stl(const Source& source);
Geometry read_xyz(const Source& source);
Geometry read_pcd(const Source& source);

std::string write_ply(const Geometry& geometry, const WriteOptions& options);
std::string write_obj(const Geometry& geometry, const WriteOptions& options);
std::string write_off(const Geometry& geometry, const WriteOptions& options);
std::string write_stl(const Geometry& geometry, const WriteOptions& options);
std::string write_xyz(const Geometry& geometry, const WriteOptions& options);
std::string write_pcd(const Geometry& geometry, const WriteOptions& options);

}  // namespace gaussmap::io
