#include "core/start/initial_state.hpp"

#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/start/equilibrium.hpp"

namespace pleuel {

namespace {

class Start {
 public:
  explicit Start(Mechanism& mechanism)
      : mechanism_(mechanism),
        matrix_(mechanism.system->make_matrix()),
        solver_(matrix_, mechanism.elastic) {}

  InitialState undeformed() {
    // Assembly weighs its equations by many orders of magnitude: an order for one kind does not
    // suit it.
    LinearSolver of_assembly(matrix_);
    InitialState initial = assemble(mechanism_, of_assembly, matrix_);
    set_accelerations(initial.state);
    return initial;
  }

  /// From the equations of motion, with the multipliers.
  void set_accelerations(State& state) {
    System& system = *mechanism_.system;
    const int n = system.coordinates(), m = system.multipliers();
    Eigen::VectorXd residual;
    system.tangent(state, {.a = 1.0}, ConstraintLevel::acceleration, matrix_);
    factorize_for_start(solver_, matrix_, "accelerations");
    for (int i = 0; i < 2; ++i) {  // linear: the second solve removes round-off
      system.residual(state, ConstraintLevel::acceleration, residual);
      solver_.solve(residual);
      state.a -= residual.head(n);
      state.lambda -= residual.tail(m);
    }
  }

 private:
  Mechanism& mechanism_;
  System::Matrix matrix_;
  LinearSolver solver_;
};

}  // namespace

bool jumps_at_start(Mechanism& mechanism, State state) {
  Eigen::VectorXd before, after;
  mechanism.system->residual(state, ConstraintLevel::acceleration, after);
  state.time = just_before_start;
  mechanism.system->residual(state, ConstraintLevel::acceleration, before);
  return before != after;
}

InitialState initial_state(Mechanism& mechanism, const State* similar) {
  Start start(mechanism);
  InitialState initial = start.undeformed();
  if (!mechanism.starts_in_equilibrium) return initial;
  initial.state.time = just_before_start;
  initial = Equilibrium(mechanism).solve(std::move(initial), similar);
  initial.state.time = 0.0;
  if (jumps_at_start(mechanism, initial.state)) start.set_accelerations(initial.state);
  return initial;
}

InitialState equilibrium_state(Mechanism& mechanism) {
  InitialState initial = Start(mechanism).undeformed();
  initial.state.time = just_before_start;
  return Equilibrium(mechanism).find(std::move(initial));
}

}  // namespace pleuel
