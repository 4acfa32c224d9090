#include "pictures.h"

namespace cli {

gaussmap::Picture draw_pictures(const Outputs& outputs, const gaussmap::Geometry& geometry, bool mesh,
                                const std::vector<double>& values, const std::vector<double>& normals,
                                gaussmap::PictureOptions options, const Common& common) {
    gaussmap::Picture picture;
    {
        Progress progress("drawing", common.quiet);
        options.run = progress.run(common.threads);
        picture = gaussmap::draw(geometry.vertices, mesh ? gaussmap::Triangles(geometry.faces) : gaussmap::Triangles(),
                                 values, normals, options);
    }
    const std::string bytes = gaussmap::png_bytes(picture);
    for (const std::string& path : outputs.paths)
        if (outputs.is_picture(path)) gaussmap::write_file(path, bytes);
    return picture;
}

}  // namespace cli
