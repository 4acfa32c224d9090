#include <cstddef>

#include "peers.h"

void triad(std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c, double s) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = b[i] + s * c[i];
}
