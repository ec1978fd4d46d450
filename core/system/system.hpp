#pragma once

#include <algorithm>
#include <cassert>
#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include "core/system/term.hpp"

namespace pleuel {

/// The equations of motion R(q, v, a, λ, t; x) = 0 of a mechanism: a sum of terms on one fixed
/// sparsity pattern. Knows no concrete term.
class System {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  /// @param coordinates  n
  /// @param multipliers  m
  /// @param variables    number of design variables
  System(int coordinates, int multipliers, int variables, std::vector<std::unique_ptr<Term>> terms);

  int coordinates() const { return coordinates_; }
  int multipliers() const { return multipliers_; }
  int variables() const { return variables_; }
  int size() const { return coordinates_ + multipliers_; }
  const std::vector<std::unique_ptr<Term>>& terms() const { return terms_; }

  /// Replaces constraints that follow from the others by λ_i = 0, before any matrix is made.
  void deactivate(const std::vector<int>& multipliers);
  const std::vector<int>& left_out() const { return left_out_; }

  /// A zero matrix with the pattern of the tangent, (n + m) × (n + m).
  Matrix make_matrix() const { return pattern_; }

  /// R, n + m entries.
  void residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual);

  /// [ w.q R_q + w.v R_v + w.a R_a,  R_λ ] into a matrix from make_matrix(); nothing is allocated.
  void tangent(const State& state, const Weights& weights, ConstraintLevel level, Matrix& matrix);

  /// Both at once, for less than the cost of one after the other.
  void linearize(const State& state, const Weights& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, Matrix& matrix);

  /// Tangents for several weights from one evaluation, matrices[i] for weights[i].
  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, std::span<Matrix> matrices);

  /// ∂R/∂x at fixed state into an (n + m) × variables matrix.
  void design_derivative(const State& state, ConstraintLevel level, Eigen::MatrixXd& columns);

  // Σ μᵀ ∂R/∂x over instants for several μ, at a cost that does not grow with the number of
  // variables (term.hpp).

  int parameter_adjoint_count() const;
  /// sums (parameter_adjoint_count() × columns of μ) += what this instant adds; μ is (n + m) × any number.
  void add_parameter_adjoints(const State& state, ConstraintLevel level, const ConstColumns& mu,
                              Columns sums);
  /// Σ μᵀ ∂R/∂x, variables × columns of μ.
  Eigen::MatrixXd design_gradients(const ConstColumns& sums) const;

 private:
  void build_pattern();
  /// Sums of entries.
  void write_values(const double* entries, double* values) const;
  /// Rows of what is left out: zero, and one on the diagonal.
  void replace_left_out(const State& state, Eigen::VectorXd& residual) const;
  void replace_left_out(Matrix& matrix) const;

  int coordinates_, multipliers_, variables_;
  std::vector<std::unique_ptr<Term>> terms_;
  std::vector<int> left_out_;
  Matrix pattern_;
  /// Of each value of the matrix, which of the declared entries (terms in order) comes first; one
  /// past the last, which is zero, where there is none.
  std::vector<int> first_of_value_;
  std::vector<std::pair<int, int>> more_of_values_;  ///< the others: (value, entry)
  std::size_t entry_count_ = 0;
  std::vector<double> entries_;  ///< scratch, a block of entries and a zero for each of the weights
  Eigen::VectorXd unused_;       ///< scratch, where only the tangent is asked for
  std::vector<std::size_t> first_entry_;
  Eigen::MatrixXd kept_mu_;  ///< scratch, without the rows of what is left out
};

/// Sets the rows of the equations of motion to zero in the columns of coordinates.
void clear_dynamic_block(int coordinates, System::Matrix& matrix);

/// Which of the values of a matrix stands at a place of its pattern. @pre there is one
inline int slot_of(const System::Matrix& pattern, int row, int col) {
  const int* begin = pattern.innerIndexPtr() + pattern.outerIndexPtr()[col];
  const int* end = pattern.innerIndexPtr() + pattern.outerIndexPtr()[col + 1];
  const int* found = std::lower_bound(begin, end, row);
  assert(found != end && *found == row);
  return static_cast<int>(found - pattern.innerIndexPtr());
}

}  // namespace pleuel
