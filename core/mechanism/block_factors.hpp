#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"

namespace pleuel {

/// A factor by compressed columns.
struct ColumnFactor {
  std::vector<int> starts, rows;
  std::vector<double> values;
};

/// Factors P A Q = L U + F of a sparse matrix, with F above the diagonal blocks, for many
/// right-hand sides at once: an entry of a factor meets a row of eight (or four) of them, which the
/// processor does in vectors. Pays from five columns on (KLU itself takes four), with what it costs
/// to copy the factors.
struct BlockFactors {
  using Block = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  ColumnFactor lower;                        ///< L, ones on the diagonal, first in their columns
  ColumnFactor upper;                        ///< U, the diagonal last in its column
  ColumnFactor above;                        ///< F
  std::vector<int> row_order, column_order;  ///< row or column of A for each of P A Q
  std::vector<int> blocks;                   ///< where they begin, and the end of the last one

  /// For factors with so many entries.
  void resize(int size, int lower_entries, int upper_entries, int entries_above, int block_count);

  /// x ← A⁻¹ x
  void solve(Block x);
  /// x ← A⁻ᵀ x
  void solve_transposed(Block x);

 private:
  int size() const { return int_size(row_order); }
  // Of up to `Width` columns, with rows in rows_.
  template <int Width>
  void solve_group(Block x);
  template <int Width>
  void solve_group_transposed(Block x);

  std::vector<double> rows_;  ///< permuted
};

}  // namespace pleuel
