#include "box_tree.h"

namespace gaussmap {

std::vector<Boxes> join(const std::vector<Boxes>& below) {
    std::vector<Boxes> level((below.size() + children - 1) / children, no_boxes());
    for (std::size_t i = 0; i < below.size(); ++i) {
        Boxes& boxes = level[i / children];
        const std::size_t c = i % children;
        for (int a = 0; a < 3; ++a) {
            boxes.low[a][c] = *std::min_element(below[i].low[a], below[i].low[a] + children);
            boxes.high[a][c] = *std::max_element(below[i].high[a], below[i].high[a] + children);
        }
        boxes.first[c] = *std::min_element(below[i].first, below[i].first + children);
    }
    return level;
}

void part(Entry* first, Entry* last, std::ptrdiff_t run) {
    const std::ptrdiff_t runs = (last - first + run - 1) / run;
    if (runs < 2) return;
    Entry* const middle = first + (runs + 1) / 2 * run;
    double extent[3];
    for (int a = 0; a < 3; ++a) {
        double low = first->p[a], high = low;
        for (const Entry* e = first; e != last; ++e) low = std::min(low, e->p[a]), high = std::max(high, e->p[a]);
        extent[a] = high - low;
    }
    const auto widest = std::max_element(extent, extent + 3) - extent;
    std::nth_element(first, middle, last,
                     [widest](const Entry& a, const Entry& b) { return a.p[widest] < b.p[widest]; });
    part(first, middle, run);
    part(middle, last, run);
}

}  // namespace gaussmap
