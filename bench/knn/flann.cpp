// FLANN as PCL's KdTreeFLANN calls it: one exact tree with leaves of 15 points, one query a call.
#include <flann/flann.hpp>

#include "peers.h"

Rows flann_rows(const std::vector<double>& points, std::size_t k, int threads) {
    const std::size_t count = points.size() / 3;
    double* const data = const_cast<double*>(points.data());  // read only
    flann::Index<flann::L2_Simple<double>> tree({data, count, 3}, flann::KDTreeSingleIndexParams(15));
    tree.buildIndex();
    Rows rows(count * k);
    share(count, threads, [&](std::size_t i, std::size_t end) {
        std::vector<int> index(k);
        std::vector<double> distance(k);
        flann::Matrix<int> indices(index.data(), 1, k);
        flann::Matrix<double> distances(distance.data(), 1, k);
        const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED, 0, true);
        for (; i < end; ++i) {
            tree.knnSearch({data + 3 * i, 1, 3}, indices, distances, k, exact);
            std::copy(index.begin(), index.end(), rows.data() + i * k);
        }
    });
    return rows;
}
