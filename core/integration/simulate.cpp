#include "core/integration/simulate.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/initial_state.hpp"
#include "core/integration/linear_solver.hpp"
#include "core/integration/step_equations.hpp"

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
        scale_(mechanism.scale),
        options_(options),
        steps_(step_count(options)),
        scheme_(make_scheme(options.scheme, options.end_time / steps_, options.spectral_radius)),
        equations_(mechanism, scheme_, options.formulation),
        state_(equations_.make_state(initial_state(mechanism).state)),
        old_(state_),
        matrix_(equations_.make_matrix()),
        solver_(matrix_),
        correction_(equations_.size()) {}

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
    trajectory_.formulation = options_.formulation;
    trajectory_.eta.resize(state_.eta.size(), steps_ + 1);
    residual_.resize(equations_.size());
  }

  void store(int step) {
    trajectory_.time(step) = state_.time;
    trajectory_.q.col(step) = state_.q;
    trajectory_.v.col(step) = state_.v;
    trajectory_.a.col(step) = state_.a;
    trajectory_.lambda.col(step) = state_.lambda;
    trajectory_.eta.col(step) = state_.eta;
  }

  /// y⁺ = history · y (for q as q ⊕ increment), then the correction that keeps the acceleration.
  void predict(int step) {
    const Eigen::Matrix4d& h = scheme_.history;
    old_ = state_;
    equations_.begin(old_);
    state_.increment = h(0, 1) * old_.v + h(0, 2) * old_.a + h(0, 3) * old_.w;
    state_.v = h(1, 0) * old_.q + h(1, 1) * old_.v + h(1, 2) * old_.a + h(1, 3) * old_.w;
    state_.a = h(2, 0) * old_.q + h(2, 1) * old_.v + h(2, 2) * old_.a + h(2, 3) * old_.w;
    state_.w = h(3, 0) * old_.q + h(3, 1) * old_.v + h(3, 2) * old_.a + h(3, 3) * old_.w;
    state_.shift.setZero();
    state_.eta.setZero();
    correction_.setZero();
    correction_.head(system_.coordinates()) = (old_.a - state_.a) / scheme_.correction(2);
    equations_.apply(correction_, state_);
    state_.time = options_.end_time * step / steps_;
  }

  /// Largest change of a coordinate, relative to its scale.
  double size_of_correction() const {
    const int n = system_.coordinates();
    double size = correction_.head(n).cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
    if (state_.shift.size() == 0) return size;
    const auto shift = correction_.segment(system_.size(), n);
    return std::max(size, shift.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>());
  }

  /// Newton's method that keeps the factors within the step while they serve.
  void correct(int step) {
    bool is_stale = true;
    double previous = 0.0;
    for (int iteration = 1; iteration <= options_.max_newton_iterations; ++iteration) {
      ++trajectory_.newton_iterations;
      const bool is_fresh = is_stale;
      if (is_stale) {
        linearize(step, iteration);
      } else {
        equations_.residual(state_, residual_);
      }
      correction_ = -residual_;
      solver_.solve(correction_);
      equations_.apply(correction_, state_);
      const double size = size_of_correction();
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
    equations_.linearize(state_, residual_, matrix_);
    if (!solver_.factorize(matrix_)) fail(step, iteration, "the step matrix is singular");
    trajectory_.worst_condition =
        std::max(trajectory_.worst_condition, 1.0 / solver_.reciprocal_condition());
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
  const Eigen::VectorXd& scale_;
  SimulationOptions options_;
  int steps_;
  Scheme scheme_;
  StepEquations equations_;
  StepState state_, old_;
  System::Matrix matrix_;
  LinearSolver solver_;
  Eigen::VectorXd correction_, residual_;
  double curvature_ = std::numeric_limits<double>::infinity();
  Trajectory trajectory_;
};

}  // namespace

Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options) {
  return TimeLoop(mechanism, options).run();
}

}  // namespace pleuel
