#include "core/integration/projection.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/start/assembly.hpp"

namespace pleuel {

namespace {

/// Corrections that are smaller, relative to the scale of the coordinates, are round-off.
constexpr double projection_tolerance = 1e-13;
/// Those below this that no longer shrink are, too.
constexpr double projection_round_off = 1e-9;
constexpr int max_projections = 20;
constexpr Weights by_q{.q = 1.0};

/// Calls correct(), which returns the size of a correction, until that is round-off.
template <class Correct>
bool converges(const Correct& correct) {
  double previous = 0.0;
  for (int iteration = 1; iteration <= max_projections; ++iteration) {
    const double size = correct();
    if (size <= projection_tolerance) return true;
    if (iteration > 1 && size > 0.5 * previous) return size <= projection_round_off;
    previous = size;
  }
  return false;
}

}  // namespace

void Projection::Change::set_zero(const System& system) {
  move.setZero(system.coordinates());
  multipliers.setZero(system.multipliers());
}

Projection::Projection(const Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      matrix_(system_.make_matrix()),
      position_solver_(matrix_, mechanism.elastic),
      velocity_solver_(matrix_, mechanism.elastic),
      drifted_(system_.coordinates(), system_.multipliers()),
      at_rest_(drifted_),
      projected_(drifted_),
      step_(system_.size()),
      position_rows_(matrix_),
      velocity_rows_(matrix_),
      rate_rows_(matrix_),
      position_forces_(system_),
      velocity_forces_(system_),
      position_forces_q_(matrix_),
      velocity_forces_q_(matrix_) {}

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
  const double speed =
      start_.cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>() + projection_round_off;
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
  position_forces_.set(drifted_, delta_.multipliers);
  position_forces_.tangent(position_forces_q_);
  velocity_forces_.set(at_rest_, epsilon_.move, epsilon_.multipliers);
  velocity_forces_.tangent(velocity_forces_q_);
}

// With s⁻ = T(δ)⁻ᵀ s_q of rotations:
//     W s_δ + Φ_q(q)ᵀ s_η = −(Φ_qᵀ η)_q s_q − (Φ_qᵀ η)_x
//     Φ_q(q*) T(δ) s_δ    = −Φ_q(q*) T(δ) s⁻ − Φ_x(q*),          s_q* = T(δ) (s⁻ + s_δ)
//     M s_ε + Φ_q(q*)ᵀ s_ν = −(M ε + Φ_qᵀ ν)_q s_q* − (M ε + Φ_qᵀ ν)_x
//     Φ_q(q*) s_ε          = −Φ_q(q*) s_v − Φ̇_q s_q* − Φ̇_x,      s_v* = s_v + s_ε
void Projection::differentiate(Eigen::MatrixXd& q, Eigen::MatrixXd& v, DerivativesOf of) {
  const int n = system_.coordinates(), m = system_.multipliers();
  const Rotations& rotations = mechanism_.rotations;
  Eigen::MatrixXd rhs;
  const bool is_of_design = of == DerivativesOf::design;
  rhs.setZero(n + m, q.cols());
  if (is_of_design) {
    system_.design_derivative(projected_, ConstraintLevel::position, rhs);
    rhs.topRows(n) = position_forces_.design_derivative().topRows(n);
  }
  rhs.topRows(n) += (position_forces_q_.leftCols(n) * q).topRows(n);
  pleuel::pull_back(rotations, delta_.move, q);
  rhs.bottomRows(m) += (position_rows_.leftCols(n) * q).bottomRows(m);
  rhs *= -1.0;
  position_solver_.solve(rhs);
  q += rhs.topRows(n);
  push_forward(rotations, delta_.move, q);

  rhs.setZero();
  if (is_of_design) {
    system_.design_derivative(projected_, ConstraintLevel::velocity, rhs);
    rhs.topRows(n) = velocity_forces_.design_derivative().topRows(n);
  }
  rhs.topRows(n) += (velocity_forces_q_.leftCols(n) * q).topRows(n);
  rhs.bottomRows(m) += (velocity_rows_.leftCols(n) * v + rate_rows_.leftCols(n) * q).bottomRows(m);
  rhs *= -1.0;
  velocity_solver_.solve(rhs);
  v += rhs.topRows(n);
}

// The same, transposed: the last equation first.
void Projection::differentiate_transposed(Columns q, Columns v, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  const Rotations& rotations = mechanism_.rotations;
  Eigen::MatrixXd mu = Eigen::MatrixXd::Zero(n + m, q.cols()), forces = mu, constraints = mu;
  const auto split = [&] {
    forces.topRows(n) = -mu.topRows(n);
    constraints.bottomRows(m) = -mu.bottomRows(m);
  };
  mu.topRows(n) = v;
  velocity_solver_.solve_transposed(mu);
  split();
  v += velocity_rows_.leftCols(n).transpose() * constraints;
  q += rate_rows_.leftCols(n).transpose() * constraints;
  q += velocity_forces_q_.leftCols(n).transpose() * forces;
  system_.add_parameter_adjoints(projected_, ConstraintLevel::velocity, constraints, sums);
  velocity_forces_.add_parameter_adjoints(forces, sums);

  push_forward_transposed(rotations, delta_.move, q);
  mu.setZero();
  mu.topRows(n) = q;
  position_solver_.solve_transposed(mu);
  split();
  q += position_rows_.leftCols(n).transpose() * constraints;
  pull_back_transposed(rotations, delta_.move, q);
  q += position_forces_q_.leftCols(n).transpose() * forces;
  system_.add_parameter_adjoints(projected_, ConstraintLevel::position, constraints, sums);
  position_forces_.add_parameter_adjoints(forces, sums);
}

}  // namespace pleuel
