#include "core/integration/time_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/integration/initial_state.hpp"

namespace pleuel {

namespace {

/// Factors are renewed where the corrections shrink by less than this.
constexpr double slow_rate = 0.1;
/// Scaled corrections below this that no longer shrink are round-off.
constexpr double newton_round_off = 1e-9;

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

}  // namespace

TimeLoop::TimeLoop(Mechanism& mechanism, const SimulationOptions& options, InstantObserver observer)
    : system_(*mechanism.system),
      scale_(mechanism.scale),
      equation_names_(mechanism.equation_names),
      options_(options),
      observer_(std::move(observer)),
      mechanism_(mechanism),
      steps_(step_count(options)),
      grid_(options.instants.empty() ? regular_instants(options) : options.instants),
      scheme_(make_scheme(options.scheme, regular_step(), options.spectral_radius)),
      equations_(mechanism, scheme_, options.formulation),
      state_(equations_.make_state(initial_state(mechanism).state)),
      old_(state_),
      matrix_(equations_.make_matrix()),
      solver_(matrix_, mechanism.elastic),
      correction_(equations_.size()),
      finest_level_(halvings(options, regular_step())) {
  if (options.formulation.is_projected) projection_.emplace(mechanism);
}

void TimeLoop::start(Eigen::Index room) {
  trajectory_.scheme = scheme_;
  trajectory_.scheme_type = options_.scheme;
  trajectory_.spectral_radius = options_.spectral_radius;
  trajectory_.formulation = options_.formulation;
  trajectory_.time.resize(steps_ + 1);
  // What weight_of_start_jerk() asks for.
  trajectory_.lambda.resize(system_.multipliers(), 0);
  window_.resize(state_, room);
  start_ = state_;
  residual_.resize(equations_.size());
  store();
}

void TimeLoop::advance(int unit) {
  check_stop();
  const double instant = grid_[static_cast<std::size_t>(unit)];
  if (options_.instants.empty()) {
    step_ = unit;
    advance_step(instant);
  } else {
    step_ = static_cast<int>(std::ceil(instant / regular_step() * (1 - 1e-12)));
    advance_to(instant, 0);
  }
}

Trajectory TimeLoop::trajectory() {
  trajectory_.time.conservativeResize(stored_);
  trajectory_.factorizations = solver_.factorizations();
  Trajectory trajectory = trajectory_;
  for (auto* matrix : {&trajectory.q, &trajectory.v, &trajectory.a}) {
    matrix->resize(system_.coordinates(), 0);
  }
  trajectory.eta.resize(state_.eta.size(), 0);
  observer_ = {};
  return trajectory;
}

void TimeLoop::empty_window() {
  window_.clear(instant());
  window_.push(state_);
}

void TimeLoop::KeptPivots::take(const LinearSolver& solver) {
  if (solver.pivot_choices() == choice) return;
  pivots = std::make_shared<LinearSolver::Pivots>(solver.pivots());
  choice = solver.pivot_choices();
}

void TimeLoop::KeptPivots::give(const std::shared_ptr<const LinearSolver::Pivots>& from,
                                LinearSolver& solver) {
  if (from == pivots && solver.pivot_choices() == choice) return;
  solver.use_pivots(*from);
  pivots = from;
  choice = solver.pivot_choices();
}

std::vector<LinearSolver*> TimeLoop::solvers() {
  std::vector<LinearSolver*> all = {&solver_};
  if (projection_) {
    for (LinearSolver* solver : projection_->solvers()) all.push_back(solver);
  }
  return all;
}

TimeLoop::Checkpoint TimeLoop::checkpoint(int unit) {
  const std::vector<LinearSolver*> all = solvers();
  kept_.resize(all.size());
  Checkpoint checkpoint{instant(), unit, state_, curvature_, worst_pivots_, level_, {}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    kept_[i].take(*all[i]);
    checkpoint.pivots.push_back(kept_[i].pivots);
  }
  return checkpoint;
}

void TimeLoop::restore(const Checkpoint& checkpoint) {
  state_ = checkpoint.state;
  curvature_ = checkpoint.curvature;
  worst_pivots_ = checkpoint.worst_pivots;
  level_ = checkpoint.level;
  const std::vector<LinearSolver*> all = solvers();
  for (std::size_t i = 0; i < all.size(); ++i) kept_[i].give(checkpoint.pivots[i], *all[i]);
  stored_ = checkpoint.instant;
  window_.clear(stored_);
  store();
}

void TimeLoop::require_finite() const {
  const auto n = state_.q.size();
  for (const auto* values : {&state_.q, &state_.v, &state_.a, &state_.lambda}) {
    if (values->allFinite()) continue;
    for (Eigen::Index i = 0; i < values->size(); ++i) {
      if (std::isfinite((*values)(i))) continue;
      const auto equation = static_cast<std::size_t>(values == &state_.lambda ? n + i : i);
      throw SimulationError(fmt::format(
          "simulation stopped at t = {:.6g} s (step {} of {}): the state{} is not finite. Look for "
          "numbers of the file that are out of proportion (sizes, densities, stiffness, units)",
          state_.time, step_, steps_,
          equation < equation_names_.size() ? " of " + equation_names_[equation] : ""));
    }
  }
}

void TimeLoop::store() {
  require_finite();
  const Eigen::Index step = stored_++;
  trajectory_.time(step) = state_.time;
  if (window_.is_full()) window_.make_room(window_.capacity() + window_.capacity() / 8 + 64);
  window_.push(state_);
  if (observer_) observer_(static_cast<int>(step), state_);
}

void TimeLoop::advance_step(double end) {
  if (options_.local_error > 0.0) {
    advance_controlled(end);
  } else {
    advance_to(end, 0);
  }
}

void TimeLoop::advance_controlled(double end) {
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

double TimeLoop::error_of(Eigen::Index i) const {
  return std::abs(state_.a(i) - old_.a(i)) / scale_(i) * std::abs(scheme_.local_error) /
         scheme_.step;
}

Eigen::Index TimeLoop::worst_coordinate() const {
  Eigen::Index worst = 0;
  for (Eigen::Index i = 1; i < scale_.size(); ++i) {
    if (!(error_of(i) <= error_of(worst))) worst = i;
  }
  return worst;
}

double TimeLoop::relative_error() const {
  return error_of(worst_coordinate()) * (1 << level_) / options_.local_error;
}

void TimeLoop::advance_to(double time, int splits) {
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

void TimeLoop::check_drift() {
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

void TimeLoop::use_step(double time) {
  // Instants between the regular ones, of steps that were split, need more room.
  if (stored_ == trajectory_.time.size()) {
    trajectory_.time.conservativeResize(stored_ + steps_ / 8 + 64);
  }
  trajectory_.time(stored_) = time;
  scheme_ = trajectory_.scheme_of(static_cast<int>(stored_));
  equations_.set_scheme(scheme_);
}

void TimeLoop::set_out() {
  if (!set_out_ || set_out_for_ != scheme_.step) {
    set_out_.emplace(mechanism_, start_, scheme_, trajectory_.weight_of_start_jerk());
    set_out_for_ = scheme_.step;
  }
  // Not of state_, which a first step that failed leaves set out.
  old_.v = set_out_->v();
  old_.a = set_out_->a();
  old_.w = set_out_->w();
}

void TimeLoop::predict(double time) {
  const Eigen::Matrix4d& h = scheme_.history;
  old_ = state_;
  if (stored_ == 1) set_out();
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

double TimeLoop::size_of_correction() const {
  const int n = system_.coordinates();
  double size = correction_.head(n).cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
  if (state_.shift.size() == 0) return size;
  const auto shift = correction_.segment(system_.size(), n);
  return std::max(size, shift.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>());
}

std::optional<TimeLoop::Failure> TimeLoop::correct(bool is_careful) {
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
    if (is_slow && is_fresh && size < newton_round_off) return std::nullopt;
    is_stale = is_slow;
    previous = size;
  }
  return Failure{"Newton's method does not converge", options_.max_newton_iterations};
}

std::optional<TimeLoop::Failure> TimeLoop::finish(bool is_careful) {
  const std::optional<Failure> failure = correct(is_careful);
  if (failure || !projection_) return failure;
  state_.drifted_q = state_.q;
  state_.drifted_v = state_.v;
  if (projection_->apply(state_)) return std::nullopt;
  return Failure{"the constraints cannot be met again by a projection", 0};
}

void TimeLoop::note_curvature(double seen) {
  curvature_ = std::isfinite(curvature_) ? std::max(seen, 0.5 * curvature_) : seen;
}

bool TimeLoop::linearize() {
  equations_.linearize(state_, residual_, matrix_);
  if (!solver_.factorize(matrix_)) return false;
  note_condition();
  return true;
}

void TimeLoop::note_condition() {
  if (solver_.reciprocal_condition() > 0.5 * worst_pivots_) return;
  worst_pivots_ = solver_.reciprocal_condition();
  trajectory_.worst_condition = std::max(trajectory_.worst_condition, solver_.condition());
}

std::string TimeLoop::worst_equation() const {
  const int size = system_.size();
  Eigen::Index worst = 0;
  residual_.head(size).cwiseAbs().maxCoeff(&worst);
  const auto index = static_cast<std::size_t>(worst);
  return index < equation_names_.size() ? " of " + equation_names_[index] : "";
}

void TimeLoop::fail(const std::optional<Failure>& failure, double error) const {
  if (failure) fail(*failure);
  const auto worst = static_cast<std::size_t>(worst_coordinate());
  throw SimulationError(fmt::format(
      "simulation stopped at t = {:.6g} s (step {} of {}): with a step of {:.3g} s the local "
      "error{} is still {:.3g} times what /simulation/local_error allows. Allow more, or a smaller "
      "/simulation/smallest_step; or look for something that jumps there",
      state_.time, step_, steps_, scheme_.step,
      worst < equation_names_.size() ? " of " + equation_names_[worst] : "", error));
}

void TimeLoop::fail(const Failure& failure) const {
  throw SimulationError(fmt::format(
      "simulation stopped at t = {:.6g} s (step {} of {}, Newton iteration {}): {}, nor with a "
      "step of {:.3g} s; largest residual {:.3g}{}. Try a smaller /simulation/step (now {:.3g} "
      "s), or look for a position in which the mechanism locks",
      state_.time, step_, steps_, failure.iteration, failure.what, scheme_.step,
      residual_.lpNorm<Eigen::Infinity>(), worst_equation(), regular_step()));
}

}  // namespace pleuel
