#include "sensitivity/direct.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/configuration.hpp"
#include "core/integration/linear_solver.hpp"
#include "sensitivity/initial_sensitivity.hpp"

namespace pleuel {

namespace {

class DirectDifferentiation {
 public:
  DirectDifferentiation(Mechanism& mechanism, const Trajectory& trajectory)
      : system_(*mechanism.system),
        rotations_(mechanism.rotations),
        trajectory_(trajectory),
        sensitivity_(initial_sensitivity(mechanism, initial_state(mechanism))),
        old_(sensitivity_),
        state_(system_.coordinates(), system_.multipliers()),
        matrices_(rotations_.empty() ? 3 : 4, system_.make_matrix()),
        solver_(matrices_[0]) {}

  void run(const SensitivityObserver& observer) {
    trajectory_.load(0, state_);
    observer(0, state_, sensitivity_);
    for (int step = 1; step <= trajectory_.steps(); ++step) {
      old_q_ = state_.q;
      trajectory_.load(step, state_);
      increment_ = difference(rotations_, state_.q, old_q_);
      predict();
      form_right_hand_side();
      solve(step);
      observer(step, state_, sensitivity_);
    }
  }

 private:
  /// ŝ = history · s, then shifted along the correction to ŝ_q = 0: the unknown is s_q itself, in
  /// the rows of rotations T(Δ)⁻¹ s_q.
  void predict() {
    std::swap(old_, sensitivity_);
    pull_back(rotations_, increment_, old_.q);
    const Eigen::Matrix4d& h = trajectory_.scheme.history;
    const auto combine = [&](int row, Eigen::MatrixXd& out) {
      out = h(row, 0) * old_.q + h(row, 1) * old_.v + h(row, 2) * old_.a + h(row, 3) * old_.w;
    };
    combine(0, sensitivity_.q);
    combine(1, sensitivity_.v);
    combine(2, sensitivity_.a);
    combine(3, sensitivity_.w);
    const Eigen::Vector4d& b = trajectory_.scheme.correction;
    sensitivity_.v -= b(1) / b(0) * sensitivity_.q;
    sensitivity_.a -= b(2) / b(0) * sensitivity_.q;
    sensitivity_.w -= b(3) / b(0) * sensitivity_.q;
  }

  /// One evaluation gives the step matrix, C and M.
  void form_right_hand_side() {
    const int n = system_.coordinates();
    const Eigen::Vector4d& b = trajectory_.scheme.correction;
    const std::array<Weights, 4> weights{{{b(0), b(1), b(2)}, {.v = 1.0}, {.a = 1.0}, {.q = 1.0}}};
    system_.linearize(state_, WeightList(weights.data(), matrices_.size()),
                      ConstraintLevel::position, residual_, matrices_);
    if (!rotations_.empty()) {
      add_increment_tangent(rotations_, increment_, matrices_[3], b(0), matrices_[0]);
    }
    system_.design_derivative(state_, ConstraintLevel::position, rhs_);
    rhs_.noalias() += matrices_[1].leftCols(n) * sensitivity_.v;
    rhs_.noalias() += matrices_[2].leftCols(n) * sensitivity_.a;
    rhs_.topRows(n) *= trajectory_.scheme.dynamic_scale();
    rhs_ *= -1.0;
  }

  void solve(int step) {
    const int n = system_.coordinates();
    const Eigen::Vector4d& b = trajectory_.scheme.correction;
    const double scale = trajectory_.scheme.dynamic_scale();
    scale_dynamic_block(n, scale, matrices_[0]);
    if (!solver_.factorize(matrices_[0])) {
      throw SimulationError(fmt::format("the sensitivities are singular at t = {:.6g} s (step {})",
                                        state_.time, step));
    }
    solver_.solve(rhs_);
    sensitivity_.q = rhs_.topRows(n);
    sensitivity_.lambda = rhs_.bottomRows(system_.multipliers()) / scale;
    sensitivity_.v += b(1) / b(0) * sensitivity_.q;
    sensitivity_.a += b(2) / b(0) * sensitivity_.q;
    sensitivity_.w += b(3) / b(0) * sensitivity_.q;
    push_forward(rotations_, increment_, sensitivity_.q);
  }

  System& system_;
  const Rotations& rotations_;
  const Trajectory& trajectory_;
  StateSensitivity sensitivity_, old_;
  State state_;
  Eigen::VectorXd old_q_, increment_;
  std::vector<System::Matrix> matrices_;  ///< of the step, C, M and, where there are rotations, R_q
  Eigen::VectorXd residual_;
  LinearSolver solver_;
  Eigen::MatrixXd rhs_;
};

}  // namespace

void differentiate(Mechanism& mechanism, const Trajectory& trajectory,
                   const SensitivityObserver& observer) {
  DirectDifferentiation(mechanism, trajectory).run(observer);
}

}  // namespace pleuel
