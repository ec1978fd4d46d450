#include "core/integration/jerk.hpp"

#include "core/base/error.hpp"
#include "core/mechanism/configuration.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

namespace {

constexpr auto level = ConstraintLevel::acceleration;
/// D errs by O(τ) with the squares of accelerations, which are large where members start to ring.
constexpr double interval_share = 1e-3;

}  // namespace

ConstrainedJerk::ConstrainedJerk(Mechanism& mechanism, const State& start, double step)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      start_(start),
      interval_(step * interval_share) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::VectorXd before, after;
  system_.residual(start_, level, before);
  system_.residual(moved(), level, after);
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, 1);
  rhs.bottomRows(m) = (before - after).tail(m) / interval_;
  solve(rhs);
  value_ = rhs.topRows(n);
  multipliers_ = rhs.bottomRows(m);
}

/// A little later.
State ConstrainedJerk::moved() const {
  State moved = start_;
  moved.time += interval_;
  advance(mechanism_.rotations, start_.q, interval_ * start_.v, moved.q);
  moved.v += interval_ * start_.a;
  return moved;
}

void ConstrainedJerk::solve(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs) const {
  System::Matrix matrix = system_.make_matrix();
  system_.tangent(start_, {.a = 1.0}, level, matrix);
  LinearSolver solver(matrix, mechanism_.elastic);
  if (!solver.factorize(matrix)) {
    throw SimulationError("the equations of the start are singular");
  }
  solver.solve(rhs);
}

Eigen::MatrixXd ConstrainedJerk::differentiate(const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
                                               const Eigen::MatrixXd& a) const {
  const int n = system_.coordinates(), m = system_.multipliers();
  System::Matrix matrix = system_.make_matrix();
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, system_.variables()), columns;

  // Dx
  const State later = moved();
  const Eigen::VectorXd increment = interval_ * start_.v;
  Eigen::MatrixXd later_q = q;
  pull_back(mechanism_.rotations, increment, later_q);
  later_q += interval_ * v;
  push_forward(mechanism_.rotations, increment, later_q);
  system_.design_derivative(later, level, columns);
  system_.tangent(later, {.q = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * later_q;
  system_.tangent(later, {.v = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * (v + interval_ * a);
  system_.tangent(later, {.a = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * a;
  rhs.bottomRows(m) = columns.bottomRows(m) / -interval_;
  system_.design_derivative(start_, level, columns);
  system_.tangent(start_, {.q = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * q;
  system_.tangent(start_, {.v = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * v;
  system_.tangent(start_, {.a = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * a;
  rhs.bottomRows(m) += columns.bottomRows(m) / interval_;

  // The change of M j + Φ_qᵀ μ and Φ_q j
  LinearForces forces(system_, level);
  forces.set(start_, value_, multipliers_);
  forces.tangent(matrix);
  rhs -= forces.design_derivative();
  rhs -= matrix.leftCols(n) * q;
  solve(rhs);
  return rhs.topRows(n);
}

}  // namespace pleuel
