#include "core/trust/fast_laws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "core/base/number_text.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/time_breaks.hpp"

namespace pleuel {

namespace {

/// Share of the largest value that may be missed between two instants. Of an oscillation of n steps
/// a period that is (2π/n)²/8, and the schemes' errors are about as large: 22 steps.
constexpr double most_missed_share = 1e-2;
/// Of the direction of what a drive turns: forces of a crank contain twice its frequency, too. 32
/// steps a revolution.
constexpr double most_missed_direction = 5e-3;
/// Samples of each step, at distances that are in step with no period.
constexpr int samples = 5;
constexpr double golden_ratio = 0.6180339887498949;
/// A jump at an instant belongs to neither side [steps].
constexpr double beside = 1e-6;

using Values = std::array<double, 2>;
using Observed = std::function<Values(double time)>;

double distance(const Values& one, const Values& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1]);
}

/// How far a function of time is from the straight lines between the instants, and where most.
struct Missed {
  double largest = 0.0, time = 0.0, step = 0.0;
  double scale = 0.0;  ///< largest distance from a value
};

/// @param knots  ascending: instants that are looked at, too
Missed missed_by(const Eigen::VectorXd& time, const Observed& value,
                 const std::vector<double>& knots) {
  const Values origin = {0.0, 0.0};
  Missed missed;
  double place = 0.0;
  auto knot = knots.begin();
  for (Eigen::Index i = 0; i + 1 < time.size(); ++i) {
    const double h = time(i + 1) - time(i);
    const Values begin = value(time(i) + beside * h), end = value(time(i + 1) - beside * h);
    missed.scale = std::max({missed.scale, distance(begin, origin), distance(end, origin)});
    const auto look = [&](double at) {
      const Values here = value(time(i) + (beside + (1.0 - 2.0 * beside) * at) * h);
      const Values line = {begin[0] + at * (end[0] - begin[0]),
                           begin[1] + at * (end[1] - begin[1])};
      missed.scale = std::max(missed.scale, distance(here, origin));
      if (distance(here, line) <= missed.largest) return;
      missed.largest = distance(here, line);
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
  return missed;
}

/// What is said of a law: who, and what of it.
struct Subject {
  std::string who;   ///< `the load "push"`
  std::string what;  ///< "value"
  double most_missed = most_missed_share;
};

void add_missed(const Subject& subject, const Missed& missed, double scale,
                std::vector<Doubt>& doubts) {
  if (!(missed.largest > subject.most_missed * scale)) return;
  doubts.push_back(
      {fmt::format("{} changes faster than the steps can follow: within the step of {:.3g} s at "
                   "t = {:.4g} s its {} is {} of the largest away from what the steps see. "
                   "Give an oscillation 22 steps or more, a revolution 32: a smaller "
                   "/simulation/step.",
                   subject.who, missed.step, missed.time, subject.what,
                   rough_percent(missed.largest / scale)),
       true});
}

void add_load(const std::string& name, const TimeFunction& function, const Design<double>& design,
              const Eigen::VectorXd& time, std::vector<Doubt>& doubts) {
  if (depends_on_state(function)) return;
  const TimeLaw<double> law = resolve_time_law(function, design);
  const Missed missed = missed_by(
      time,
      [&](double t) -> Values {
        return {law.at(t).value, 0.0};
      },
      sharp_times(function, time(time.size() - 1)));
  add_missed({fmt::format("the load \"{}\"", name), "value"}, missed, missed.scale, doubts);
}

/// The first time within the simulation at which the speed of straight lines or of a formula jumps.
std::optional<double> speed_jump(const TimeFunction& motion, const TimeLaw<double>& law,
                                 double end) {
  const auto* table = std::get_if<TableFunction>(&motion);
  const bool is_straight = table && table->interpolation == Interpolation::linear;
  if (!is_straight && !std::holds_alternative<ExpressionFunction>(motion)) return std::nullopt;
  constexpr double small = 1e-6, close = 1e-9;
  const std::vector<double> times = sharp_times(motion, end);
  double fastest = 0.0;
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

void add_drive(const Joint& joint, const TimeLaw<double>& law, const Eigen::VectorXd& time,
               std::vector<Doubt>& doubts) {
  const std::string who = fmt::format("the drive of the joint \"{}\"", joint.name);
  const bool is_formula = std::holds_alternative<ExpressionFunction>(joint.drive->motion);
  if (const auto jump = speed_jump(joint.drive->motion, law, time(time.size() - 1))) {
    doubts.push_back(
        {fmt::format("{} {}: its speed jumps at t = {:.4g} s, where forces "
                     "would be infinite; what is shown depends on the step. {}.",
                     who, is_formula ? "has a kink" : "follows straight lines", *jump,
                     is_formula ? "Leave out min, max and abs, or take a table or a \"ramp\" with "
                                  "\"rounding\""
                                : "Take the \"interpolation\" \"monotone\" or \"spline\""),
         true});
    return;
  }
  const std::vector<double> knots = sharp_times(joint.drive->motion, time(time.size() - 1));
  if (joint.drive->coordinate == DrivenCoordinate::angle) {
    const Missed turned = missed_by(
        time,
        [&](double t) -> Values {
          const double angle = law.at(t).value;
          return {std::cos(angle), std::sin(angle)};
        },
        knots);
    add_missed({who, "direction", most_missed_direction}, turned, 1.0, doubts);
    if (turned.largest > most_missed_direction) return;
  }
  const Missed moved = missed_by(
      time,
      [&](double t) -> Values {
        return {law.at(t).acceleration, 0.0};
      },
      knots);
  add_missed({who, "acceleration"}, moved, moved.scale, doubts);
}

/// @param time  the instants of the steps
std::vector<Doubt> find_fast_laws(const Scene& scene, const Design<double>& design,
                                  const Eigen::VectorXd& time) {
  std::vector<Doubt> doubts;
  for (const Joint& joint : scene.joints) {
    if (!joint.drive) continue;
    add_drive(joint, resolve_time_law(joint.drive->motion, design, LawOf::motion), time, doubts);
  }
  const auto add = [&](const std::string& name, const TimeFunction& function) {
    add_load(name, function, design, time, doubts);
  };
  for (const Load& load : scene.loads) {
    if (const auto* force = std::get_if<PointForce>(&load.element)) {
      add(load.name, force->value);
    } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
      add(load.name, torque->value);
    } else if (const auto* joint = std::get_if<JointForce>(&load.element)) {
      if (joint->motor) add(load.name, *joint->motor);
    }
  }
  return doubts;
}

}  // namespace

std::vector<Doubt> doubt_fast_laws(const TrustedRun& run) {
  return find_fast_laws(run.problem.scene, Design<double>(run.x.begin(), run.x.end()),
                        run.analysis.trajectory.time);
}

std::vector<Doubt> doubt_fast_laws_before(const ProblemFile& problem) {
  if (problem.simulation.local_error > 0.0) return {};
  SimulationOptions options{problem.simulation};
  options.breaks = time_breaks(problem.scene, options);
  const std::vector<double> instants = regular_instants(options);
  const Eigen::VectorXd x = start_design(problem);
  return find_fast_laws(problem.scene, Design<double>(x.begin(), x.end()),
                        Eigen::Map<const Eigen::VectorXd>(instants.data(), instants.size()));
}

}  // namespace pleuel
