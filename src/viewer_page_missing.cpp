// In place of the viewer where there is no node to build it with.
#include "viewer_page.h"

namespace gaussmap {

std::string_view viewer_page() {
    return {};
}

}  // namespace gaussmap
