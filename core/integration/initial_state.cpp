#include "core/integration/initial_state.hpp"

#include <utility>

#include "core/integration/equilibrium.hpp"

namespace pleuel {

namespace {

void solve_accelerations(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix,
                         State& state) {
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  Eigen::VectorXd residual;
  system.tangent(state, {.a = 1.0}, ConstraintLevel::acceleration, matrix);
  factorize_for_start(solver, matrix, "accelerations");
  for (int i = 0; i < 2; ++i) {  // linear: the second solve removes round-off
    system.residual(state, ConstraintLevel::acceleration, residual);
    solver.solve(residual);
    state.a -= residual.head(n);
    state.lambda -= residual.tail(m);
  }
}

}  // namespace

bool jumps_at_start(Mechanism& mechanism, State state) {
  Eigen::VectorXd before, after;
  mechanism.system->residual(state, ConstraintLevel::acceleration, after);
  state.time = just_before_start;
  mechanism.system->residual(state, ConstraintLevel::acceleration, before);
  return before != after;
}

InitialState initial_state(Mechanism& mechanism) {
  System::Matrix matrix = mechanism.system->make_matrix();
  // Assembly weighs its equations by many orders of magnitude: an order for one kind does not suit
  // it.
  LinearSolver of_assembly(matrix), solver(matrix, mechanism.elastic);
  InitialState initial = assemble(mechanism, of_assembly, matrix);
  solve_accelerations(mechanism, solver, matrix, initial.state);
  if (!mechanism.starts_in_equilibrium) return initial;
  initial.state.time = just_before_start;
  initial = Equilibrium(mechanism).solve(std::move(initial));
  initial.state.time = 0.0;
  if (jumps_at_start(mechanism, initial.state)) {
    solve_accelerations(mechanism, solver, matrix, initial.state);
  }
  return initial;
}

}  // namespace pleuel
