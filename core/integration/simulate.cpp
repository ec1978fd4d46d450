#include "core/integration/simulate.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/configuration.hpp"
#include "core/integration/initial_state.hpp"
#include "core/integration/linear_solver.hpp"

namespace pleuel {

void Trajectory::load(int step, State& state) const {
  state.time = time(step);
  state.q = q.col(step);
  state.v = v.col(step);
  state.a = a.col(step);
  state.lambda = lambda.col(step);
}

int step_count(const SimulationOptions& options) {
  // A step that divides the time up to round-off is not shortened.
  return std::max(1, static_cast<int>(std::ceil(options.end_time / options.step * (1 - 1e-12))));
}

namespace {

/// Factors are renewed where the corrections shrink by less than this.
constexpr double slow_rate = 0.1;
/// Scaled corrections below this that no longer shrink are round-off.
constexpr double round_off = 1e-9;

/// Every so many steps a second iteration is made to see how fast the method converges.
constexpr int curvature_interval = 16;

class TimeLoop {
 public:
  TimeLoop(Mechanism& mechanism, const SimulationOptions& options)
      : system_(*mechanism.system),
        rotations_(mechanism.rotations),
        scale_(mechanism.scale),
        options_(options),
        steps_(step_count(options)),
        scheme_(generalized_alpha(options.end_time / steps_, options.spectral_radius)),
        state_(initial_state(mechanism).state),
        w_(state_.a),
        matrices_(rotations_.empty() ? 1 : 2, system_.make_matrix()),
        solver_(matrices_[0]),
        correction_(system_.size()) {}

  Trajectory run() {
    allocate();
    store(0);
    for (int step = 1; step <= steps_; ++step) {
      predict(step);
      correct(step);
      store(step);
    }
    trajectory_.factorizations = solver_.factorizations();
    return std::move(trajectory_);
  }

 private:
  void allocate() {
    const int n = system_.coordinates();
    trajectory_.scheme = scheme_;
    trajectory_.time.resize(steps_ + 1);
    for (auto* matrix : {&trajectory_.q, &trajectory_.v, &trajectory_.a}) {
      matrix->resize(n, steps_ + 1);
    }
    trajectory_.lambda.resize(system_.multipliers(), steps_ + 1);
    for (auto* vector : {&old_q_, &old_v_, &old_a_, &old_w_, &increment_}) vector->resize(n);
    residual_.resize(system_.size());
  }

  void store(int step) {
    trajectory_.time(step) = state_.time;
    trajectory_.q.col(step) = state_.q;
    trajectory_.v.col(step) = state_.v;
    trajectory_.a.col(step) = state_.a;
    trajectory_.lambda.col(step) = state_.lambda;
  }

  /// y⁺ = history · y (for q as q ⊕ increment), then the correction that keeps the acceleration.
  void predict(int step) {
    const Eigen::Matrix4d& h = scheme_.history;
    old_q_ = state_.q;
    old_v_ = state_.v;
    old_a_ = state_.a;
    old_w_ = w_;
    increment_ = h(0, 1) * old_v_ + h(0, 2) * old_a_ + h(0, 3) * old_w_;
    state_.v = h(1, 0) * old_q_ + h(1, 1) * old_v_ + h(1, 2) * old_a_ + h(1, 3) * old_w_;
    state_.a = h(2, 0) * old_q_ + h(2, 1) * old_v_ + h(2, 2) * old_a_ + h(2, 3) * old_w_;
    w_ = h(3, 0) * old_q_ + h(3, 1) * old_v_ + h(3, 2) * old_a_ + h(3, 3) * old_w_;
    correction_.head(system_.coordinates()) = (old_a_ - state_.a) / scheme_.correction(2);
    apply(correction_.head(system_.coordinates()));
    state_.time = options_.end_time * step / steps_;
  }

  template <class Vector>
  void apply(const Vector& z) {
    increment_ += scheme_.correction(0) * z;
    advance(rotations_, old_q_, increment_, state_.q);
    state_.v += scheme_.correction(1) * z;
    state_.a += scheme_.correction(2) * z;
    w_ += scheme_.correction(3) * z;
  }

  /// Newton's method that keeps the factors within the step while they serve.
  void correct(int step) {
    const int n = system_.coordinates(), m = system_.multipliers();
    const double s = scheme_.dynamic_scale();
    bool is_stale = true;
    double previous = 0.0;
    for (int iteration = 1; iteration <= options_.max_newton_iterations; ++iteration) {
      ++trajectory_.newton_iterations;
      const bool is_fresh = is_stale;
      if (is_stale) {
        linearize(step, iteration);
      } else {
        system_.residual(state_, ConstraintLevel::position, residual_);
      }
      correction_.head(n) = -s * residual_.head(n);
      correction_.tail(m) = -residual_.tail(m);
      solver_.solve(correction_);
      apply(correction_.head(n));
      state_.lambda += correction_.tail(m) / s;
      const double size = correction_.head(n).cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
      if (!std::isfinite(size)) fail(step, iteration, "the solution is not finite");
      double error = std::min(size, curvature_ * size * size);
      if (iteration > 1) {
        error = size * std::min(1.0, size / previous);
        if (iteration == 2) note_curvature(size / (previous * previous));
      } else if (step % curvature_interval == 1) {
        error = size;  // go on, to see the curvature
      }
      if (error <= options_.newton_tolerance) return;
      const bool is_slow = iteration > 1 && size > slow_rate * previous;
      if (is_slow && is_fresh && size < round_off) return;
      is_stale = is_slow;
      previous = size;
    }
    fail(step, options_.max_newton_iterations, "Newton's method does not converge");
  }

  /// c of  |δ₂| = c |δ₁|²: how Newton's method converges quadratically here. It may fall slowly
  /// only.
  void note_curvature(double seen) {
    curvature_ = std::isfinite(curvature_) ? std::max(seen, 0.5 * curvature_) : seen;
  }

  void linearize(int step, int iteration) {
    const Weights weights{scheme_.correction(0), scheme_.correction(1), scheme_.correction(2)};
    const std::array<Weights, 2> all{weights, {.q = 1.0}};
    const WeightList used(all.data(), matrices_.size());
    System::Matrix& matrix = matrices_[0];
    system_.linearize(state_, used, ConstraintLevel::position, residual_, matrices_);
    if (!rotations_.empty()) {
      add_increment_tangent(rotations_, increment_, matrices_[1], weights.q, matrix);
    }
    scale_dynamic_block(system_.coordinates(), scheme_.dynamic_scale(), matrix);
    if (!solver_.factorize(matrix)) fail(step, iteration, "the step matrix is singular");
  }

  [[noreturn]] void fail(int step, int iteration, const char* what) const {
    throw SimulationError(fmt::format(
        "simulation stopped at t = {:.6g} s (step {} of {}, Newton iteration {}): {}; largest "
        "residual {:.3g}. Try a smaller /simulation/step (now {:.3g} s), or look for a position in "
        "which the mechanism locks",
        state_.time, step, steps_, iteration, what, residual_.lpNorm<Eigen::Infinity>(),
        scheme_.step));
  }

  System& system_;
  const Rotations& rotations_;
  const Eigen::VectorXd& scale_;
  SimulationOptions options_;
  int steps_;
  Scheme scheme_;
  State state_;
  Eigen::VectorXd w_;
  std::vector<System::Matrix> matrices_;  ///< of the step and, where there are rotations, R_q
  LinearSolver solver_;
  Eigen::VectorXd correction_, residual_;
  double curvature_ = std::numeric_limits<double>::infinity();
  Eigen::VectorXd old_q_, old_v_, old_a_, old_w_;
  Eigen::VectorXd increment_;  ///< q = old_q ⊕ increment
  Trajectory trajectory_;
};

}  // namespace

Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options) {
  return TimeLoop(mechanism, options).run();
}

}  // namespace pleuel
