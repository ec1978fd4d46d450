#include "core/integration/simulate.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/initial_state.hpp"
#include "core/integration/jerk.hpp"
#include "core/integration/linear_solver.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/step_equations.hpp"

namespace pleuel {

namespace {

/// Steps that differ by less, relatively, are equal.
constexpr double round_off_of_steps = 1e-6;

}  // namespace

void Trajectory::load(int step, State& state) const {
  state.time = time(step);
  state.q = q.col(step);
  state.v = v.col(step);
  state.a = a.col(step);
  state.lambda = lambda.col(step);
}

void Trajectory::load_drifted(int step, State& state) const {
  load(step, state);
  if (!is_projected()) return;
  state.q = drifted_q.col(step);
  state.v = drifted_v.col(step);
}

int step_count(const SimulationOptions& options) {
  // A step that divides the time up to round-off is not shortened.
  return std::max(1, static_cast<int>(std::ceil(options.end_time / options.step * (1 - 1e-12))));
}

double Trajectory::step_size(int step) const {
  const double h = time(step) - time(step - 1);
  const double halved =
      std::ldexp(scheme.step, static_cast<int>(std::lround(std::log2(h / scheme.step))));
  return std::abs(h - halved) <= round_off_of_steps * halved ? halved : h;
}

Scheme Trajectory::scheme_of(int step) const {
  const double h = step_size(step);
  const bool is_as_before =
      step == 1 || std::abs(h - step_size(step - 1)) <= round_off_of_steps * h;
  return is_as_before ? make_scheme(scheme_type, h, spectral_radius)
                      : make_restarting_scheme(scheme_type, h, spectral_radius);
}

StartWeights Trajectory::start_weights() const {
  if (lambda.rows() == 0) return {};
  const Scheme first = scheme_of(1);
  if (formulation.constraints != ConstraintForm::index_3) return {0.0, first.delay};
  return {-first.local_error / step_size(1), first.delay};
}

namespace {

/// Factors are renewed where the corrections shrink by less than this.
constexpr double slow_rate = 0.1;
/// Scaled corrections below this that no longer shrink are round-off.
constexpr double round_off = 1e-9;

/// Constraints of index 1 may drift so far, relative to the largest scale of a coordinate.
constexpr double most_drift = 1e-2;
/// A step is halved so often at most.
constexpr int max_splits = 6;

/// Control of the local error halves a step so often at most, unless told otherwise.
constexpr int usual_halvings = 10, most_halvings = 20;
/// A step doubles where its error is so small, relative to what is allowed: it then is four times
/// as large.
constexpr double small_error = 0.15;

int halvings(const SimulationOptions& options, double regular_step) {
  if (options.smallest_step <= 0.0) return usual_halvings;
  const double ratio = regular_step / options.smallest_step * (1 + 1e-12);
  return std::clamp(static_cast<int>(std::floor(std::log2(ratio))), 0, most_halvings);
}

/// Every so many steps a second iteration is made to see how fast the method converges.
constexpr int curvature_interval = 16;

class TimeLoop {
 public:
  TimeLoop(Mechanism& mechanism, const SimulationOptions& options)
      : system_(*mechanism.system),
        scale_(mechanism.scale),
        equation_names_(mechanism.equation_names),
        options_(options),
        steps_(step_count(options)),
        scheme_(make_scheme(options.scheme, regular_step(), options.spectral_radius)),
        equations_(mechanism, scheme_, options.formulation),
        state_(equations_.make_state(initial_state(mechanism).state)),
        old_(state_),
        matrix_(equations_.make_matrix()),
        solver_(matrix_),
        correction_(equations_.size()),
        finest_level_(halvings(options, regular_step())) {
    if (options.formulation.is_projected) projection_.emplace(mechanism);
    if (system_.multipliers() > 0) {
      jerk_ = ConstrainedJerk(mechanism, state_, regular_step()).value();
    }
  }

  Trajectory run() {
    allocate();
    store();
    if (options_.instants.empty()) {
      for (step_ = 1; step_ <= steps_; ++step_) advance_step(options_.end_time * step_ / steps_);
    } else {
      repeat(options_.instants);
    }
    trim();
    trajectory_.factorizations = solver_.factorizations();
    return std::move(trajectory_);
  }

 private:
  void allocate() {
    const int n = system_.coordinates();
    trajectory_.scheme = scheme_;
    trajectory_.scheme_type = options_.scheme;
    trajectory_.spectral_radius = options_.spectral_radius;
    trajectory_.time.resize(steps_ + 1);
    for (auto* matrix : {&trajectory_.q, &trajectory_.v, &trajectory_.a}) {
      matrix->resize(n, steps_ + 1);
    }
    trajectory_.lambda.resize(system_.multipliers(), steps_ + 1);
    trajectory_.formulation = options_.formulation;
    trajectory_.eta.resize(state_.eta.size(), steps_ + 1);
    drifted_q_ = drifted_v_ = Eigen::VectorXd::Zero(projection_ ? n : 0);
    trajectory_.drifted_q.resize(drifted_q_.size(), steps_ + 1);
    trajectory_.drifted_v.resize(drifted_v_.size(), steps_ + 1);
    residual_.resize(equations_.size());
  }

  /// Instants between the regular ones, of steps that were split, need more room.
  void make_room(Eigen::Index columns) {
    trajectory_.time.conservativeResize(columns);
    for (auto* matrix : {&trajectory_.q, &trajectory_.v, &trajectory_.a, &trajectory_.lambda,
                         &trajectory_.eta, &trajectory_.drifted_q, &trajectory_.drifted_v}) {
      matrix->conservativeResize(Eigen::NoChange, columns);
    }
  }

  void trim() {
    if (trajectory_.time.size() > stored_) make_room(stored_);
  }

  void store() {
    const Eigen::Index step = stored_++;
    trajectory_.time(step) = state_.time;
    trajectory_.q.col(step) = state_.q;
    trajectory_.v.col(step) = state_.v;
    trajectory_.a.col(step) = state_.a;
    trajectory_.lambda.col(step) = state_.lambda;
    trajectory_.eta.col(step) = state_.eta;
    trajectory_.drifted_q.col(step) = drifted_q_;
    trajectory_.drifted_v.col(step) = drifted_v_;
  }

  void repeat(const std::vector<double>& instants) {
    for (std::size_t i = 1; i < instants.size(); ++i) {
      step_ = static_cast<int>(std::ceil(instants[i] / regular_step() * (1 - 1e-12)));
      advance_to(instants[i], 0);
    }
  }

  void advance_step(double end) {
    if (options_.local_error > 0.0) {
      advance_controlled(end);
    } else {
      advance_to(end, 0);
    }
  }

  /// A regular step in parts of 2^-level of it, each beginning at a multiple of its size, where the
  /// level follows the local error.
  void advance_controlled(double end) {
    const double begin = state_.time;
    const int whole = 1 << finest_level_;
    for (int done = 0; done < whole;) {
      while (done % (whole >> level_) != 0) ++level_;
      const int next = done + (whole >> level_);
      const double time = next == whole ? end : begin + (end - begin) * next / whole;
      use_step(time);
      predict(time);
      const std::optional<Failure> failure = finish(false);
      const double error = failure ? std::numeric_limits<double>::infinity() : relative_error();
      if (!(error <= 1.0)) {
        if (level_ == finest_level_) fail(failure, error);
        state_ = old_;
        ++level_;
        ++trajectory_.rejected_steps;
        continue;
      }
      check_drift();
      store();
      done = next;
      if (level_ > 0 && error < small_error) --level_;
    }
  }

  /// Error of a coordinate in a step, relative to its scale.
  double error_of(Eigen::Index i) const {
    return std::abs(state_.a(i) - old_.a(i)) / scale_(i) * std::abs(scheme_.local_error) /
           scheme_.step;
  }
  Eigen::Index worst_coordinate() const {
    Eigen::Index worst = 0;
    for (Eigen::Index i = 1; i < scale_.size(); ++i) {
      if (!(error_of(i) <= error_of(worst))) worst = i;
    }
    return worst;
  }

  /// Local errors of a regular step in such parts, c h³ q⃛ each with q⃛ ≈ (a⁺ − a)/h, relative to
  /// what is allowed.
  double relative_error() const {
    return error_of(worst_coordinate()) * (1 << level_) / options_.local_error;
  }

  /// One step, or where Newton's method fails two of half the size.
  void advance_to(double time, int splits) {
    use_step(time);
    predict(time);
    const std::optional<Failure> failure = finish(splits > 0);
    if (!failure) {
      check_drift();
      store();
    } else {
      if (splits == max_splits) fail(*failure);
      ++trajectory_.split_steps;
      const double middle = 0.5 * (old_.time + time);
      state_ = old_;
      advance_to(middle, splits + 1);
      advance_to(time, splits + 1);
    }
  }

  /// Index 1 does not see how far its joints have come apart.
  void check_drift() {
    const Formulation& formulation = options_.formulation;
    if (formulation.constraints != ConstraintForm::index_1 || formulation.is_projected ||
        system_.multipliers() == 0) {
      return;
    }
    system_.residual(state_, ConstraintLevel::position, residual_);
    const double drift = residual_.tail(system_.multipliers()).lpNorm<Eigen::Infinity>();
    if (drift <= most_drift * scale_.maxCoeff()) return;
    residual_.head(system_.coordinates()).setZero();
    throw SimulationError(fmt::format(
        "simulation stopped at t = {:.6g} s (step {} of {}): constraints have drifted, those{} by "
        "{:.3g} m or rad. Try another /simulation/formulation, or /simulation/projection",
        state_.time, step_, steps_, worst_equation(), drift));
  }

  double regular_step() const { return options_.end_time / steps_; }

  /// The scheme for a step to an instant.
  void use_step(double time) {
    if (stored_ == trajectory_.time.size()) make_room(stored_ + steps_ / 8 + 64);
    trajectory_.time(stored_) = time;
    scheme_ = trajectory_.scheme_of(static_cast<int>(stored_));
    equations_.set_scheme(scheme_);
  }

  /// So that multipliers have their order from the first step on.
  void start() {
    const StartWeights weights = trajectory_.start_weights();
    if (weights.are_zero()) return;
    old_.v = trajectory_.v.col(0) + weights.v * jerk_;
    old_.w = trajectory_.a.col(0) + weights.w * jerk_;
  }

  /// y⁺ = history · y (for q as q ⊕ increment), then the correction that keeps the acceleration.
  void predict(double time) {
    const Eigen::Matrix4d& h = scheme_.history;
    old_ = state_;
    if (stored_ == 1) start();
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
    state_.time = time;
  }

  /// Largest change of a coordinate, relative to its scale.
  double size_of_correction() const {
    const int n = system_.coordinates();
    double size = correction_.head(n).cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
    if (state_.shift.size() == 0) return size;
    const auto shift = correction_.segment(system_.size(), n);
    return std::max(size, shift.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>());
  }

  struct Failure {
    const char* what;
    int iteration;
  };

  /// Newton's method that keeps the factors within the step while they serve.
  /// @param is_careful  no trust in the curvature seen before
  std::optional<Failure> correct(bool is_careful) {
    bool is_stale = true;
    double previous = 0.0;
    for (int iteration = 1; iteration <= options_.max_newton_iterations; ++iteration) {
      ++trajectory_.newton_iterations;
      const bool is_fresh = is_stale;
      if (!is_stale) {
        equations_.residual(state_, residual_);
      } else if (!linearize()) {
        return Failure{"the step matrix is singular", iteration};
      }
      correction_ = -residual_;
      solver_.solve(correction_);
      equations_.apply(correction_, state_);
      const double size = size_of_correction();
      if (!std::isfinite(size)) return Failure{"the solution is not finite", iteration};
      double error = std::min(size, curvature_ * size * size);
      if (iteration > 1) {
        error = size * std::min(1.0, size / previous);
        if (iteration == 2) note_curvature(size / (previous * previous));
      } else if (is_careful || step_ <= 2 || step_ % curvature_interval == 1) {
        error = size;  // go on, to see the curvature
      }
      if (error <= options_.newton_tolerance) return std::nullopt;
      const bool is_slow = iteration > 1 && size > slow_rate * previous;
      if (is_slow && is_fresh && size < round_off) return std::nullopt;
      is_stale = is_slow;
      previous = size;
    }
    return Failure{"Newton's method does not converge", options_.max_newton_iterations};
  }

  /// Newton's method, and the projection if there is one.
  std::optional<Failure> finish(bool is_careful) {
    const std::optional<Failure> failure = correct(is_careful);
    if (failure || !projection_) return failure;
    drifted_q_ = state_.q;
    drifted_v_ = state_.v;
    if (projection_->apply(state_)) return std::nullopt;
    return Failure{"the constraints cannot be met again by a projection", 0};
  }

  /// c of  |δ₂| = c |δ₁|²: how Newton's method converges quadratically here. It may fall slowly
  /// only.
  void note_curvature(double seen) {
    curvature_ = std::isfinite(curvature_) ? std::max(seen, 0.5 * curvature_) : seen;
  }

  bool linearize() {
    equations_.linearize(state_, residual_, matrix_);
    if (!solver_.factorize(matrix_)) return false;
    note_condition();
    return true;
  }

  /// The costly estimate where the cheap one is worse than ever.
  void note_condition() {
    if (solver_.reciprocal_condition() > 0.5 * worst_pivots_) return;
    worst_pivots_ = solver_.reciprocal_condition();
    trajectory_.worst_condition = std::max(trajectory_.worst_condition, solver_.condition());
  }

  /// The equation that is met worst.
  std::string worst_equation() const {
    const int size = system_.size();
    Eigen::Index worst = 0;
    residual_.head(size).cwiseAbs().maxCoeff(&worst);
    const auto index = static_cast<std::size_t>(worst);
    return index < equation_names_.size() ? " of " + equation_names_[index] : "";
  }

  [[noreturn]] void fail(const std::optional<Failure>& failure, double error) const {
    if (failure) fail(*failure);
    const auto worst = static_cast<std::size_t>(worst_coordinate());
    throw SimulationError(fmt::format(
        "simulation stopped at t = {:.6g} s (step {} of {}): with a step of {:.3g} s the local "
        "error"
        "{} is still {:.3g} times what /simulation/local_error allows. Allow more, or a smaller "
        "/simulation/smallest_step; or look for something that jumps there",
        state_.time, step_, steps_, scheme_.step,
        worst < equation_names_.size() ? " of " + equation_names_[worst] : "", error));
  }

  [[noreturn]] void fail(const Failure& failure) const {
    throw SimulationError(fmt::format(
        "simulation stopped at t = {:.6g} s (step {} of {}, Newton iteration {}): {}, nor with a "
        "step of {:.3g} s; largest residual {:.3g}{}. Try a smaller /simulation/step (now {:.3g} "
        "s), or look for a position in which the mechanism locks",
        state_.time, step_, steps_, failure.iteration, failure.what, scheme_.step,
        residual_.lpNorm<Eigen::Infinity>(), worst_equation(), regular_step()));
  }

  System& system_;
  const Eigen::VectorXd& scale_;
  const std::vector<std::string>& equation_names_;
  SimulationOptions options_;
  int steps_;
  Scheme scheme_;
  StepEquations equations_;
  StepState state_, old_;
  System::Matrix matrix_;
  LinearSolver solver_;
  Eigen::VectorXd correction_, residual_;
  std::optional<Projection> projection_;
  Eigen::VectorXd drifted_q_, drifted_v_;  ///< before the projection
  Eigen::VectorXd jerk_;                   ///< that the constraints prescribe at the start
  double curvature_ = std::numeric_limits<double>::infinity();
  double worst_pivots_ = std::numeric_limits<double>::infinity();
  int finest_level_, level_ = 0;  ///< of the parts of a regular step: 2^-level of it
  int step_ = 0;                  ///< regular step at work
  Eigen::Index stored_ = 0;       ///< instants of the trajectory
  Trajectory trajectory_;
};

}  // namespace

Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options) {
  return TimeLoop(mechanism, options).run();
}

}  // namespace pleuel
