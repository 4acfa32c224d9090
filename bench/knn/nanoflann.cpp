#include <nanoflann.hpp>

#include "peers.h"

namespace {

struct Adaptor {
    const double* xyz;
    std::size_t count;

    std::size_t kdtree_get_point_count() const { return count; }
    double kdtree_get_pt(std::size_t i, std::size_t c) const { return xyz[3 * i + c]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Adaptor>, Adaptor, 3, std::uint32_t>;

}  // namespace

Rows nanoflann_rows(const std::vector<double>& points, std::size_t k, int threads) {
    const Adaptor adaptor{points.data(), points.size() / 3};
    Tree tree(3, adaptor, {10});
    tree.buildIndex();
    Rows rows(adaptor.count * k);
    share(adaptor.count, threads, [&](std::size_t i, std::size_t end) {
        std::vector<std::uint32_t> index(k);
        std::vector<double> distance(k);
        for (; i < end; ++i) {
            tree.knnSearch(points.data() + 3 * i, k, index.data(), distance.data());
            std::copy(index.begin(), index.end(), rows.data() + i * k);
        }
    });
    return rows;
}
