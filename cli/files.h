// Files in and out: what is asked for is checked before any work, what a format cannot hold is said.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "commandline.h"
#include "console.h"
#include "gaussmap/io.h"

namespace cli {

/// Where results go, and how.
struct Outputs {
    std::vector<std::string> paths;
    std::string format_name = "ply";  ///< of standard output
    bool ascii = false;

    /// Declare -o, --format and --ascii.
    void declare(CommandLine& line, bool required);
    /// Everything that can be wrong before the work: an unknown extension, a folder that is not there, a name twice,
    /// standard output wanted twice. \throw Failure
    void check(const CommandLine& line) const;
    /// \throw Failure where a format cannot hold such a geometry at all: it takes faces alone, and there are none.
    void check_fit(const gaussmap::Geometry& geometry) const;
    /// Write all of them. \throw std::runtime_error with the system's reason
    void write(const gaussmap::Geometry& geometry) const;
    /// One sentence for each output that cannot hold all of the geometry.
    std::vector<std::string> losses(const gaussmap::Geometry& geometry) const;

  private:
    gaussmap::Format format(const std::string& path) const;
};

/// Read the input, with a bar.
gaussmap::Geometry read_input(const std::string& path, const Common& common);

/// `--as`: is the geometry taken as a mesh? \throw Failure (bad input) where it has no points, or no faces and a mesh
/// is wanted.
bool taken_as_mesh(const std::string& as, const gaussmap::Geometry& geometry, const std::string& path);

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
