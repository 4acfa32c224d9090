// Any bytes as a file of any format: a whole geometry or a FormatError, memory in proportion to the bytes, and what was
// read can be written to PLY and read back. The first byte picks the format.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gaussmap/io.h"

using namespace gaussmap;

namespace {

/// Bytes that a geometry keeps.
std::size_t size_in_memory(const Geometry& g) {
    std::size_t size = 8 * (g.vertices.size() + g.normals.size() + g.polygons.offsets.size());
    size += 4 * (g.faces.size() + g.polygons.corners.size() + g.polygon_of.size() + g.polygon_corner.size());
    const auto add = [&](const std::vector<Property>& properties) {
        for (const Property& p : properties) size += p.bytes.size() + 8 * p.offsets.size();
    };
    add(g.vertex_properties);
    add(g.face_properties);
    for (const Element& element : g.elements) add(element.properties);
    return size;
}

void require(bool condition) {
    if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const auto format = static_cast<Format>(data[0] % 7);
    const std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
    Geometry geometry;
    try {
        geometry = read_bytes(bytes, "fuzz", format, {1, {}});
    } catch (const FormatError&) { return 0; }
    require(size_in_memory(geometry) <= 128 * bytes.size() + 4096);
    for (const bool ascii : {false, true}) {
        const Geometry again =
            read_bytes(write_bytes(geometry, {Format::ply, ascii, false}), "again.ply", Format::ply, {1, {}});
        require(again.vertices.size() == geometry.vertices.size() && again.faces == geometry.faces);
    }
    weld(geometry);
    triangulate(geometry);
    return 0;
}
