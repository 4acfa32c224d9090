// Pictures of a value on a surface, drawn by the library itself: no display, no graphics driver.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// What was drawn, and what its colours mean.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< 3 a pixel, sRGB, rows from the top
    double low = 0, high = 0;       ///< values of the first and the last colour
    std::size_t undefined = 0;      ///< values that are not finite, drawn in grey
};

struct PictureOptions {
    int width = 1600, height = 1200;  ///< pixels, 16 to 16384
    int views = 1;                    ///< 1, or 4: a contact sheet of quarter turns about the upward direction
    /// From the object to the eye, of any length; zero: a three-quarter view along the shortest side of the box.
    std::array<double, 3> direction = {0, 0, 0};
    /// Upward on the picture; zero: +z, or +y for what is shortest along z.
    std::array<double, 3> up = {0, 0, 0};
    /// The values have a sign: blue below 0, red above, light at 0 (`diverging_color_at`), both ends as far from it.
    bool diverging = false;
    /// Values of the first and the last colour. NaN: low is 0 (the 2nd percentile where there are negative values),
    /// high the 98th percentile; diverging, ± the greater of the two, and 0 on a side where there is nothing.
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
    /// The values are curvature densities, 1/length²: an automatic range that ends below 1e-9 / diagonal² is rounding
    /// noise of a plane, and drawn as 0.
    bool density = true;
    std::string label = "total curvature k1² + k2²";  ///< of the legend, UTF-8; empty: no legend
    std::string unit = "1/unit²";                     ///< behind the label, in brackets; empty: none
    Execution run;
};

/// Draw a mesh, or a cloud where there are no faces, coloured by one value a vertex. Orthographic.
///
/// A mesh is shaded by smooth normals, by those of its faces at creases. Points are discs as large as the spacing
/// around them, turned along their normals where given. Values are interpolated, then coloured; what is not finite is
/// grey. Pictures less than 200 pixels wide or high have no legend.
///
/// \param vertices  n points; those not finite, and the faces that use them, are left out.
/// \param values    n values.
/// \param normals   n vectors of any positive length and either sign, or empty: a mesh's own, none for a cloud.
/// \throw std::invalid_argument on arrays of different lengths, an index outside [0, n), an option out of its range, a
///        range that is empty, or nothing to draw.
/// Time O(n + m) and the pixels covered, for clouds O(n log n); memory 100 bytes a vertex and 4 a face.
Picture draw(Points vertices, Triangles faces, const std::vector<double>& values, Points normals = {},
             const PictureOptions& options = {});

/// The picture as a PNG file, the same bytes for the same pixels.
/// \throw std::invalid_argument where rgb is not width × height × 3 bytes, or there are none.
/// \throw std::runtime_error where the library was built without libspng.
std::string png_bytes(const Picture& picture);

/// The colour map, sRGB: dark violet through teal to bright yellow over [0, 1], the ends outside it, grey for NaN.
/// Lightness grows evenly, so it survives grey printing and colour blindness.
std::array<std::uint8_t, 3> color_at(double value);

/// The same for signed values in [−1, 1]: blue, light grey at 0, red; as dark on either side.
std::array<std::uint8_t, 3> diverging_color_at(double value);

}  // namespace gaussmap
