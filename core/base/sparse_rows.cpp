#include "core/base/sparse_rows.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseQR>

#include "core/base/dense_solvers.hpp"

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

/// Q R = rowsᵀ P, columns with pivots below a threshold last.
class SparseFactors {
 public:
  explicit SparseFactors(const SparseRows& rows) { compute(rows); }
  SparseFactors(const SparseRows& rows, double threshold) {
    qr_.setPivotThreshold(threshold);
    compute(rows);
  }

  Index rank() const { return qr_.rank(); }
  std::vector<int> order() const {
    const auto& indices = qr_.colsPermutation().indices();
    return {indices.begin(), indices.end()};
  }
  /// |R_ii| of the independent rows.
  VectorXd pivots() const {
    VectorXd pivots(rank());
    for (Index i = 0; i < pivots.size(); ++i) pivots(i) = std::abs(triangle_.coeff(i, i));
    return pivots;
  }
  MatrixXd normal_space() const {
    const Index size = qr_.rows();
    MatrixXd units = MatrixXd::Zero(size, size - rank());
    units.bottomRows(size - rank()).setIdentity();
    return qr_.matrixQ() * units;
  }
  VectorXd least_norm(const VectorXd& b) const {
    const std::vector<int> first = order();
    VectorXd y = VectorXd::Zero(qr_.rows());
    for (Index i = 0; i < rank(); ++i) y(i) = b(first[static_cast<std::size_t>(i)]);
    VectorXd head = y.head(rank());
    triangle_.transpose().triangularView<Eigen::Lower>().solveInPlace(head);
    y.head(rank()) = head;
    return qr_.matrixQ() * y;
  }
  VectorXd factors(const VectorXd& b) const { return qr_.solve(b); }

 private:
  void compute(const SparseRows& rows) {
    Eigen::SparseMatrix<double> columns = rows.transpose();
    columns.makeCompressed();
    qr_.compute(columns);
    triangle_ = qr_.matrixR().topLeftCorner(rank(), rank());
  }

  Eigen::SparseQR<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> qr_;
  SparseRows triangle_;
};

void normalize(SparseRows& rows) {
  for (Index row = 0; row < rows.rows(); ++row) {
    double square = 0.0;
    for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) {
      square += entry.value() * entry.value();
    }
    if (square == 0.0) continue;
    const double length = std::sqrt(square);
    for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) entry.valueRef() /= length;
  }
}

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
  normalize(rows);
  return SparseFactors(rows, threshold).rank();
}

/// Union of sets, with the smallest member as the name of each.
class Sets {
 public:
  explicit Sets(Index size) : parent_(static_cast<std::size_t>(size)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void join(int i, int k) {
    i = find(i);
    k = find(k);
    parent(std::max(i, k)) = std::min(i, k);
  }

 private:
  int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<int> parent_;
};

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
  Sets sets(matrix.rows());
  std::vector<int> row_of_column(static_cast<std::size_t>(matrix.cols()), -1);
  for (int row = 0; row < static_cast<int>(matrix.rows()); ++row) {
    for (SparseRows::InnerIterator entry(matrix, row); entry; ++entry) {
      int& first = row_of_column[static_cast<std::size_t>(entry.col())];
      if (first < 0) first = row;
      sets.join(first, row);
    }
  }
  std::vector<RowBlock> blocks;
  std::vector<std::size_t> place(static_cast<std::size_t>(matrix.rows()));
  for (int row = 0; row < static_cast<int>(matrix.rows()); ++row) {
    const int name = sets.find(row);
    if (name == row) {
      place[static_cast<std::size_t>(row)] = blocks.size();
      blocks.emplace_back();
    }
    blocks[place[static_cast<std::size_t>(name)]].rows.push_back(row);
  }
  for (std::size_t column = 0; column < row_of_column.size(); ++column) {
    if (row_of_column[column] < 0) continue;
    const int name = sets.find(row_of_column[column]);
    blocks[place[static_cast<std::size_t>(name)]].columns.push_back(static_cast<int>(column));
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
  SparseRows selected(static_cast<Index>(rows.size()), matrix.cols());
  selected.setFromTriplets(entries.begin(), entries.end());
  return selected;
}

SparseRows select_block(const SparseRows& matrix, const RowBlock& block) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < block.rows.size(); ++i) {
    for (SparseRows::InnerIterator entry(matrix, block.rows[i]); entry; ++entry) {
      const auto column = std::lower_bound(block.columns.begin(), block.columns.end(), entry.col());
      entries.emplace_back(i, column - block.columns.begin(), entry.value());
    }
  }
  SparseRows selected(static_cast<Index>(block.rows.size()),
                      static_cast<Index>(block.columns.size()));
  selected.setFromTriplets(entries.begin(), entries.end());
  return selected;
}

RankedRows rank_rows(SparseRows rows, double negligible) {
  normalize(rows);
  std::vector<std::pair<double, int>> ranked;
  for (const RowBlock& block : connected_blocks(rows)) {
    const BlockRank of_block = rank_block(select_block(rows, block), negligible);
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
      ranked.emplace_back(of_block.pivots(static_cast<Index>(i)),
                          block.rows[static_cast<std::size_t>(of_block.order[i])]);
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  RankedRows result{{}, VectorXd::Zero(rows.rows())};
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    result.order.push_back(ranked[i].second);
    if (ranked[0].first > 0.0) {
      result.pivots(static_cast<Index>(i)) = ranked[i].first / ranked[0].first;
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

MatrixXd null_space_of_rows(SparseRows rows, double threshold) {
  normalize(rows);
  std::vector<MatrixXd> spaces;
  std::vector<std::vector<int>> columns;
  std::vector<bool> is_free(static_cast<std::size_t>(rows.cols()), true);
  for (const RowBlock& block : connected_blocks(rows)) {
    for (const int column : block.columns) is_free[static_cast<std::size_t>(column)] = false;
    if (block.columns.empty()) continue;
    const SparseRows part = select_block(rows, block);
    spaces.push_back(is_small(part)
                         ? PivotedQr(MatrixXd(part).transpose(), threshold).normal_space()
                         : SparseFactors(part, threshold).normal_space());
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
