#pragma once

#include <vector>

#include <Eigen/Core>
#include <klu.h>

namespace pleuel {

/// The factors of KLU, P A Q = L U + F with F above the diagonal blocks, for many right-hand sides
/// at once. KLU takes them by four; here an entry of a factor meets a whole row of them, which the
/// processor does in vectors. Pays from a dozen columns on, with what it costs to copy the factors.
class BlockFactors {
 public:
  using Block = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  /// Copies the factors of a factorisation without scales.
  void copy(klu_symbolic* symbolic, klu_numeric* numeric, klu_common* common);

  void solve(Block x);
  void solve_transposed(Block x);

 private:
  /// By compressed columns.
  struct Factor {
    std::vector<int> starts, rows;
    std::vector<double> values;
    void resize(int columns, int entries);
  };
  auto row(int k) { return rows_.row(k); }
  void subtract(const Factor& factor, int entry, int from, int to);

  int size_ = 0;
  Factor lower_;  ///< ones on the diagonal, first in their columns
  Factor upper_;  ///< the diagonal is last in its column
  Factor above_;  ///< F
  std::vector<int> row_order_, column_order_, blocks_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows_;  ///< permuted
};

}  // namespace pleuel
