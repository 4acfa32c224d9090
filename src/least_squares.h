// Small dense least squares, rank-revealing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace gaussmap {

/// min |A x − b| by Householder QR with column pivoting (Businger and Golub, "Linear Least Squares Solutions by
/// Householder Transformations", 1965). Rows are stored one after the other, so that the loops over the columns run on
/// vectors without a sum being reordered. The room is kept from one problem to the next.
template <int Unknowns>
class LeastSquares {
  public:
    static constexpr int stride = (Unknowns + 2) / 2 * 2;  ///< the unknowns, the right side, and padding
    using Row = std::array<double, stride>;

    void clear() { rows_.clear(); }
    std::size_t rows() const { return rows_.size(); }
    /// A zeroed row to fill in: the coefficients, then the right side at [Unknowns].
    Row& add() { return rows_.emplace_back(Row{}); }

    /// Solve, destroying the rows. False where some column depends on the others to the tolerance (relative to the
    /// largest column), or there are fewer rows than unknowns.
    bool solve(std::array<double, Unknowns>& x, double tolerance) {
        if (rows_.size() < Unknowns) return false;
        std::array<int, Unknowns> column;  // which unknown each column now stands for
        for (int j = 0; j < Unknowns; ++j) column[j] = j;
        Row norms{};
        for (const Row& row : rows_)
            for (int j = 0; j < stride; ++j) norms[j] += row[j] * row[j];
        double first = 0;
        for (int step = 0; step < Unknowns; ++step) {
            const int pivot =
                static_cast<int>(std::max_element(norms.begin() + step, norms.begin() + Unknowns) - norms.begin());
            if (pivot != step) {
                for (Row& row : rows_) std::swap(row[step], row[pivot]);
                std::swap(norms[step], norms[pivot]);
                std::swap(column[step], column[pivot]);
            }
            const double diagonal = reflect(static_cast<std::size_t>(step));
            if (step == 0) first = std::abs(diagonal);
            if (!(std::abs(diagonal) > tolerance * first)) return false;
            for (int j = step + 1; j < Unknowns; ++j) norms[j] -= rows_[step][j] * rows_[step][j];
        }
        for (int i = Unknowns - 1; i >= 0; --i) {
            double sum = rows_[i][Unknowns];
            for (int j = i + 1; j < Unknowns; ++j) sum -= rows_[i][j] * x[column[j]];
            x[column[i]] = sum / rows_[i][i];
        }
        return true;
    }

  private:
    /// Reflect the rows from `step` on so that their column `step` is left with one entry, the diagonal; return it.
    double reflect(std::size_t step) {
        double norm = 0;
        for (std::size_t i = step; i < rows_.size(); ++i) norm += rows_[i][step] * rows_[i][step];
        norm = std::sqrt(norm);
        const double head = rows_[step][step];
        const double diagonal = head > 0 ? -norm : norm;
        if (norm == 0) return 0;
        // v = column − diagonal e, H = 1 − v vᵀ / (diagonal (diagonal − head)).
        const double scale = 1 / (diagonal * (diagonal - head));
        rows_[step][step] = head - diagonal;
        Row projection{};
        const std::size_t from = step / 2 * 2;
        for (std::size_t i = step; i < rows_.size(); ++i)
            for (std::size_t j = from; j < stride; ++j) projection[j] += rows_[i][step] * rows_[i][j];
        for (double& value : projection) value *= scale;
        for (std::size_t j = 0; j <= step; ++j) projection[j] = 0;
        for (std::size_t i = step; i < rows_.size(); ++i) {
            const double v = rows_[i][step];
            for (std::size_t j = from; j < stride; ++j) rows_[i][j] -= v * projection[j];
        }
        rows_[step][step] = diagonal;
        return diagonal;
    }

    std::vector<Row> rows_;
};

}  // namespace gaussmap
