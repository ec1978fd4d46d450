#include "core/integration/projection.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/configuration.hpp"

namespace pleuel {

namespace {

/// Corrections that are smaller, relative to the scale of the coordinates, are round-off.
constexpr double tolerance = 1e-13;
/// Those below this that no longer shrink are, too.
constexpr double round_off = 1e-9;
constexpr int max_iterations = 20;

}  // namespace

Projection::Projection(Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      matrix_(system_.make_matrix()),
      solver_(matrix_),
      drifted_(system_.coordinates(), system_.multipliers()),
      projected_(drifted_),
      step_(system_.size()),
      velocity_solver_(matrix_),
      position_rows_(matrix_),
      velocity_rows_(matrix_),
      rate_rows_(matrix_),
      pull_q_of_positions_(matrix_),
      pull_q_of_velocities_(matrix_),
      scratch_(matrix_) {}

bool Projection::apply(State& state) {
  drifted_.time = projected_.time = state.time;
  drifted_.q = projected_.q = state.q;
  start_ = projected_.v = state.v;
  system_.tangent(drifted_, {.a = 1.0}, ConstraintLevel::acceleration, matrix_);
  if (!solver_.factorize(matrix_) || !close_positions() || !close_velocities()) return false;
  state.q = projected_.q;
  state.v = projected_.v;
  return true;
}

double Projection::correct(Eigen::VectorXd& move, Eigen::VectorXd& multipliers) {
  const int n = system_.coordinates(), m = system_.multipliers();
  step_.head(n).setZero();
  step_.tail(m) = -residual_.tail(m);
  solver_.solve(step_);
  move += step_.head(n);
  multipliers += step_.tail(m);
  return step_.head(n).cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>();
}

bool Projection::close_positions() {
  delta_.setZero(system_.coordinates());
  eta_.setZero(system_.multipliers());
  double previous = 0.0;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    system_.residual(projected_, ConstraintLevel::position, residual_);
    const double size = correct(delta_, eta_);
    advance(mechanism_.rotations, drifted_.q, delta_, projected_.q);
    if (size <= tolerance) return true;
    if (iteration > 1 && size > 0.5 * previous) return size <= round_off;
    previous = size;
  }
  return false;
}

bool Projection::close_velocities() {
  epsilon_.setZero(system_.coordinates());
  nu_.setZero(system_.multipliers());
  const double speed = start_.cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>() + round_off;
  double previous = 0.0;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    system_.residual(projected_, ConstraintLevel::velocity, residual_);
    const double size = correct(epsilon_, nu_) / speed;
    projected_.v = start_ + epsilon_;
    if (size <= tolerance) return true;
    if (iteration > 1 && size > 0.5 * previous) return size <= round_off;
    previous = size;
  }
  return false;
}

void Projection::linearize(const State& drifted) {
  State state = drifted;
  if (!apply(state)) {
    throw SimulationError(
        fmt::format("the projection cannot be differentiated at t = {:.6g} s", drifted.time));
  }
  const Weights by_q{.q = 1.0};
  system_.tangent(projected_, by_q, ConstraintLevel::velocity, rate_rows_);
  system_.tangent(projected_, by_q, ConstraintLevel::position, velocity_rows_);
  position_rows_ = velocity_rows_;
  add_increment_tangent(mechanism_.rotations, delta_, velocity_rows_, 1.0, position_rows_);
  set_solver(position_rows_, solver_);
  set_solver(velocity_rows_, velocity_solver_);
  set_pull_tangent({delta_, eta_}, pull_q_of_positions_);
  set_pull_tangent({epsilon_, nu_}, pull_q_of_velocities_);
}

/// [ M(q)  Φ_q(q)ᵀ ; rows  0 ]
void Projection::set_solver(const System::Matrix& rows, LinearSolver& solver) {
  const int n = system_.coordinates();
  for (int col = 0; col < n; ++col) {
    for (int k = matrix_.outerIndexPtr()[col]; k < matrix_.outerIndexPtr()[col + 1]; ++k) {
      if (matrix_.innerIndexPtr()[k] >= n) matrix_.valuePtr()[k] = rows.valuePtr()[k];
    }
  }
  if (solver.factorize(matrix_)) return;
  throw SimulationError(
      fmt::format("the derivatives of the projection are singular at t = {:.6g} s", drifted_.time));
}

void Projection::hold(const Pull& pull) {
  drifted_.a = pull.move;
  drifted_.lambda = pull.multipliers;
}

void Projection::release() {
  drifted_.a.setZero();
  drifted_.lambda.setZero();
}

void Projection::set_pull_tangent(const Pull& pull, System::Matrix& tangent) {
  const Weights by_q{.q = 1.0};
  system_.tangent(drifted_, by_q, ConstraintLevel::position, scratch_);
  hold(pull);
  system_.tangent(drifted_, by_q, ConstraintLevel::position, tangent);
  release();
  tangent -= scratch_;
}

Eigen::MatrixXd Projection::pull_x(const Pull& pull) {
  Eigen::MatrixXd with, without;
  system_.design_derivative(drifted_, ConstraintLevel::position, without);
  hold(pull);
  system_.design_derivative(drifted_, ConstraintLevel::position, with);
  release();
  return (with - without).topRows(system_.coordinates());
}

// With s⁻ = T(δ)⁻ᵀ s_q of rotations:
//     M s_δ + Φ_qᵀ s_η = −(M δ + Φ_qᵀ η)_q s_q − (M δ + Φ_qᵀ η)_x
//     Φ_q(q*) T(δ) s_δ = −Φ_q(q*) T(δ) s⁻ − Φ_x(q*),          s_q* = T(δ) (s⁻ + s_δ)
//     M s_ε + Φ_qᵀ s_ν = −(M ε + Φ_qᵀ ν)_q s_q − (M ε + Φ_qᵀ ν)_x
//     Φ_q(q*) s_ε      = −Φ_q(q*) s_v − Φ̇_q s_q* − Φ̇_x,      s_v* = s_v + s_ε
void Projection::differentiate(Eigen::MatrixXd& q, Eigen::MatrixXd& v) {
  const int n = system_.coordinates(), m = system_.multipliers();
  const Rotations& rotations = mechanism_.rotations;
  const Eigen::MatrixXd before = q;
  Eigen::MatrixXd rhs;
  pleuel::pull_back(rotations, delta_, q);
  system_.design_derivative(projected_, ConstraintLevel::position, rhs);
  rhs.bottomRows(m) += (position_rows_.leftCols(n) * q).bottomRows(m);
  rhs.topRows(n) = (pull_q_of_positions_.leftCols(n) * before).topRows(n) + pull_x({delta_, eta_});
  rhs *= -1.0;
  solver_.solve(rhs);
  q += rhs.topRows(n);
  push_forward(rotations, delta_, q);

  system_.design_derivative(projected_, ConstraintLevel::velocity, rhs);
  rhs.bottomRows(m) += (velocity_rows_.leftCols(n) * v + rate_rows_.leftCols(n) * q).bottomRows(m);
  rhs.topRows(n) =
      (pull_q_of_velocities_.leftCols(n) * before).topRows(n) + pull_x({epsilon_, nu_});
  rhs *= -1.0;
  velocity_solver_.solve(rhs);
  v += rhs.topRows(n);
}

// The same, transposed: the last equation first.
void Projection::pull_back(Columns q, Columns v, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  const Rotations& rotations = mechanism_.rotations;
  Eigen::MatrixXd mu = Eigen::MatrixXd::Zero(n + m, q.cols()), rows = mu;
  mu.topRows(n) = v;
  velocity_solver_.solve_transposed(mu);
  rows.bottomRows(m) = mu.bottomRows(m);
  v -= velocity_rows_.leftCols(n).transpose() * rows;
  q -= rate_rows_.leftCols(n).transpose() * rows;
  add_constraint_sums(ConstraintLevel::velocity, mu, sums);
  add_pull_sums({epsilon_, nu_}, mu, sums);
  rows.setZero();
  rows.topRows(n) = mu.topRows(n);
  const Eigen::MatrixXd bent = pull_q_of_velocities_.leftCols(n).transpose() * rows;

  push_forward_transposed(rotations, delta_, q);
  mu.setZero();
  mu.topRows(n) = q;
  solver_.solve_transposed(mu);
  rows.setZero();
  rows.bottomRows(m) = mu.bottomRows(m);
  q -= position_rows_.leftCols(n).transpose() * rows;
  add_constraint_sums(ConstraintLevel::position, mu, sums);
  add_pull_sums({delta_, eta_}, mu, sums);
  pull_back_transposed(rotations, delta_, q);
  rows.setZero();
  rows.topRows(n) = mu.topRows(n);
  q -= bent + pull_q_of_positions_.leftCols(n).transpose() * rows;
}

/// −μᵀ Φ_x or −μᵀ Φ̇_x at the projected state.
void Projection::add_constraint_sums(ConstraintLevel level, const ConstColumns& mu, Columns sums) {
  Eigen::MatrixXd rows = -mu;
  rows.topRows(system_.coordinates()).setZero();
  system_.add_design_sums(projected_, level, rows, sums);
}

/// −μᵀ (M δ + Φ_qᵀ η)_x before the projection.
void Projection::add_pull_sums(const Pull& pull, const ConstColumns& mu, Columns sums) {
  Eigen::MatrixXd rows = mu;
  rows.bottomRows(system_.multipliers()).setZero();
  system_.add_design_sums(drifted_, ConstraintLevel::position, rows, sums);
  rows *= -1.0;
  hold(pull);
  system_.add_design_sums(drifted_, ConstraintLevel::position, rows, sums);
  release();
}

}  // namespace pleuel
