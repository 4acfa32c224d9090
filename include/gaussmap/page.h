// A page to look at a result: one HTML file that holds the viewer and the data, and needs no server and no network.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// One number a vertex or a face, and how to show it.
struct PageField {
    std::string name;            ///< as a file calls it: "k1"
    std::vector<double> values;  ///< what is not finite is drawn in grey, and counted
    bool of_faces = false;       ///< one a face, not one a vertex
    std::string label;           ///< of the legend, UTF-8; empty: the name
    std::string unit;            ///< "1/unit²"; empty: none
    bool diverging = false;      ///< signed: a map with a light middle at 0, both ends as far from it
    /// An automatic range that ends below this is rounding noise of a plane, and drawn as 0; 0: never.
    double noise = 0;
};

/// A mesh, or a cloud where there are no faces. The views must outlive the call.
struct PageScene {
    std::string name;  ///< UTF-8
    Points vertices;
    Triangles faces;
    Points normals;  ///< one a vertex, of any positive length, or empty
    std::vector<PageField> fields;
};

struct PageOptions {
    std::string title = "gaussmap";
    std::string field;  ///< name of the field shown first; empty: the first
    /// Values of the first and the last colour of the field shown first. NaN: automatic, as `draw` of picture.h does.
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 3> direction = {0, 0, 0};  ///< from the object to the eye at first; zero: as `draw` does
    std::array<double, 3> up = {0, 0, 0};         ///< upward; zero: as `draw` does
    Execution run;
};

/// Append a field by its name: those that gaussmap writes (density, kappa, k1, k2, mean, gaussian, …) know their label,
/// unit, sign and noise; any other is shown as it is.
void add_field(PageScene& scene, std::string name, std::vector<double> values, bool of_faces = false);

/// Whether this build can make pages; if not, what is missing and what to do, in one line. Empty: it can.
std::string page_obstacle();

/// The page of one scene, or of two side by side.
///
/// Values are kept exactly: as float32 where all of them fit in it, else as float64. Coordinates are kept exactly where
/// all fit in float32; others are float32 differences from the middle of the box, which is 6e-8 of its side. Arrays are
/// delta-coded, split into planes of bytes, deflated and written in base64: docs/viewer.md has the format. The same
/// bytes for any number of threads.
///
/// \throw std::invalid_argument on no scene or more than two, arrays of different lengths, an index outside [0, n), two
///        fields of one name and kind, a field or a range that is none, or a scene with nothing to draw.
/// \throw std::runtime_error with `page_obstacle` where the library was built without the viewer or without zlib.
/// Time O(n + m), for clouds O(n log n) to find their spacing; memory about twice that of the arrays.
std::string page_html(const std::vector<PageScene>& scenes, const PageOptions& options = {});

}  // namespace gaussmap
