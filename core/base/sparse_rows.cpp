#include "core/base/sparse_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/OrderingMethods>

#include "core/base/dense_solvers.hpp"
#include "core/base/disjoint_sets.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Rows of a block up to which dense decompositions are taken: some milliseconds.
constexpr Index most_dense_rows = 150;

bool is_small(const SparseRows& rows) {
  return rows.rows() <= most_dense_rows;
}

VectorXd lengths_of(const SparseRows& rows) {
  VectorXd squares = VectorXd::Zero(rows.rows());
  for (Index row = 0; row < rows.rows(); ++row) {
    for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) {
      squares(row) += entry.value() * entry.value();
    }
  }
  return squares.cwiseSqrt();
}

/// @throws SimulationError  if a number is not finite: pivots would have no order
void normalize(SparseRows& rows) {
  const VectorXd lengths = lengths_of(rows);
  if (!lengths.allFinite()) {
    throw SimulationError("the equations of joints and drives have numbers that are not finite");
  }
  for (Index row = 0; row < rows.rows(); ++row) {
    if (lengths(row) == 0.0) continue;
    for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) {
      entry.valueRef() /= lengths(row);
    }
  }
}

/// L D Lᵀ = A Aᵀ of rows of length one; dependent rows have no column in L.
class SparseFactors {
 public:
  explicit SparseFactors(const SparseRows& rows, double threshold = 0.0)
      : lengths_(lengths_of(rows)), rows_(rows) {
    for (double& length : lengths_) {
      if (length == 0.0) length = 1.0;
    }
    normalize(rows_);
    const Eigen::SparseMatrix<double> products = rows_ * SparseRows(rows_.transpose());
    set_order(products);
    factorize(products, std::max(threshold * threshold, smallest_pivot));
  }

  Index rank() const { return rank_; }

  /// Independent rows first; what is left of them.
  std::vector<int> order() const {
    std::vector<int> order;
    for (const bool asked : {true, false}) {
      for (std::size_t k = 0; k < order_.size(); ++k) {
        if (is_independent(k) == asked) order.push_back(order_[k]);
      }
    }
    return order;
  }
  VectorXd pivots() const {
    VectorXd pivots(rank_);
    Index i = 0;
    for (const double pivot : pivots_) {
      if (pivot > 0.0) pivots(i++) = std::sqrt(pivot);
    }
    return pivots;
  }

  VectorXd least_norm(const VectorXd& b) const {
    const VectorXd right = b.cwiseQuotient(lengths_);
    VectorXd x = VectorXd::Zero(rows_.cols());
    for (int i = 0; i < solutions; ++i) x += rows_.transpose() * solve(right - rows_ * x);
    return x;
  }
  VectorXd factors(const VectorXd& b) const {
    VectorXd z = VectorXd::Zero(rows_.rows());
    for (int i = 0; i < solutions; ++i) z += solve(rows_ * (b - rows_.transpose() * z));
    return z.cwiseQuotient(lengths_);
  }

  /// Directions of no meaning, without their shares of rows and of each other.
  MatrixXd normal_space(Index most) const {
    const Index size = rows_.cols();
    MatrixXd space(size, std::min(size - rank_, most));
    for (Index k = 0; k < space.cols(); ++k) {
      VectorXd direction(size);
      for (Index i = 0; i < size; ++i) {
        direction(i) = std::sin(1.0 + 2.3 * double(i) + 0.7 * double(k) * double(i * i % 97));
      }
      for (int i = 0; i < solutions; ++i) {
        direction -= least_norm(lengths_.cwiseProduct(rows_ * direction));
        direction -= space.leftCols(k) * (space.leftCols(k).transpose() * direction);
        direction.normalize();
      }
      space.col(k) = direction;
    }
    return space;
  }

 private:
  /// Of squares of lengths, which are known to round-off.
  static constexpr double smallest_pivot = 1e-13;
  /// The first, and those that refine it.
  static constexpr int solutions = 3;

  bool is_independent(std::size_t k) const { return pivots_[k] > 0.0; }

  void set_order(const Eigen::SparseMatrix<double>& products) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(products, order);
    order_.assign(order.indices().begin(), order.indices().end());
    place_.resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
      place_[order_[k]] = static_cast<int>(k);
    }
  }

  /// Row by row of L; the pattern of a row are the paths in the elimination tree from the entries
  /// of A Aᵀ.
  void factorize(const Eigen::SparseMatrix<double>& products, double threshold) {
    const std::size_t size = order_.size();
    columns_.resize(size);
    pivots_.assign(size, 0.0);
    std::vector<std::size_t> parent(size, size), seen(size, size), path, pattern;
    std::vector<double> y(size, 0.0);
    for (std::size_t k = 0; k < size; ++k) {
      pattern.clear();
      seen[k] = k;
      for (Eigen::SparseMatrix<double>::InnerIterator entry(products, order_[k]); entry; ++entry) {
        std::size_t i = place_[entry.row()];
        if (i > k) continue;
        y[i] += entry.value();
        path.clear();
        for (; seen[i] != k; i = parent[i]) {
          if (parent[i] == size) parent[i] = k;
          path.push_back(i);
          seen[i] = k;
        }
        pattern.insert(pattern.end(), path.rbegin(), path.rend());
      }
      double pivot = y[k];
      y[k] = 0.0;
      // Paths were found from their ends: the last one comes first.
      for (auto place = pattern.rbegin(); place != pattern.rend(); ++place) {
        const std::size_t i = *place;
        const double value = y[i];
        y[i] = 0.0;
        if (!is_independent(i)) continue;
        for (const auto& [row, factor] : columns_[i]) y[row] -= factor * value;
        const double factor = value / pivots_[i];
        pivot -= factor * value;
        columns_[i].emplace_back(k, factor);
      }
      if (pivot <= threshold) continue;
      pivots_[k] = pivot;
      ++rank_;
    }
  }

  /// A Aᵀ z = b for the independent rows, zero for the others.
  VectorXd solve(const VectorXd& b) const {
    const std::size_t size = order_.size();
    std::vector<double> z(size);
    for (std::size_t k = 0; k < size; ++k) z[k] = is_independent(k) ? b(order_[k]) : 0.0;
    for (std::size_t k = 0; k < size; ++k) {
      for (const auto& [row, factor] : columns_[k]) {
        if (is_independent(row)) z[row] -= factor * z[k];
      }
    }
    for (std::size_t k = 0; k < size; ++k) {
      if (is_independent(k)) z[k] /= pivots_[k];
    }
    for (std::size_t k = size; k-- > 0;) {
      for (const auto& [row, factor] : columns_[k]) z[k] -= factor * z[row];
    }
    VectorXd solution(size);
    for (std::size_t k = 0; k < size; ++k) solution(order_[k]) = z[k];
    return solution;
  }

  VectorXd lengths_;
  SparseRows rows_;
  std::vector<int> order_, place_;  ///< which row is the k-th; the inverse
  std::vector<std::vector<std::pair<std::size_t, double>>> columns_;  ///< of L, below the diagonal
  std::vector<double> pivots_;                                        ///< D; zero: dependent
  Index rank_ = 0;
};

void normalize_columns(SparseRows& rows) {
  VectorXd squares = VectorXd::Zero(rows.cols());
  for (Index row = 0; row < rows.rows(); ++row) {
    for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) {
      squares(entry.col()) += entry.value() * entry.value();
    }
  }
  for (double& square : squares) {
    if (square == 0.0) square = 1.0;
  }
  rows = rows * squares.cwiseSqrt().cwiseInverse().asDiagonal();
}

Index sparse_rank(SparseRows rows, double threshold) {
  normalize_columns(rows);
  return SparseFactors(rows, threshold).rank();
}

VectorXd entries_at(const VectorXd& all, const std::vector<int>& indices) {
  return all(indices);
}

struct BlockRank {
  std::vector<int> order;
  VectorXd pivots;  ///< absolute, of all rows
};

BlockRank rank_block(const SparseRows& rows, double negligible) {
  VectorXd pivots = VectorXd::Zero(rows.rows());
  if (is_small(rows)) {
    const PivotedQr qr(MatrixXd(rows).transpose());
    const VectorXd diagonal = qr.pivots();
    pivots.head(diagonal.size()) = diagonal;
    return {qr.order(), std::move(pivots)};
  }
  const SparseFactors factors(rows, negligible);
  pivots.head(factors.rank()) = factors.pivots();
  return {factors.order(), std::move(pivots)};
}

}  // namespace

std::vector<RowBlock> connected_blocks(const SparseRows& matrix) {
  DisjointSets sets(matrix.rows());
  std::vector<int> row_of_column(matrix.cols(), -1);
  for (int row = 0; row < static_cast<int>(matrix.rows()); ++row) {
    for (SparseRows::InnerIterator entry(matrix, row); entry; ++entry) {
      int& first = row_of_column[entry.col()];
      if (first < 0) first = row;
      sets.join(first, row);
    }
  }
  std::vector<RowBlock> blocks;
  std::vector<std::size_t> place(matrix.rows());
  for (int row = 0; row < static_cast<int>(matrix.rows()); ++row) {
    const int name = sets.find(row);
    if (name == row) {
      place[row] = blocks.size();
      blocks.emplace_back();
    }
    blocks[place[name]].rows.push_back(row);
  }
  for (std::size_t column = 0; column < row_of_column.size(); ++column) {
    if (row_of_column[column] < 0) continue;
    const int name = sets.find(row_of_column[column]);
    blocks[place[name]].columns.push_back(static_cast<int>(column));
  }
  return blocks;
}

bool is_large(const RowBlock& block) {
  return static_cast<Index>(block.rows.size()) > most_dense_rows;
}

SparseRows select_rows(const SparseRows& matrix, const std::vector<int>& rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (SparseRows::InnerIterator entry(matrix, rows[i]); entry; ++entry) {
      entries.emplace_back(i, entry.col(), entry.value());
    }
  }
  SparseRows selected(rows.size(), matrix.cols());
  selected.setFromTriplets(entries.begin(), entries.end());
  return selected;
}

SparseRows select_block(const SparseRows& matrix, const RowBlock& block) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < block.rows.size(); ++i) {
    for (SparseRows::InnerIterator entry(matrix, block.rows[i]); entry; ++entry) {
      const auto column = std::ranges::lower_bound(block.columns, entry.col());
      entries.emplace_back(i, column - block.columns.begin(), entry.value());
    }
  }
  SparseRows selected(block.rows.size(), block.columns.size());
  selected.setFromTriplets(entries.begin(), entries.end());
  return selected;
}

RankedRows rank_rows(SparseRows rows, double negligible) {
  normalize(rows);
  std::vector<std::pair<double, int>> ranked;
  for (const RowBlock& block : connected_blocks(rows)) {
    const BlockRank of_block = rank_block(select_block(rows, block), negligible);
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
      ranked.emplace_back(of_block.pivots(i), block.rows[of_block.order[i]]);
    }
  }
  std::ranges::stable_sort(ranked, [](const auto& a, const auto& b) { return a.first > b.first; });
  RankedRows result{{}, VectorXd::Zero(rows.rows())};
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    result.order.push_back(ranked[i].second);
    if (ranked[0].first > 0.0) {
      result.pivots(i) = ranked[i].first / ranked[0].first;
    }
  }
  return result;
}

Index rank_of_rows(SparseRows rows, double threshold) {
  normalize(rows);
  Index rank = 0;
  for (const RowBlock& block : connected_blocks(rows)) {
    const SparseRows part = select_block(rows, block);
    rank += is_small(part) ? PivotedQr(MatrixXd(part).transpose(), threshold).rank()
                           : sparse_rank(part, threshold);
  }
  return rank;
}

Index rank_added_by(const std::vector<int>& added, SparseRows rows, double threshold) {
  const Index all = rank_of_rows(rows, threshold);
  for (const int row : added) rows.row(row) *= 0.0;
  rows.prune(0.0);
  return all - rank_of_rows(std::move(rows), threshold);
}

MatrixXd null_space_of_rows(SparseRows rows, double threshold, Index most) {
  normalize(rows);
  std::vector<MatrixXd> spaces;
  std::vector<std::vector<int>> columns;
  std::vector<bool> is_free(rows.cols(), true);
  for (const RowBlock& block : connected_blocks(rows)) {
    for (const int column : block.columns) is_free[column] = false;
    if (block.columns.empty()) continue;
    const SparseRows part = select_block(rows, block);
    spaces.push_back(is_small(part)
                         ? PivotedQr(MatrixXd(part).transpose(), threshold).normal_space()
                         : SparseFactors(part, threshold).normal_space(most));
    columns.push_back(block.columns);
  }
  for (std::size_t column = 0; column < is_free.size(); ++column) {
    if (!is_free[column]) continue;
    spaces.push_back(MatrixXd::Identity(1, 1));
    columns.push_back({static_cast<int>(column)});
  }
  Index size = 0;
  for (const MatrixXd& space : spaces) size += space.cols();
  MatrixXd all = MatrixXd::Zero(rows.cols(), size);
  Index first = 0;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    all(columns[i], Eigen::seqN(first, spaces[i].cols())) = spaces[i];
    first += spaces[i].cols();
  }
  return all;
}

VectorXd least_norm_solution(const SparseRows& rows, const VectorXd& b) {
  VectorXd x = VectorXd::Zero(rows.cols());
  for (const RowBlock& block : connected_blocks(rows)) {
    if (block.columns.empty()) continue;
    const SparseRows part = select_block(rows, block);
    const VectorXd right = entries_at(b, block.rows);
    x(block.columns) = is_small(part) ? least_norm_solution(MatrixXd(part), right)
                                      : SparseFactors(part).least_norm(right);
  }
  return x;
}

VectorXd factors_of_rows(const SparseRows& rows, const VectorXd& b) {
  VectorXd z = VectorXd::Zero(rows.rows());
  for (const RowBlock& block : connected_blocks(rows)) {
    if (block.columns.empty()) continue;
    const SparseRows part = select_block(rows, block);
    const VectorXd right = entries_at(b, block.columns);
    z(block.rows) = is_small(part) ? least_norm_solution(MatrixXd(part).transpose(), right)
                                   : SparseFactors(part).factors(right);
  }
  return z;
}

}  // namespace pleuel
