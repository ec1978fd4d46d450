#include "core/trust/fast_laws.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/acting_laws.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

namespace {

/// Share of the largest value that may be missed between two instants. Of an oscillation of n steps
/// a period that is (2π/n)²/8, and the schemes' errors are about as large: 22 steps.
constexpr double most_missed_share = 1e-2;
/// Of the direction of what a drive turns: forces of a crank contain twice its frequency, too. 32
/// steps a revolution.
constexpr double most_missed_direction = 5e-3;

/// The first time within the simulation at which the speed of straight lines or of a formula jumps.
std::optional<double> speed_jump(const TimeFunction& motion, const TimeLaw<double>& law,
                                 double end) {
  const auto* table = std::get_if<TableFunction>(&motion);
  const bool is_straight = table && table->interpolation == Interpolation::linear;
  if (!is_straight && !std::holds_alternative<ExpressionFunction>(motion)) return std::nullopt;
  constexpr double small = 1e-6, close = 1e-9;
  constexpr int samples = 100;
  const std::vector<double> times = sharp_times(motion, end);
  double fastest = 0.0;
  for (int i = 0; i <= samples; ++i) {
    fastest = std::max(fastest, std::abs(law.at(i * end / samples).rate));
  }
  for (const double time : times) {
    fastest = std::max(fastest, std::abs(law.at(time + close * end).rate));
    fastest = std::max(fastest, std::abs(law.at(time - close * end).rate));
  }
  for (const double time : times) {
    if (time <= 0.0 || time >= end) continue;
    const double before = law.at(time - close * end).rate;
    if (std::abs(law.at(time + close * end).rate - before) > small * fastest) return time;
  }
  return std::nullopt;
}

void add_drive(const ActingLaw& drive, const TimeLaw<double>& law, const Eigen::VectorXd& time,
               std::vector<Finding>& findings) {
  const std::string who = fmt::format("the drive of the joint \"{}\"", drive.name);
  const bool is_formula = std::holds_alternative<ExpressionFunction>(drive.function);
  if (const auto jump = speed_jump(drive.function, law, time(time.size() - 1))) {
    findings.push_back(
        {fmt::format("{} {}: its speed jumps at t = {:.4g} s, where forces "
                     "would be infinite; what is shown depends on the step. {}.",
                     who, is_formula ? "has a kink" : "follows straight lines", *jump,
                     is_formula ? "Leave out min, max and abs, or take a table or a \"ramp\" with "
                                  "\"rounding\""
                                : "Take the \"interpolation\" \"monotone\" or \"spline\""),
         true});
    return;
  }
  const std::vector<double> knots = sharp_times(drive.function, time(time.size() - 1));
  if (!drive.is_displacement) {
    const MissedValues turned = missed_by(
        time, [&](double t) { return std::polar(1.0, law.at(t).value); }, knots);
    add_missed({who, "direction", most_missed_direction}, turned, 1.0, findings);
    if (turned.largest > most_missed_direction) return;
  }
  const MissedValues moved = missed_by(
      time, [&](double t) { return law.at(t).acceleration; }, knots);
  add_missed({who, "acceleration", most_missed_share}, moved, moved.scale, findings);
}

/// @param time  the instants of the steps
std::vector<Finding> find_fast_laws(const Scene& scene, const Design<double>& design,
                                    const Eigen::VectorXd& time) {
  std::vector<Finding> findings;
  for (const ActingLaw& acting : acting_laws(scene)) {
    if (depends_on_state(acting.function)) continue;
    const TimeLaw<double> law =
        resolve_time_law(acting.function, design, acting.is_motion() ? LawOf::motion : LawOf::load);
    if (acting.kind == ActingLaw::Kind::drive) {
      add_drive(acting, law, time, findings);
      continue;
    }
    const MissedValues missed = missed_by(
        time, [&](double t) { return law.at(t).value; },
        sharp_times(acting.function, time(time.size() - 1)));
    const bool is_target = acting.kind == ActingLaw::Kind::target;
    const std::string who =
        fmt::format("{}the load \"{}\"", is_target ? "the motor of " : "", acting.name);
    add_missed({who, is_target ? "target" : "value", most_missed_share}, missed, missed.scale,
               findings);
  }
  return findings;
}

}  // namespace

std::vector<Finding> check_fast_laws(const TrustedRun& run) {
  return find_fast_laws(run.problem.scene, Design<double>(run.x.begin(), run.x.end()),
                        run.analysis.trajectory.time);
}

std::vector<Finding> check_fast_laws_before(const ProblemFile& problem) {
  if (problem.simulation.local_error > 0.0) return {};
  SimulationOptions options{problem.simulation};
  options.breaks = time_breaks(problem.scene, options);
  const std::vector<double> instants = regular_instants(options);
  const Eigen::VectorXd x = start_design(problem);
  return find_fast_laws(problem.scene, Design<double>(x.begin(), x.end()),
                        Eigen::Map<const Eigen::VectorXd>(instants.data(), instants.size()));
}

namespace {

/// Samples of each step, at distances that are in step with no period.
constexpr int samples = 5;
constexpr double golden_ratio = 0.6180339887498949;
/// A jump at an instant belongs to neither side [steps].
constexpr double beside = 1e-6;

using Observed = std::complex<double>;

Observed between(Observed begin, Observed end, double share) {
  return begin + share * (end - begin);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

MissedValues missed_by(const Eigen::VectorXd& time, const ObservedFunction& value,
                       const std::vector<double>& knots) {
  MissedValues missed;
  std::vector<double> of_steps(time.size() - 1, 0.0), of_halves = of_steps;
  double place = 0.0;
  auto knot = knots.begin();
  for (Eigen::Index i = 0; i + 1 < time.size(); ++i) {
    const double h = time(i + 1) - time(i);
    const Observed begin = value(time(i) + beside * h), middle = value(time(i) + 0.5 * h),
                   end = value(time(i + 1) - beside * h);
    missed.scale = std::max({missed.scale, std::abs(begin), std::abs(end)});
    const auto look = [&](double at) {
      const Observed here = value(time(i) + (beside + (1.0 - 2.0 * beside) * at) * h);
      missed.scale = std::max(missed.scale, std::abs(here));
      const double away = std::abs(here - between(begin, end, at));
      const Observed of_half =
          at < 0.5 ? between(begin, middle, 2.0 * at) : between(middle, end, 2.0 * at - 1.0);
      of_halves[i] = std::max(of_halves[i], std::abs(here - of_half));
      of_steps[i] = std::max(of_steps[i], away);
      if (away <= missed.largest) return;
      missed.largest = away;
      missed.time = time(i) + at * h;
      missed.step = h;
    };
    for (int k = 0; k < samples; ++k) {
      place = std::fmod(place + golden_ratio, 1.0);
      look(place);
    }
    for (; knot != knots.end() && *knot < time(i + 1); ++knot) {
      if (*knot > time(i)) look((*knot - time(i)) / h);
    }
  }
  missed.median = median(std::move(of_steps));
  missed.median_of_halves = median(std::move(of_halves));
  return missed;
}

void add_missed(const MissedSubject& subject, const MissedValues& missed, double scale,
                std::vector<Finding>& findings) {
  if (!(missed.largest > subject.most * scale)) return;
  findings.push_back(
      {fmt::format("{} changes faster than the steps can follow: within the step of {:.3g} s at "
                   "t = {:.4g} s its {} is {} of the largest away from what the steps see. "
                   "Give an oscillation 22 steps or more, a revolution 32: a smaller "
                   "/simulation/step.",
                   subject.who, missed.step, missed.time, subject.what,
                   rough_percent(missed.largest / scale)),
       true});
}

namespace {

/// A direction is known from what it was a step before [rad].
constexpr double most_turned = 0.5 * std::numbers::pi;

}  // namespace

std::vector<Finding> check_fast_turning(const TrustedRun& run) {
  const Trajectory& trajectory = run.analysis.trajectory;
  double most = most_turned, step_size = 0.0, time = 0.0;
  const BodyModel* fastest = nullptr;
  for (int step = 1; step <= trajectory.steps(); ++step) {
    const State state = trajectory.state_at(step);
    for (const BodyModel& body : run.analysis.model.bodies) {
      const BodyFrame& frame = body.frame;
      const double speed =
          state.v.segment(frame.offset + frame.translations(), frame.rotations()).norm();
      const double turned = speed * trajectory.step_size(step);
      if (!(turned > most)) continue;
      most = turned;
      step_size = trajectory.step_size(step);
      time = trajectory.time(step);
      fastest = &body;
    }
  }
  if (fastest == nullptr) return {};
  return {
      {fmt::format("\"{}\" turns by {:.3g} deg within the step of {:.3g} s at t = {:.4g} s: what "
                   "its direction changes is not seen. Give a revolution 32 steps: a "
                   "/simulation/step of {:.2g} s.",
                   fastest->name, most * 180.0 / std::numbers::pi, step_size, time,
                   step_size * 2.0 * std::numbers::pi / (32.0 * most)),
       true}};
}

}  // namespace pleuel
