#include "grid.h"

#include <limits>
#include <stdexcept>
#include <string>

#include "arguments.h"

namespace gaussmap {

void check_grid(const char* function, const Grid& grid) {
    require(grid.around >= 3, function, "around", grid.around, "be at least 3");
    require(grid.across >= 3, function, "across", grid.across, "be at least 3");
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    if (static_cast<std::int64_t>(grid.around) * grid.across > most)
        throw std::invalid_argument(std::string(function) + ": around × across = " + shown(grid.around) + " × " +
                                    shown(grid.across) + " vertices must be at most " + shown(most));
}

std::vector<std::int32_t> grid_faces(const Grid& grid) {
    const int rows = grid.closed_around ? grid.around : grid.around - 1;
    const int columns = grid.closed_across ? grid.across : grid.across - 1;
    std::vector<std::int32_t> faces;
    faces.reserve(6 * static_cast<std::size_t>(rows) * columns);
    for (int i = 0; i < rows; ++i) {
        const std::int32_t row = i * grid.across, next_row = (i + 1) % grid.around * grid.across;
        for (int j = 0; j < columns; ++j) {
            const int next = (j + 1) % grid.across;
            const std::int32_t corner = row + j, right = next_row + j, opposite = next_row + next, up = row + next;
            faces.insert(faces.end(), {right, opposite, corner, corner, opposite, up});
        }
    }
    return faces;
}

}  // namespace gaussmap
