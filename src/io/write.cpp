// Which writer a geometry goes to.
#include "io/formats.h"
#include "io/types.h"

namespace gaussmap {

std::string write_bytes(const Geometry& geometry, const WriteOptions& options) {
    io::check(geometry);
    if (options.triangles && !geometry.polygons.empty()) return write_bytes(triangulate(geometry), options);
    switch (options.format) {
        case Format::ply:
            return io::write_ply(geometry, options);
        case Format::obj:
            return io::write_obj(geometry, options);
        case Format::off:
            return io::write_off(geometry, options);
        case Format::stl:
            return io::write_stl(geometry, options);
        case Format::xyz:
            return io::write_xyz(geometry, options);
        case Format::pcd:
            return io::write_pcd(geometry, options);
        case Format::detect:
            break;
    }
    throw std::invalid_argument("write_bytes: the format is not given");
}

void write(const std::string& path, const Geometry& geometry, const WriteOptions& options) {
    WriteOptions chosen = options;
    if (chosen.format == Format::detect) chosen.format = format_of(path);
    if (chosen.format == Format::detect) {
        throw std::invalid_argument(
            path + ": the name does not tell the format; give the format, or an extension among " + known_extensions());
    }
    write_file(path, write_bytes(geometry, chosen));
}

}  // namespace gaussmap
