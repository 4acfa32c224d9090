// Files in and out: what is asked for is checked before any work, what a format cannot hold is said.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "commandline.h"
#include "console.h"
#include "gaussmap/io.h"
#include "report.h"

namespace cli {

/// Where results go, and how.
struct Outputs {
    std::vector<std::string> paths;
    std::string format_name = "ply";  ///< of standard output
    bool ascii = false;
    bool geometries = true;  ///< the verb writes meshes and clouds
    bool pictures = false;   ///< the verb draws .png
    bool pages = false;      ///< the verb makes .html

    /// Declare -o, and --format and --ascii where they mean something.
    void declare(CommandLine& line, bool required);
    /// Everything that can be wrong before the work: an unknown extension, a folder that is not there, a name twice,
    /// standard output wanted twice, a page where the program was built without the viewer. \throw Failure
    void check(const CommandLine& line) const;
    /// \throw Failure where a format cannot hold such a geometry at all: it takes faces alone, and there are none.
    void check_fit(const gaussmap::Geometry& geometry) const;
    /// Is this output a picture? Standard output is one for a verb that only draws.
    bool is_picture(const std::string& path) const;
    bool is_page(const std::string& path) const;
    bool is_geometry(const std::string& path) const { return !is_picture(path) && !is_page(path); }
    bool any_picture() const;
    bool any_page() const;
    bool any_geometry() const;
    /// Write all that are neither pictures nor pages. \throw std::runtime_error with the system's reason
    void write(const gaussmap::Geometry& geometry) const;
    /// One sentence for each output that cannot hold all of the geometry.
    std::vector<std::string> losses(const gaussmap::Geometry& geometry) const;

  private:
    gaussmap::Format format(const std::string& path) const;
};

/// The last keys of a report on a geometry that was written: peak_bytes, outputs, and the notes of the geometry and of
/// what the formats lost.
void report_written(Json& report, const Outputs& outputs, const gaussmap::Geometry& written);

/// Read the input, with a bar.
gaussmap::Geometry read_input(const std::string& path, const Common& common);

/// `--as`: is the geometry taken as a mesh? \throw Failure (bad input) where it has no points, or no faces and a mesh
/// is wanted.
bool taken_as_mesh(const std::string& as, const gaussmap::Geometry& geometry, const std::string& path);

/// Has it a normal that is usable: finite and not zero?
bool has_normals(const gaussmap::Geometry& geometry);

/// The property of one number a vertex of that name; `purpose` ends the complaint: "to compare with".
/// \throw Failure (bad input) where there is none such.
const gaussmap::Property& vertex_property(const gaussmap::Geometry& geometry, const std::string& name,
                                          const std::string& path, const char* purpose);

/// Replace the property of that name, or add it.
void set_property(std::vector<gaussmap::Property>& properties, gaussmap::Property property);

/// Run `work` on what `file` holds: what it finds wrong with the data ends the run as bad input, naming the file.
template <class Work>
auto concerning(const std::string& file, Work&& work) {
    try {
        return work();
    } catch (const std::invalid_argument& error) { throw Failure(Exit::bad_input, file + ": " + error.what()); }
}

}  // namespace cli
