#include "core/mechanism/linear_solver.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <new>

#include <camd.h>
#include <klu.h>

#include "core/mechanism/pivoted_factors.hpp"

namespace pleuel {

namespace {

/// Backward errors up to this are round-off: measured 1e-17 to 2e-15.
constexpr double refined_round_off = 1e-14;
/// Where refinement leaves more than this, the pivots are no good.
constexpr double poor = 1e-10;
/// Where pivots on the diagonal make entries grow all the same, the largest one is the pivot.
constexpr double full_threshold = 1.0;
/// Columns that are smaller, as of sensitivities that have died out, lose digits to underflow.
constexpr double nothing =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

using Block = PivotedFactors::Block;

/// The power of two next to 1/x.
double inverse_power(double x) {
  return x > 0.0 && std::isfinite(x) ? std::ldexp(1.0, -std::ilogb(x)) : 1.0;
}

/// Orders unknowns by minimum degree of A + Aᵀ, those of `first` before the others.
std::vector<int> elimination_order(LinearSolver::Matrix& pattern, const std::vector<int>& first) {
  const int size = static_cast<int>(pattern.rows());
  std::vector<int> order(size), sets(order.size(), 1);
  for (const int unknown : first) sets[unknown] = 0;
  const int status = camd_order(size, pattern.outerIndexPtr(), pattern.innerIndexPtr(),
                                order.data(), nullptr, nullptr, sets.data());
  if (status == CAMD_OUT_OF_MEMORY) throw std::bad_alloc();
  assert(status == CAMD_OK);
  return order;
}

}  // namespace

struct LinearSolver::Implementation {
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;  ///< for which pivots were last chosen
  PivotedFactors factors;
  double pivot_ratio = 0.0, chosen_ratio = 0.0;  ///< of the last factors; when pivots were chosen
  int factorizations = 0;
  bool has_new_pivots = false;
  Matrix matrix;         ///< pattern and the scaled values factorised last
  double largest = 0.0;  ///< of their magnitudes
  Eigen::VectorXd row_scale, column_scale;
  Eigen::ArrayXd scales;           ///< of the values: row times column
  Eigen::VectorXd pivoted_values;  ///< scaled, for which pivots were last chosen
  int pivot_choices = 0;
  Eigen::MatrixXd rhs, residual;              ///< scratch
  Eigen::VectorXd summed_x, summed_residual;  ///< scratch
  double backward_error = 0.0;

  int* starts() { return matrix.outerIndexPtr(); }
  int* rows() { return matrix.innerIndexPtr(); }
  double* values() { return matrix.valuePtr(); }

  /// Scales with which the largest entry of each row and column is about one.
  void choose_scales(const Matrix& unscaled) {
    row_scale.setZero(unscaled.rows());
    column_scale.setZero(unscaled.cols());
    const auto note = [&](Eigen::VectorXd& scale, bool is_row) {
      for (int col = 0; col < unscaled.cols(); ++col) {
        for (Matrix::InnerIterator it(unscaled, col); it; ++it) {
          const double value = std::abs(it.value());
          double& at = is_row ? scale(it.row()) : scale(col);
          at = std::max(at, is_row ? value : row_scale(it.row()) * value);
        }
      }
      scale = scale.unaryExpr(&inverse_power);
    };
    note(row_scale, true);
    note(column_scale, false);
    set_scales();
  }

  /// What scaled values are multiplied with.
  void set_scales() {
    scales.resize(matrix.nonZeros());
    for (int col = 0; col < matrix.cols(); ++col) {
      for (int k = starts()[col]; k < starts()[col + 1]; ++k) {
        scales(k) = row_scale(rows()[k]) * column_scale(col);
      }
    }
  }

  void take(const Matrix& unscaled) {
    matrix.coeffs() = scales * unscaled.coeffs();
    largest = matrix.coeffs().abs().maxCoeff();
  }

  bool refactorize(const Matrix& unscaled) {
    if (numeric == nullptr) return false;
    take(unscaled);
    has_new_pivots = false;
    factorize();
    // The old pivots still serve unless their ratio has dropped a lot.
    return std::isfinite(pivot_ratio) && pivot_ratio > 1e-3 * chosen_ratio;
  }

  void factorize() {
    factors.factorize(matrix);
    pivot_ratio = factors.pivot_ratio();
  }

  bool factorize_with_new_pivots(const Matrix& unscaled) {
    choose_scales(unscaled);
    take(unscaled);
    return choose_pivots();
  }

  bool choose_pivots() {
    has_new_pivots = true;
    ++pivot_choices;
    pivoted_values = Eigen::Map<const Eigen::VectorXd>(values(), matrix.nonZeros());
    klu_free_numeric(&numeric, &common);
    numeric = klu_factor(starts(), rows(), values(), symbolic, &common);
    if (numeric == nullptr || common.status != KLU_OK) return false;
    const std::vector<int> row_order(numeric->Pnum, numeric->Pnum + symbolic->n);
    if (row_order != factors.row_order()) {
      factors = PivotedFactors(matrix, row_order, {symbolic->Q, symbolic->Q + symbolic->n});
    }
    factorize();
    chosen_ratio = pivot_ratio;
    return std::isfinite(pivot_ratio) && pivot_ratio > 0.0;
  }

  /// Also false if it is not a number.
  bool is_accurate() const { return backward_error <= poor; }

  void solve_scaled(bool is_transposed, Block x) {
    is_transposed ? factors.solve_transposed(x) : factors.solve(x);
  }

  /// left −= A right or Aᵀ right.
  template <class Left, class Right>
  void subtract_product(bool is_transposed, const Right& right, Left& left) const {
    if (is_transposed) {
      left.noalias() -= matrix.transpose() * right;
    } else {
      left.noalias() -= matrix * right;
    }
  }

  /// The backward error of a sum of all columns, each divided by its size: one product, whatever
  /// their number.
  void estimate_backward_error(bool is_transposed, const Block& x) {
    summed_x.setZero(x.rows());
    summed_residual.setZero(x.rows());
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      const double size = largest * x.col(j).lpNorm<1>() + rhs.col(j).lpNorm<Eigen::Infinity>();
      if (size < nothing) continue;
      summed_x += x.col(j) / size;
      summed_residual += rhs.col(j) / size;
    }
    subtract_product(is_transposed, summed_x, summed_residual);
    // Round-off of many columns adds up as its root does.
    const double columns = std::max<double>(1.0, static_cast<double>(x.cols()));
    backward_error = summed_residual.lpNorm<Eigen::Infinity>() / std::sqrt(columns);
  }

  /// With the scaled rhs in x.
  void solve_and_refine(bool is_transposed, Block x) {
    rhs = x;
    residual.resizeLike(rhs);  // here, not in the step that first needs it
    solve_scaled(is_transposed, x);
    estimate_backward_error(is_transposed, x);
    if (backward_error <= refined_round_off) return;
    residual = rhs;
    subtract_product(is_transposed, x, residual);
    solve_scaled(is_transposed, residual);
    x += residual;
    estimate_backward_error(is_transposed, x);
    if (is_accurate()) return;
    if (has_new_pivots) {
      if (common.tol == full_threshold) return;  // is_accurate() says so
      common.tol = full_threshold;
    }
    if (choose_pivots()) {
      x = rhs;
      solve_and_refine(is_transposed, x);
    } else {
      x.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
};

LinearSolver::LinearSolver(const Matrix& pattern, const std::vector<int>& first)
    : implementation_(std::make_unique<Implementation>()) {
  Implementation& klu = *implementation_;
  klu.matrix = pattern;
  klu.pivoted_values.resize(pattern.nonZeros());
  klu_defaults(&klu.common);
  klu.common.scale = -1;  // done here; the pattern needs no check in each factorisation
  const int size = static_cast<int>(pattern.rows());
  if (first.empty()) {
    klu.common.tol = usual_threshold;
    klu.symbolic = klu_analyze(size, klu.starts(), klu.rows(), &klu.common);
  } else {
    klu.common.tol = ordered_threshold;
    std::vector<int> order = elimination_order(klu.matrix, first);
    klu.symbolic =
        klu_analyze_given(size, klu.starts(), klu.rows(), order.data(), order.data(), &klu.common);
  }
  assert(klu.symbolic != nullptr);
}

LinearSolver::~LinearSolver() {
  if (!implementation_) return;
  klu_free_numeric(&implementation_->numeric, &implementation_->common);
  klu_free_symbolic(&implementation_->symbolic, &implementation_->common);
}

LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;

bool LinearSolver::factorize(const Matrix& matrix) {
  Implementation& klu = *implementation_;
  assert(matrix.nonZeros() == klu.matrix.nonZeros());
  ++klu.factorizations;
  return klu.refactorize(matrix) || klu.factorize_with_new_pivots(matrix);
}

void LinearSolver::solve(Block rhs) {
  Implementation& klu = *implementation_;
  rhs.array().colwise() *= klu.row_scale.array();
  klu.solve_and_refine(false, rhs);
  rhs.array().colwise() *= klu.column_scale.array();
}

void LinearSolver::solve_transposed(Block rhs) {
  Implementation& klu = *implementation_;
  rhs.array().colwise() *= klu.column_scale.array();
  klu.solve_and_refine(true, rhs);
  rhs.array().colwise() *= klu.row_scale.array();
}

bool LinearSolver::is_accurate() const {
  return implementation_->is_accurate();
}

double LinearSolver::backward_error() const {
  return implementation_->backward_error;
}

double LinearSolver::reciprocal_condition() const {
  return implementation_->pivot_ratio;
}

double LinearSolver::condition() const {
  Implementation& klu = *implementation_;
  klu_refactor(klu.starts(), klu.rows(), klu.values(), klu.symbolic, klu.numeric, &klu.common);
  klu_condest(klu.starts(), klu.values(), klu.symbolic, klu.numeric, &klu.common);
  return klu.common.condest;
}

int LinearSolver::determinant_sign() const {
  return implementation_->factors.determinant_sign();
}

int LinearSolver::factorizations() const {
  return implementation_->factorizations;
}

int LinearSolver::factor_entries() const {
  return implementation_->factors.entries();
}

LinearSolver::Pivots LinearSolver::pivots() const {
  const Implementation& klu = *implementation_;
  if (klu.numeric == nullptr) return {{}, {}, {}, klu.common.tol};
  return {klu.row_scale, klu.column_scale, klu.pivoted_values, klu.common.tol};
}

void LinearSolver::use_pivots(const Pivots& pivots) {
  Implementation& klu = *implementation_;
  klu.common.tol = pivots.threshold;
  if (pivots.values.size() == 0) {
    klu_free_numeric(&klu.numeric, &klu.common);
    return;
  }
  klu.row_scale = pivots.row_scale;
  klu.column_scale = pivots.column_scale;
  klu.set_scales();
  Eigen::Map<Eigen::VectorXd>(klu.values(), klu.matrix.nonZeros()) = pivots.values;
  klu.choose_pivots();
}

int LinearSolver::pivot_choices() const {
  return implementation_->pivot_choices;
}

}  // namespace pleuel
