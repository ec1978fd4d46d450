#include "core/integration/initial_state.hpp"

#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/configuration.hpp"
#include "core/integration/equilibrium.hpp"

namespace pleuel {

namespace {

constexpr int max_iterations = 50;

void factorize_or_throw(LinearSolver& solver, const System::Matrix& matrix, const char* what) {
  if (solver.factorize(matrix)) return;
  throw SimulationError(fmt::format(
      "the mechanism cannot be started: the equations of its initial {} are singular; look for "
      "joints that constrain the same motion twice, or for a body that nothing holds and that has "
      "no inertia",
      what));
}

/// Assembly moves bodies; if it must deform them by more than a hundredth, the joints do not fit.
void check_strain(const Mechanism& mechanism, const Eigen::VectorXd& q) {
  // The scale of elastic coordinates is a thousandth of the mechanism's size.
  const double moved =
      (q - mechanism.guess.q).cwiseQuotient(mechanism.scale).lpNorm<Eigen::Infinity>();
  if (moved <= 10.0) return;
  throw SimulationError(
      "the mechanism cannot be assembled without straining its bodies; check the points of the "
      "joints and the lengths of the bodies");
}

void assemble_positions(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix,
                        InitialState& initial) {
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  Eigen::VectorXd residual;
  State at = initial.state;
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    system.residual(at, ConstraintLevel::position, residual);
    const double violation = m > 0 ? residual.tail(m).lpNorm<Eigen::Infinity>() : 0.0;
    projection_matrix(mechanism, at, matrix);
    factorize_or_throw(solver, matrix, "positions");
    Eigen::VectorXd step(n + m);
    step.head(n) = -mechanism.assembly_weight.cwiseProduct(
        difference(mechanism.rotations, at.q, mechanism.guess.q));
    step.tail(m) = -residual.tail(m);
    solver.solve(step);
    const Eigen::VectorXd before = at.q;
    advance(mechanism.rotations, before, step.head(n), at.q);
    if (!at.q.allFinite()) break;
    const double correction = step.head(n).cwiseQuotient(mechanism.scale).lpNorm<Eigen::Infinity>();
    // The projection converges linearly where the guess is loose: on, down to round-off.
    const bool is_at_rest = correction < 1e-15 || correction > 0.3 * previous;
    previous = correction;
    if (violation < 1e-10 && correction < 1e-10 && is_at_rest) {
      check_strain(mechanism, at.q);
      initial.state.q = at.q;
      initial.position_multipliers = step.tail(m);
      return;
    }
  }
  throw SimulationError(
      "the mechanism cannot be assembled: its joints cannot all be closed near the given "
      "positions; check the points of the joints and the lengths of the bodies");
}

void project_velocities(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix,
                        InitialState& initial) {
  State& state = initial.state;
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  Eigen::VectorXd residual;
  system.residual(state, ConstraintLevel::velocity, residual);
  projection_matrix(mechanism, state, matrix);
  factorize_or_throw(solver, matrix, "velocities");
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n + m);
  step.tail(m) = -residual.tail(m);
  solver.solve(step);
  state.v += step.head(n);
  initial.velocity_multipliers = step.tail(m);
}

void solve_accelerations(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix,
                         State& state) {
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  Eigen::VectorXd residual;
  system.tangent(state, {.a = 1.0}, ConstraintLevel::acceleration, matrix);
  factorize_or_throw(solver, matrix, "accelerations");
  for (int i = 0; i < 2; ++i) {  // linear: the second solve removes round-off
    system.residual(state, ConstraintLevel::acceleration, residual);
    solver.solve(residual);
    state.a -= residual.head(n);
    state.lambda -= residual.tail(m);
  }
}

}  // namespace

void projection_matrix(Mechanism& mechanism, const State& state, System::Matrix& matrix) {
  const int n = mechanism.system->coordinates();
  mechanism.system->tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
  scale_dynamic_block(n, 0.0, matrix);
  for (int i = 0; i < n; ++i) matrix.coeffRef(i, i) = mechanism.assembly_weight(i);
}

InitialState initial_state(Mechanism& mechanism) {
  InitialState initial;
  initial.state = mechanism.guess;
  initial.state.a.setZero();
  initial.state.lambda.setZero();
  System::Matrix matrix = mechanism.system->make_matrix();
  LinearSolver solver(matrix);
  assemble_positions(mechanism, solver, matrix, initial);
  project_velocities(mechanism, solver, matrix, initial);
  solve_accelerations(mechanism, solver, matrix, initial.state);
  if (!mechanism.starts_in_equilibrium) return initial;
  return Equilibrium(mechanism).solve(std::move(initial));
}

}  // namespace pleuel
