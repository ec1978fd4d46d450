#include "core/integration/time_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/stop.hpp"
#include "core/start/initial_state.hpp"

namespace pleuel {

namespace {

/// Constraints of index 1 may drift so far, relative to the largest scale of a coordinate.
constexpr double most_drift = 1e-2;
/// A step is halved so often at most.
constexpr int max_splits = 6;

/// Motions that take more iterations of a step turn so far in it that a straight line leads astray.
constexpr int most_of_a_resolved_step = 2;

/// Every so many steps Newton's method makes a second iteration, to see how fast it converges.
constexpr int curvature_interval = 16;

}  // namespace

void Predictor::predict(const StepState& old, double time, const Scheme& scheme,
                        const StepEquations& equations, StepState& state) {
  const Eigen::Matrix4d& h = scheme.history;
  state.increment = h(0, 1) * old.v + h(0, 2) * old.a + h(0, 3) * old.w;
  state.v = h(1, 0) * old.q + h(1, 1) * old.v + h(1, 2) * old.a + h(1, 3) * old.w;
  state.a = h(2, 0) * old.q + h(2, 1) * old.v + h(2, 2) * old.a + h(2, 3) * old.w;
  state.w = h(3, 0) * old.q + h(3, 1) * old.v + h(3, 2) * old.a + h(3, 3) * old.w;
  state.lambda = old.lambda;
  state.shift.setZero();
  state.eta.setZero();
  correction_.setZero();
  auto correction = correction_.head(old.q.size());
  correction = old.a - state.a;
  if (experience_.step > 0.0) {
    // No further ahead than it is known behind.
    const double ratio = std::min(1.0, scheme.step / experience_.step);
    correction += ratio * experience_.change_of_a;
    state.lambda += ratio * experience_.change_of_lambda;
  }
  correction /= scheme.correction(2);
  equations.apply(correction_, state);
  state.time = time;
}

void Predictor::record(const StepState& old, const StepState& state) {
  experience_.step = state.time - old.time;
  experience_.change_of_a = state.a - old.a;
  experience_.change_of_lambda = state.lambda - old.lambda;
}

TimeLoop::TimeLoop(Mechanism& mechanism, const SimulationOptions& options, InstantObserver observer,
                   const SchemeState* start)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      options_(options),
      observer_(std::move(observer)),
      steps_(step_count(options)),
      grid_(options.instants.empty() ? regular_instants(options) : options.instants),
      scheme_(make_scheme(options.scheme, regular_step(), options.spectral_radius)),
      equations_(mechanism, scheme_, options.formulation),
      state_(make_start(start)),
      old_(state_),
      predictor_(equations_),
      corrector_(mechanism, equations_, options),
      control_(mechanism, options),
      breaks_(options.breaks),
      is_continued_(start != nullptr),
      drift_(system_.size()) {
  if (options.formulation.is_projected) projection_.emplace(mechanism);
  // Index 1 has accelerations that drives prescribe, at every instant anew.
  if (options.formulation.constraints == ConstraintForm::index_1) breaks_.clear();
  std::ranges::sort(breaks_);
}

StepState TimeLoop::make_start(const SchemeState* start) const {
  if (!start) {
    const Trajectory* similar = options_.similar;
    if (!similar || similar->recomputed()) {
      return equations_.make_state(initial_state(mechanism_).state);
    }
    const State beside = similar->state_at(0);
    return equations_.make_state(initial_state(mechanism_, &beside).state);
  }
  StepState state = equations_.make_state(*start);
  state.w = start->w;
  return state;
}

void TimeLoop::start(Eigen::Index capacity) {
  trajectory_.scheme = scheme_;
  trajectory_.scheme_type = options_.scheme;
  trajectory_.spectral_radius = options_.spectral_radius;
  trajectory_.formulation = options_.formulation;
  trajectory_.has_constraints = system_.multipliers() > 0;
  if (is_continued_) trajectory_.step_before = grid_.back() - grid_[grid_.size() - 2];
  trajectory_.time.resize(steps_ + 1);
  window_ = StateWindow(state_, capacity);
  start_ = state_;
  store();
}

void TimeLoop::advance(int unit) {
  check_stop();
  const double end = grid_[unit];
  const bool is_repeated = !options_.instants.empty();
  step_ = is_repeated ? static_cast<int>(steps_within(end, regular_step())) : unit;
  if (options_.local_error > 0.0 && !is_repeated) {
    advance_controlled(end);
  } else {
    advance_to(end, 0);
  }
}

Trajectory TimeLoop::end() {
  observer_ = {};
  trajectory_.time.conservativeResize(stored_);
  trajectory_.end_w = state_.w;
  trajectory_.newton_iterations = corrector_.iterations();
  trajectory_.factorizations = corrector_.factorizations();
  trajectory_.worst_condition = corrector_.worst_condition();
  return trajectory_;
}

void TimeLoop::empty_window() {
  window_.clear(instant());
  window_.push(state_);
}

std::vector<LinearSolver*> TimeLoop::solvers() {
  std::vector<LinearSolver*> all = {&corrector_.solver()};
  if (projection_) {
    for (LinearSolver* solver : projection_->solvers()) all.push_back(solver);
  }
  return all;
}

TimeLoop::Checkpoint TimeLoop::checkpoint(int unit) {
  const std::vector<LinearSolver*> all = solvers();
  pivot_records_.resize(all.size());
  Checkpoint checkpoint{
      instant(),        unit, state_, corrector_.experience(), predictor_.experience(),
      control_.level(), {}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    checkpoint.pivots.push_back(pivot_records_[i].of(*all[i]));
  }
  return checkpoint;
}

void TimeLoop::restore(const Checkpoint& checkpoint) {
  state_ = checkpoint.state;
  corrector_.set_experience(checkpoint.experience);
  predictor_.set_experience(checkpoint.prediction);
  control_.set_level(checkpoint.level);
  const std::vector<LinearSolver*> all = solvers();
  for (std::size_t i = 0; i < all.size(); ++i) {
    pivot_records_[i].restore(checkpoint.pivots[i], *all[i]);
  }
  stored_ = checkpoint.instant;
  window_.clear(stored_);
  store();
}

void TimeLoop::advance_controlled(double end) {
  const double begin = state_.time;
  for (int done = 0; done < control_.parts();) {
    const int next = control_.end_of_part(done);
    const bool is_last = next == control_.parts();
    const double time = is_last ? end : begin + (end - begin) * next / control_.parts();
    const std::optional<StepFailure> failure = make_step(time, NewtonCorrector::Trust::usual);
    const double error = failure ? std::numeric_limits<double>::infinity()
                                 : control_.relative_error(*from_, state_, scheme_);
    if (error <= 1.0) {
      accept();
      control_.accept(error);
      done = next;
    } else if (control_.refine()) {
      ++trajectory_.rejected_steps;
      state_ = old_;
    } else if (failure) {
      fail(*failure);
    } else {
      const Eigen::Index worst = control_.worst_coordinate(*from_, state_, scheme_);
      throw_inaccurate(place(), scheme_.step, error,
                       equation_text(worst, mechanism_.equation_names));
    }
  }
}

void TimeLoop::advance_to(double time, int splits) {
  const auto trust = splits > 0 ? NewtonCorrector::Trust::none : NewtonCorrector::Trust::usual;
  const std::optional<StepFailure> failure = make_step(time, trust);
  if (!failure) {
    accept();
    return;
  }
  if (splits == max_splits) fail(*failure);
  ++trajectory_.split_steps;
  const double middle = 0.5 * (old_.time + time);
  state_ = old_;
  advance_to(middle, splits + 1);
  advance_to(time, splits + 1);
}

std::optional<StepFailure> TimeLoop::make_step(double time, NewtonCorrector::Trust trust) {
  use_step(time);
  old_ = state_;
  const bool is_start = stored_ == 1 && !is_continued_;
  if (is_start) correct_start();
  from_ = !is_start && passes_corner() ? &behind_corner_ : &old_;
  equations_.begin(*from_);
  predictor_.predict(*from_, time, scheme_, equations_, state_);
  const bool is_foreseeable = step_ > 2 && step_ % curvature_interval != 1;
  const bool is_behind_corner = from_ != &old_;
  if (!is_foreseeable || is_behind_corner || mechanism_.has_laws_of_motion) {
    trust = NewtonCorrector::Trust::none;
  }
  std::optional<StepFailure> failure = corrector_.correct(equations_, state_, trust);
  if (failure && predictor_.looks_ahead()) {
    predictor_.forget();
    state_ = old_;
    predictor_.predict(*from_, time, scheme_, equations_, state_);
    failure = corrector_.correct(equations_, state_, trust);
  }
  if (failure) return failure;
  if (!projection_) return std::nullopt;
  state_.drifted_q = state_.q;
  state_.drifted_v = state_.v;
  if (projection_->apply(state_)) return std::nullopt;
  return StepFailure{"the constraints cannot be met again by a projection", 0};
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

void TimeLoop::correct_start() {
  if (!damped_start_ || damped_start_step_ != scheme_.step) {
    damped_start_.emplace(mechanism_, start_, scheme_, trajectory_.weight_of_jerk(1));
    damped_start_step_ = scheme_.step;
  }
  // Not of state_, which a first step that failed leaves changed.
  old_.v = damped_start_->v();
  old_.a = damped_start_->a();
  old_.w = damped_start_->w();
}

bool TimeLoop::passes_corner() {
  constexpr double round_off = 1e-9;  // of the instants, in steps
  const double time = old_.time, near = round_off * scheme_.step;
  const auto one = std::ranges::lower_bound(breaks_, time - near);
  if (one == breaks_.end() || *one > time + near) return false;
  if (!corner_) corner_.emplace(mechanism_);
  if (!corner_->find(old_, scheme_.step)) return false;
  const auto instant = static_cast<int>(stored_) - 1;
  if (!trajectory_.is_corner(instant)) trajectory_.corners.push_back(instant);
  const auto& [acceleration, jerk] = corner_->value();
  behind_corner_ = old_;
  behind_corner_.v += trajectory_.weight_of_jerk(instant + 1) * jerk;
  behind_corner_.a += acceleration;
  behind_corner_.w += acceleration + scheme_.delay * jerk;
  return true;
}

void TimeLoop::accept() {
  check_drift();
  const bool is_resolved = corrector_.iterations_of_step() <= most_of_a_resolved_step;
  is_resolved ? predictor_.record(*from_, state_) : predictor_.forget();
  store();
}

void TimeLoop::store() {
  require_finite();
  const Eigen::Index step = stored_++;
  trajectory_.time(step) = state_.time;
  window_.push(state_);
  if (observer_) observer_(static_cast<int>(step), state_);
}

void TimeLoop::check_drift() {
  const Formulation& formulation = options_.formulation;
  if (formulation.constraints != ConstraintForm::index_1 || formulation.is_projected ||
      system_.multipliers() == 0) {
    return;
  }
  system_.residual(state_, ConstraintLevel::position, drift_);
  const double drift = drift_.tail(system_.multipliers()).lpNorm<Eigen::Infinity>();
  if (drift <= most_drift * mechanism_.scale.maxCoeff()) return;
  drift_.head(system_.coordinates()).setZero();
  throw_drifted(place(), drift, worst_equation(drift_, mechanism_.equation_names));
}

void TimeLoop::require_finite() const {
  const auto n = state_.q.size();
  for (const auto* values : {&state_.q, &state_.v, &state_.a, &state_.lambda}) {
    if (values->allFinite()) continue;
    for (Eigen::Index i = 0; i < values->size(); ++i) {
      if (std::isfinite((*values)(i))) continue;
      const Eigen::Index equation = values == &state_.lambda ? n + i : i;
      throw_not_finite(place(), equation_text(equation, mechanism_.equation_names));
    }
  }
}

void TimeLoop::fail(const StepFailure& failure) const {
  const Eigen::VectorXd& residual = corrector_.residual();
  throw_failed(place(), failure, scheme_.step, residual.lpNorm<Eigen::Infinity>(),
               worst_equation(residual.head(system_.size()), mechanism_.equation_names),
               regular_step());
}

}  // namespace pleuel
