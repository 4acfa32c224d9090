#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include "peers.h"

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Item = std::pair<Kernel::Point_3, std::int32_t>;
using Traits = CGAL::Search_traits_adapter<Item, CGAL::First_of_pair_property_map<Item>, CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;

}  // namespace

Rows cgal_rows(const std::vector<double>& points, std::size_t k, int threads) {
    std::vector<Item> items;
    for (std::size_t i = 0; i < points.size() / 3; ++i)
        items.push_back({{points[3 * i], points[3 * i + 1], points[3 * i + 2]}, static_cast<std::int32_t>(i)});
    Search::Tree tree(items.begin(), items.end());
    tree.build();
    Rows rows(items.size() * k);
    share(items.size(), threads, [&](std::size_t i, std::size_t end) {
        for (; i < end; ++i) {
            const Search search(tree, items[i].first, static_cast<unsigned>(k));
            std::size_t j = i * k;
            for (const auto& [item, distance] : search) rows[j++] = item.second;
        }
    });
    return rows;
}
