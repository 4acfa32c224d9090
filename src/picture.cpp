#include "gaussmap/picture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arguments.h"
#include "camera.h"
#include "check.h"
#include "colormap.h"
#include "disc_radii.h"
#include "drawn_box.h"
#include "gaussmap/normals.h"
#include "legend.h"
#include "normalize.h"
#include "parallel.h"
#include "percentile.h"
#include "rasterizer.h"

namespace gaussmap {
namespace {

void check(Points vertices, Triangles faces, const std::vector<double>& values, Points normals,
           const PictureOptions& o) {
    for (const auto& [name, size] : {std::pair("width", o.width), std::pair("height", o.height)})
        require(size >= 16 && size <= 16384, "draw", name, size, "be between 16 and 16384");
    require(o.views == 1 || o.views == 4, "draw", "views", o.views, "be 1 or 4");
    if (std::isinf(o.low) || std::isinf(o.high) || o.low >= o.high)
        throw std::invalid_argument("draw: a range from low = " + shown(o.low) + " to high = " + shown(o.high) +
                                    "; low must be less than high, and both finite (or NaN: automatic)");
    if (vertices.empty()) throw std::invalid_argument("nothing to draw: there are no vertices");
    check_count("values", values.size(), vertices.count, "vertices");
    if (!normals.empty()) check_count("normals", normals.count, vertices.count, "vertices");
    check_faces(faces, vertices.count);
}

/// Of what is drawn: discs with their radii, however they are turned; of meshes there are none.
Extent extent_of(Points vertices, Triangles faces, const std::vector<double>& radii, const View& view, Vec3 centre) {
    constexpr double far = std::numeric_limits<double>::infinity();
    Extent e = {far, -far, far, -far};
    const auto take = [&](Vec3 p, double radius) {
        const double x = dot(view.right, p - centre), y = dot(view.up, p - centre);
        e.left = std::min(e.left, x - radius), e.right = std::max(e.right, x + radius);
        e.bottom = std::min(e.bottom, y - radius), e.top = std::max(e.top, y + radius);
    };
    if (radii.empty()) for_drawn(vertices, faces, [&](Vec3 p) { take(p, 0); });
    for (std::size_t v = 0; v < radii.size(); ++v)
        if (const Vec3 p = load(vertices[v]); finite(p)) take(p, radii[v]);
    return e;
}

/// Sets picture.low, high and undefined.
Legend choose_range(Picture& picture, const std::vector<double>& values, double diagonal, const PictureOptions& o) {
    std::vector<double> defined;
    for (const double value : values)
        if (std::isfinite(value)) defined.push_back(value);
    picture.undefined = values.size() - defined.size();
    double least = 0, most = 0, low = o.low, high = o.high;
    if (!defined.empty()) {
        const auto [first, last] = std::minmax_element(defined.begin(), defined.end());
        least = *first, most = *last;
        const double last_of_most = percentile(defined, 0.98), first_of_most = percentile(defined, 0.02);
        const double reach = std::max(std::abs(first_of_most), std::abs(last_of_most));
        const double below = o.diverging ? -reach : first_of_most, above = o.diverging ? reach : last_of_most;
        if (std::isnan(high)) high = o.diverging && most <= 0 ? 0 : above;
        if (std::isnan(low)) low = least < 0 ? below : 0;
    }
    if (std::isnan(low)) low = 0;
    const double square = diagonal > 0 ? 1 / (diagonal * diagonal) : 1;
    const bool noise = o.density && std::isnan(o.high) && std::isnan(o.low) && high < 1e-9 * square;
    if (noise || !(high > low)) {
        // Nothing varies. A flat object keeps a scale that belongs to its size.
        if (noise) low = 0;
        high = low + (o.density && std::isfinite(square) ? square : 1);
        if (!(high > low)) high = std::nextafter(low, std::numeric_limits<double>::infinity());
    }
    picture.low = low, picture.high = high;
    const double slack = 1e-6 * (high - low);  // a constant value's rounding is not beyond the range
    return {o.label,           o.unit,        low,        high, least<low - slack, most> high + slack,
            picture.undefined, values.size(), o.diverging};
}

std::vector<Viewport> viewports_of(const PictureOptions& o, int legend) {
    const int height = o.height - legend;
    if (o.views == 1) return {{0, 0, o.width, height}};
    const int w = o.width / 2, h = height / 2;
    return {{0, 0, w, h}, {w, 0, o.width - w, h}, {0, h, w, height - h}, {w, h, o.width - w, height - h}};
}

std::vector<double> unit_normals(Points vertices, Triangles faces, Points normals, const Execution& run) {
    if (normals.empty() && !faces.empty()) return mesh_normals(vertices, faces, NormalWeights::max, run);
    std::vector<double> unit(normals.xyz, normals.xyz + 3 * normals.count);
    normalize(unit, run);
    return unit;
}

}  // namespace

Picture draw(Points vertices, Triangles faces, const std::vector<double>& values, Points normals,
             const PictureOptions& options) {
    check(vertices, faces, values, normals, options);
    const Box box = box_of(vertices, faces);
    Picture picture;
    picture.width = options.width, picture.height = options.height;
    picture.rgb.assign(3 * static_cast<std::size_t>(options.width) * options.height, 255);
    const Legend legend = choose_range(picture, values, box.diagonal(), options);
    const bool labelled = !options.label.empty();
    const std::vector<Viewport> viewports =
        viewports_of(options, labelled ? legend_height(options.width, options.height) : 0);

    const std::vector<double> unit = unit_normals(vertices, faces, normals, {options.run.threads, {}});
    std::vector<double> radii;
    if (faces.empty()) radii = disc_radii(vertices, part_of(options.run, 0, 0.5));
    const bool one_place = faces.empty() && box.diagonal() == 0;

    const std::vector<View> views = views_of(box.sides, options);
    std::vector<Extent> extents;
    extents.reserve(views.size());
    const std::vector<double> none;
    for (const View& view : views)
        extents.push_back(extent_of(vertices, faces, one_place ? none : radii, view, box.centre));
    const std::vector<Projection> projections = fit(views, extents, box.centre, viewports);
    // A single point has no scale: its disc fills a tenth of the picture.
    if (one_place)
        for (double& radius : radii) radius *= 0.05 * std::min(viewports[0].width, viewports[0].height);

    const Ramp ramp(picture.low, picture.high, options.diverging);
    const Scene scene = {vertices, faces, values, unit, radii};
    const double begin = faces.empty() ? 0.5 : 0, share = (1 - begin) / static_cast<double>(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        const double from = begin + share * static_cast<double>(i);
        render(scene, ramp, projections[i], viewports[i], picture, part_of(options.run, from, from + share));
    }
    if (labelled) draw_legend(picture, legend);
    return picture;
}

}  // namespace gaussmap
