#include "sensitivity/adjoint.hpp"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/integration/corner_jump.hpp"
#include "core/integration/period_map.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/step_equations.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"
#include "sensitivity/initial_sensitivity.hpp"

namespace pleuel {

namespace {

class AdjointRun {
 public:
  AdjointRun(Mechanism& mechanism, const Trajectory& trajectory, int functions)
      : mechanism_(mechanism),
        system_(*mechanism.system),
        trajectory_(trajectory),
        scheme_(trajectory.scheme),
        equations_(mechanism, scheme_, trajectory.formulation),
        state_(equations_.make_state(State(system_.coordinates(), system_.multipliers()))),
        old_(state_),
        matrix_(equations_.make_matrix()),
        solver_(matrix_, mechanism.elastic),
        adjoint_(zero_sensitivity(system_, functions)),
        before_(adjoint_),
        y_(Eigen::MatrixXd::Zero(equations_.size(), functions)),
        sums_(Eigen::MatrixXd::Zero(system_.parameter_adjoint_count(), functions)) {
    if (trajectory.is_projected()) projection_.emplace(mechanism);
    if (!trajectory.corners.empty()) corner_.emplace(mechanism);
  }

  Eigen::MatrixXd run(const FunctionDerivatives& derivatives) {
    if (trajectory_.periodic) require_repeated_derivatives(mechanism_, trajectory_);
    go_back_from(trajectory_.steps(), derivatives);
    if (trajectory_.periodic) {
      derivatives(0, state_, adjoint_);
      go_back_through_periods();
      return system_.design_gradients(sums_);
    }
    const StateSensitivity start = initial_sensitivity(mechanism_, initial_state(mechanism_));
    const Eigen::MatrixXd of_steps =
        system_.design_gradients(sums_) +
        along(first_step_sensitivity(mechanism_, trajectory_, state_, start), adjoint_);
    adjoint_ = zero_sensitivity(system_, sums_.cols());
    derivatives(0, state_, adjoint_);
    return of_steps + along(start, adjoint_);
  }

 private:
  static Eigen::MatrixXd along(const StateSensitivity& s, const StateAdjoint& adjoint) {
    return s.q.transpose() * adjoint.q + s.v.transpose() * adjoint.v + s.a.transpose() * adjoint.a +
           s.w.transpose() * adjoint.w + s.lambda.transpose() * adjoint.lambda;
  }

  /// Down to the start.
  void go_back_from(int last, const FunctionDerivatives& derivatives) {
    trajectory_.states->load_record(last, state_);
    for (int step = last; step > 0; --step) {
      check_stop();
      active_ = derivatives(step, state_, adjoint_);
      trajectory_.states->load_record(step - 1, old_);
      if (active_ > 0) go_back(step);
      std::swap(static_cast<RecordedState&>(state_), static_cast<RecordedState&>(old_));
    }
  }

  /// A start that is the end of its period depends on x by dy₀/dx = (1 − M)⁻¹ ∂Y/∂x
  /// (initial_sensitivity.hpp). With p, the derivatives with respect to it, and (1 − M)ᵀ π = p,
  ///     pᵀ dy₀/dx = πᵀ ∂Y/∂x
  /// is what going back from π through the period adds to the sums. As the map is one of a motion
  /// close by, this is done again with what is left of p, until that is round-off. Multipliers at
  /// the start are those at the end.
  void go_back_through_periods() {
    const PeriodicStart& periodic = *trajectory_.periodic;
    const StackedStates& states = periodic.map->states();
    // stack() divides states by the units; derivatives with respect to states are multiplied.
    const Eigen::VectorXd squares = states.units().cwiseAbs2();
    const auto stacked = [&]() -> Eigen::MatrixXd {
      return squares.asDiagonal() * states.stack(adjoint_);
    };
    Eigen::MatrixXd left = stacked();
    Eigen::MatrixXd whole = left.cwiseAbs();
    PeriodicCorrection progress;
    while (!progress.is_done(left, sizes_of(whole)) || !adjoint_.lambda.isZero(0.0)) {
      const Eigen::MatrixXd end = progress.map(mechanism_, trajectory_).solve_transposed(left);
      StateAdjoint after = states.unstack(squares.cwiseInverse().asDiagonal() * end);
      after.lambda = std::move(adjoint_.lambda);
      adjoint_ = std::move(after);
      const auto all = static_cast<int>(sums_.cols());
      go_back_from(periodic.steps, [all](int, const State&, StateAdjoint&) { return all; });
      left += stacked() - end;
      whole = whole.cwiseMax(left.cwiseAbs());
    }
  }

  /// From derivatives with respect to the end of a step to those with respect to its beginning.
  void go_back(int step) {
    project();
    prepare(step);
    solve();
    if (!y_.leftCols(active_).allFinite()) {
      throw SimulationError(
          fmt::format("the adjoint is not finite at t = {:.6g} s (step {})", state_.time, step));
    }
    if (!solver_.is_accurate()) {
      throw SimulationError(fmt::format(
          "the equations of the adjoint at t = {:.6g} s (step {}) are met to {:.1e} only",
          state_.time, step, solver_.backward_error()));
    }
    const auto of = [this](Eigen::MatrixXd& all) { return all.leftCols(active_); };
    before_.q.setZero();
    equations_.differentiate_transposed(state_, of(y_), of(adjoint_.v), of(adjoint_.a),
                                        of(before_.q), of(sums_));
    combine();
    std::swap(adjoint_, before_);
    adjoint_.lambda.setZero();
    pass_corner(step);
  }

  /// What a step adds at the corner that it sets out from.
  void pass_corner(int step) {
    if (!trajectory_.is_corner(step - 1) || !corner_->find(old_, scheme_.step)) return;
    auto v = adjoint_.v.leftCols(active_), a = adjoint_.a.leftCols(active_);
    const auto w = adjoint_.w.leftCols(active_);
    corner_->differentiate_transposed(
        {a + w, trajectory_.weight_of_jerk(step) * v + scheme_.delay * w},
        {adjoint_.q.leftCols(active_), v, a, sums_.leftCols(active_)});
  }

  /// Leaves the state as it was before the projection.
  void project() {
    if (!projection_) return;
    state_.q = state_.drifted_q;
    state_.v = state_.drifted_v;
    projection_->linearize(state_);
    projection_->differentiate_transposed(adjoint_.q.leftCols(active_),
                                          adjoint_.v.leftCols(active_), sums_.leftCols(active_));
  }

  void prepare(int step) {
    scheme_ = trajectory_.scheme_of(step);
    equations_.set_scheme(scheme_);
    equations_.begin(old_);
    state_.increment = difference(mechanism_.rotations, state_.q, old_.q);
    equations_.linearize_sensitivities(state_, matrix_);
    if (!solver_.factorize(matrix_)) {
      throw SimulationError(
          fmt::format("the adjoint is singular at t = {:.6g} s (step {})", state_.time, step));
    }
  }

  /// y = J⁻ᵀ (derivatives with respect to z, s λ, δ, η).
  void solve() {
    const int n = system_.coordinates(), m = system_.multipliers();
    const Eigen::Vector4d b = scheme_.correction / scheme_.correction(0);
    auto q = adjoint_.q.leftCols(active_);
    push_forward_transposed(mechanism_.rotations, state_.increment, q);
    auto y = y_.leftCols(active_);
    y.topRows(n) = q + b(1) * adjoint_.v.leftCols(active_) + b(2) * adjoint_.a.leftCols(active_) +
                   b(3) * adjoint_.w.leftCols(active_);
    y.middleRows(n, m) = adjoint_.lambda.leftCols(active_) / scheme_.dynamic_scale();
    if (y.rows() > n + m) {
      y.middleRows(n + m, n) = q;
      y.bottomRows(m).setZero();
    }
    solver_.solve_transposed(y);
  }

  /// The transposed of the prediction; before_.q holds what is added in the end.
  void combine() {
    const Eigen::Matrix4d& h = scheme_.history;
    const Eigen::Vector4d b = scheme_.correction / scheme_.correction(0);
    const auto v = adjoint_.v.leftCols(active_), a = adjoint_.a.leftCols(active_),
               w = adjoint_.w.leftCols(active_);
    auto q = adjoint_.q.leftCols(active_);
    q = -b(1) * v - b(2) * a - b(3) * w;
    const auto combine = [&](int column) {
      return h(0, column) * q + h(1, column) * v + h(2, column) * a + h(3, column) * w;
    };
    before_.v.leftCols(active_) = combine(1);
    before_.a.leftCols(active_) = combine(2);
    before_.w.leftCols(active_) = combine(3);
    q = combine(0).eval();
    pull_back_transposed(mechanism_.rotations, state_.increment, q);
    before_.q.leftCols(active_) += q;
  }

  Mechanism& mechanism_;
  System& system_;
  const Trajectory& trajectory_;
  Scheme scheme_;
  StepEquations equations_;
  StepState state_, old_;
  System::Matrix matrix_;
  LinearSolver solver_;
  std::optional<CornerJump> corner_;
  int active_ = 0;
  StateAdjoint adjoint_, before_;
  Eigen::MatrixXd y_, sums_;
  std::optional<Projection> projection_;
};

}  // namespace

Eigen::MatrixXd adjoint_gradients(Mechanism& mechanism, const Trajectory& trajectory, int functions,
                                  const FunctionDerivatives& derivatives) {
  return AdjointRun(mechanism, trajectory, functions).run(derivatives);
}

}  // namespace pleuel
