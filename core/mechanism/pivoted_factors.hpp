#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace pleuel {

/// Factors P A Q = L U of sparse matrices with one pattern and given pivots: what each step needs,
/// while KLU chooses the pivots once. All places of numbers are found beforehand. Rows are kept in
/// blocks of four columns, which the processor takes as vectors, and right-hand sides are solved for
/// one, four or eight at a time.
class PivotedFactors {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  using Block = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  PivotedFactors() = default;
  /// @param row_order, column_order  row and column of A for each of P A Q
  PivotedFactors(const Matrix& pattern, std::vector<int> row_order, std::vector<int> column_order);

  /// Of a matrix with that pattern.
  void factorize(const Matrix& matrix);
  /// x ← A⁻¹ x
  void solve(Block x);
  /// x ← A⁻ᵀ x
  void solve_transposed(Block x);

  /// min |u_kk| / max |u_kk|: 0 or not finite if a pivot is zero or not finite.
  double pivot_ratio() const;
  /// Of det A: 1 or −1, if no pivot is zero.
  int determinant_sign() const;
  /// Of L and U.
  int entries() const;
  const std::vector<int>& row_order() const { return row_order_; }

 private:
  using RowLists = std::vector<std::vector<int>>;
  struct Layout;
  void place_factors(const RowLists& rows, const Layout& layout);
  template <class Visit>
  void for_each_group(Block x, const Visit& visit);
  template <int Width>
  void solve_group(Block x);
  template <int Width>
  void solve_group_transposed(Block x);

  /// Entries of one factor by columns, and where they stand.
  struct Columns {
    Columns() = default;
    /// @param has  whether an entry of the rows is one of the factor
    template <class Has>
    Columns(const RowLists& rows, const Has& has);
    void add(int entry, int row_of_entry, int place_of_entry) {
      row[entry] = row_of_entry;
      place[entry] = place_of_entry;
    }

    std::vector<int> start, row, place;
  };

  std::vector<int> row_order_, column_order_;
  std::vector<int> places_;       ///< of the entries of A in rows_
  std::vector<int> diagonal_;     ///< places of the pivots
  Eigen::VectorXd rows_;          ///< what is left of the rows of A, in blocks of columns
  Columns of_lower_, of_upper_;   ///< places in rows_ and in upper_
  Eigen::VectorXd lower_;         ///< entries of L below its diagonal of ones
  std::vector<int> upper_start_;  ///< the first block of each row of U, in upper_
  Eigen::VectorXd upper_;         ///< blocks of U, with zeros at and before the pivot
  Eigen::VectorXd inverse_;       ///< 1 / u_kk
  std::vector<int> run_start_;    ///< the first run of blocks of each row of U, in:
  std::vector<int> run_length_;   ///< in numbers
  std::vector<int> targets_;      ///< where runs are subtracted from the rows below, in order
  std::vector<double> rhs_;       ///< permuted
};

}  // namespace pleuel
