// The viewer, one HTML file made by npm from viewer/; the build puts it into the library.
#pragma once

#include <string_view>

namespace gaussmap {

/// The page without data, with `viewer_mark` where they go; empty where it was built without node.
std::string_view viewer_page();

constexpr std::string_view viewer_mark = "<!--gaussmap-data-->";

}  // namespace gaussmap
