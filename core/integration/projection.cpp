#include "core/integration/projection.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/configuration.hpp"
#include "core/integration/initial_state.hpp"

namespace pleuel {

namespace {

/// Corrections that are smaller, relative to the scale of the coordinates, are round-off.
constexpr double tolerance = 1e-13;
/// Those below this that no longer shrink are, too.
constexpr double round_off = 1e-9;
constexpr int max_iterations = 20;
constexpr Weights by_q{.q = 1.0};

/// Calls correct(), which returns the size of a correction, until that is round-off.
template <class Correct>
bool converges(const Correct& correct) {
  double previous = 0.0;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    const double size = correct();
    if (size <= tolerance) return true;
    if (iteration > 1 && size > 0.5 * previous) return size <= round_off;
    previous = size;
  }
  return false;
}

}  // namespace

void Projection::Change::set_zero(const System& system) {
  move.setZero(system.coordinates());
  multipliers.setZero(system.multipliers());
}

Projection::Projection(Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      matrix_(system_.make_matrix()),
      position_solver_(matrix_, mechanism.elastic),
      velocity_solver_(matrix_, mechanism.elastic),
      drifted_(system_.coordinates(), system_.multipliers()),
      at_rest_(drifted_),
      projected_(drifted_),
      step_(system_.size()),
      zero_(Eigen::VectorXd::Zero(system_.coordinates())),
      position_rows_(matrix_),
      velocity_rows_(matrix_),
      rate_rows_(matrix_),
      pull_of_positions_q_(matrix_),
      pull_of_velocities_q_(matrix_),
      scratch_(matrix_) {}

bool Projection::apply(State& state) {
  drifted_.time = at_rest_.time = projected_.time = state.time;
  drifted_.q = projected_.q = state.q;
  start_ = projected_.v = state.v;
  projection_matrix(mechanism_, drifted_, matrix_);
  if (!position_solver_.factorize(matrix_) || !close_positions()) return false;
  at_rest_.q = projected_.q;
  system_.tangent(at_rest_, {.a = 1.0}, ConstraintLevel::acceleration, matrix_);
  if (!velocity_solver_.factorize(matrix_) || !close_velocities()) return false;
  state.q = projected_.q;
  state.v = projected_.v;
  return true;
}

double Projection::correct(LinearSolver& solver, Change& change) {
  const int n = system_.coordinates(), m = system_.multipliers();
  step_.head(n).setZero();
  step_.tail(m) = -residual_.tail(m);
  solver.solve(step_);
  change.move += step_.head(n);
  change.multipliers += step_.tail(m);
  return step_.head(n).cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>();
}

bool Projection::close_positions() {
  delta_.set_zero(system_);
  return converges([&] {
    system_.residual(projected_, ConstraintLevel::position, residual_);
    const double size = correct(position_solver_, delta_);
    advance(mechanism_.rotations, drifted_.q, delta_.move, projected_.q);
    return size;
  });
}

bool Projection::close_velocities() {
  epsilon_.set_zero(system_);
  const double speed = start_.cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>() + round_off;
  return converges([&] {
    system_.residual(projected_, ConstraintLevel::velocity, residual_);
    const double size = correct(velocity_solver_, epsilon_);
    projected_.v = start_ + epsilon_.move;
    return size / speed;
  });
}

void Projection::linearize(const State& drifted) {
  State state = drifted;
  const auto fail = [&] {
    throw SimulationError(
        fmt::format("the projection cannot be differentiated at t = {:.6g} s", drifted.time));
  };
  if (!apply(state)) fail();
  system_.tangent(projected_, by_q, ConstraintLevel::velocity, rate_rows_);
  system_.tangent(projected_, by_q, ConstraintLevel::position, velocity_rows_);
  position_rows_ = velocity_rows_;
  add_increment_tangent(mechanism_.rotations, delta_.move, velocity_rows_, 1.0, position_rows_);
  // [ W  Φ_q(q)ᵀ ; Φ_q(q*) T(δ)  0 ]
  projection_matrix(mechanism_, drifted_, matrix_);
  const int n = system_.coordinates();
  for (int k = 0; k < matrix_.outerIndexPtr()[n]; ++k) {
    if (matrix_.innerIndexPtr()[k] >= n) matrix_.valuePtr()[k] = position_rows_.valuePtr()[k];
  }
  if (!position_solver_.factorize(matrix_)) fail();
  set_tangent(pull_of_positions(), pull_of_positions_q_);
  set_tangent(pull_of_velocities(), pull_of_velocities_q_);
}

void Projection::Pull::hold() const {
  at_rest.a = a;
  at_rest.lambda = lambda;
}

void Projection::Pull::release() const {
  at_rest.a.setZero();
  at_rest.lambda.setZero();
}

void Projection::set_tangent(const Pull& pull, System::Matrix& tangent) {
  system_.tangent(pull.at_rest, by_q, ConstraintLevel::position, scratch_);
  pull.hold();
  system_.tangent(pull.at_rest, by_q, ConstraintLevel::position, tangent);
  pull.release();
  tangent -= scratch_;
}

Eigen::MatrixXd Projection::design_derivative(const Pull& pull) {
  Eigen::MatrixXd with, without;
  system_.design_derivative(pull.at_rest, ConstraintLevel::position, without);
  pull.hold();
  system_.design_derivative(pull.at_rest, ConstraintLevel::position, with);
  pull.release();
  return (with - without).topRows(system_.coordinates());
}

// With s⁻ = T(δ)⁻ᵀ s_q of rotations:
//     W s_δ + Φ_q(q)ᵀ s_η = −(Φ_qᵀ η)_q s_q − (Φ_qᵀ η)_x
//     Φ_q(q*) T(δ) s_δ    = −Φ_q(q*) T(δ) s⁻ − Φ_x(q*),          s_q* = T(δ) (s⁻ + s_δ)
//     M s_ε + Φ_q(q*)ᵀ s_ν = −(M ε + Φ_qᵀ ν)_q s_q* − (M ε + Φ_qᵀ ν)_x
//     Φ_q(q*) s_ε          = −Φ_q(q*) s_v − Φ̇_q s_q* − Φ̇_x,      s_v* = s_v + s_ε
void Projection::differentiate(Eigen::MatrixXd& q, Eigen::MatrixXd& v) {
  const int n = system_.coordinates(), m = system_.multipliers();
  const Rotations& rotations = mechanism_.rotations;
  Eigen::MatrixXd rhs;
  system_.design_derivative(projected_, ConstraintLevel::position, rhs);
  rhs.topRows(n) =
      (pull_of_positions_q_.leftCols(n) * q).topRows(n) + design_derivative(pull_of_positions());
  pleuel::pull_back(rotations, delta_.move, q);
  rhs.bottomRows(m) += (position_rows_.leftCols(n) * q).bottomRows(m);
  rhs *= -1.0;
  position_solver_.solve(rhs);
  q += rhs.topRows(n);
  push_forward(rotations, delta_.move, q);

  system_.design_derivative(projected_, ConstraintLevel::velocity, rhs);
  rhs.topRows(n) =
      (pull_of_velocities_q_.leftCols(n) * q).topRows(n) + design_derivative(pull_of_velocities());
  rhs.bottomRows(m) += (velocity_rows_.leftCols(n) * v + rate_rows_.leftCols(n) * q).bottomRows(m);
  rhs *= -1.0;
  velocity_solver_.solve(rhs);
  v += rhs.topRows(n);
}

// The same, transposed: the last equation first.
void Projection::pull_back(Columns q, Columns v, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  const Rotations& rotations = mechanism_.rotations;
  Eigen::MatrixXd mu = Eigen::MatrixXd::Zero(n + m, q.cols()), forces = mu, constraints = mu;
  const auto split = [&] {
    forces.topRows(n) = mu.topRows(n);
    constraints.bottomRows(m) = mu.bottomRows(m);
  };
  mu.topRows(n) = v;
  velocity_solver_.solve_transposed(mu);
  split();
  v -= velocity_rows_.leftCols(n).transpose() * constraints;
  q -= rate_rows_.leftCols(n).transpose() * constraints;
  q -= pull_of_velocities_q_.leftCols(n).transpose() * forces;
  add_constraint_sums(ConstraintLevel::velocity, constraints, sums);
  add_sums(pull_of_velocities(), forces, sums);

  push_forward_transposed(rotations, delta_.move, q);
  mu.setZero();
  mu.topRows(n) = q;
  position_solver_.solve_transposed(mu);
  split();
  q -= position_rows_.leftCols(n).transpose() * constraints;
  pull_back_transposed(rotations, delta_.move, q);
  q -= pull_of_positions_q_.leftCols(n).transpose() * forces;
  add_constraint_sums(ConstraintLevel::position, constraints, sums);
  add_sums(pull_of_positions(), forces, sums);
}

/// −μᵀ Φ_x or −μᵀ Φ̇_x at the projected state.
void Projection::add_constraint_sums(ConstraintLevel level, const ConstColumns& mu, Columns sums) {
  const Eigen::MatrixXd rows = -mu;
  system_.add_design_sums(projected_, level, rows, sums);
}

/// −μᵀ (M a + Φ_qᵀ λ)_x.
void Projection::add_sums(const Pull& pull, const ConstColumns& mu, Columns sums) {
  system_.add_design_sums(pull.at_rest, ConstraintLevel::position, mu, sums);
  const Eigen::MatrixXd rows = -mu;
  pull.hold();
  system_.add_design_sums(pull.at_rest, ConstraintLevel::position, rows, sums);
  pull.release();
}

}  // namespace pleuel
