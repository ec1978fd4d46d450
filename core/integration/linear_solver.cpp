#include "core/integration/linear_solver.hpp"

#include <cassert>
#include <cmath>

#include <klu.h>

namespace pleuel {

struct LinearSolver::Implementation {
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  double pivoted_condition = 0.0;  ///< rcond when pivots were last chosen
  int factorizations = 0;
  Matrix matrix;  ///< pattern and the values factorised last

  int* starts() { return matrix.outerIndexPtr(); }
  int* rows() { return matrix.innerIndexPtr(); }
  double* values() { return matrix.valuePtr(); }

  bool refactorize() {
    if (numeric == nullptr) return false;
    const bool done = klu_refactor(starts(), rows(), values(), symbolic, numeric, &common) != 0;
    if (!done || common.status != KLU_OK) return false;
    klu_rcond(symbolic, numeric, &common);
    // The old pivots still serve unless the condition estimate has dropped a lot.
    return std::isfinite(common.rcond) && common.rcond > 1e-3 * pivoted_condition;
  }

  bool factorize_with_new_pivots() {
    klu_free_numeric(&numeric, &common);
    numeric = klu_factor(starts(), rows(), values(), symbolic, &common);
    if (numeric == nullptr || common.status != KLU_OK) return false;
    klu_rcond(symbolic, numeric, &common);
    pivoted_condition = common.rcond;
    return std::isfinite(common.rcond) && common.rcond > 0.0;
  }
};

LinearSolver::LinearSolver(const Matrix& pattern)
    : implementation_(std::make_unique<Implementation>()) {
  Implementation& klu = *implementation_;
  klu.matrix = pattern;
  klu_defaults(&klu.common);
  klu.symbolic =
      klu_analyze(static_cast<int>(pattern.rows()), klu.starts(), klu.rows(), &klu.common);
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
  std::copy(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), klu.values());
  ++klu.factorizations;
  return klu.refactorize() || klu.factorize_with_new_pivots();
}

void LinearSolver::solve(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs) {
  Implementation& klu = *implementation_;
  klu_solve(klu.symbolic, klu.numeric, static_cast<int>(rhs.outerStride()),
            static_cast<int>(rhs.cols()), rhs.data(), &klu.common);
}

void LinearSolver::solve_transposed(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs) {
  Implementation& klu = *implementation_;
  klu_tsolve(klu.symbolic, klu.numeric, static_cast<int>(rhs.outerStride()),
             static_cast<int>(rhs.cols()), rhs.data(), &klu.common);
}

double LinearSolver::reciprocal_condition() const {
  return implementation_->common.rcond;
}

int LinearSolver::factorizations() const {
  return implementation_->factorizations;
}

}  // namespace pleuel
