#include "core/trust/fast_laws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/trust/missed_values.hpp"

namespace pleuel {

namespace {

/// Share of the largest value that may be missed between two instants. Of an oscillation of n steps
/// a period that is (2π/n)²/8, and the schemes' errors are about as large: 22 steps.
constexpr double most_missed_share = 1e-2;
/// Of the direction of what a drive turns: forces of a crank contain twice its frequency, too. 32
/// steps a revolution.
constexpr double most_missed_direction = 5e-3;

void add_law(const MissedSubject& subject, const TimeFunction& function, const TimeLaw<double>& law,
             const Eigen::VectorXd& time, std::vector<Finding>& findings) {
  const MissedValues missed = missed_by(
      time,
      [&](double t) -> ObservedValues {
        return {law.at(t).value, 0.0};
      },
      sharp_times(function, time(time.size() - 1)));
  add_missed(subject, missed, missed.scale, findings);
}

void add_load(const std::string& name, const TimeFunction& function, const Design<double>& design,
              const Eigen::VectorXd& time, std::vector<Finding>& findings) {
  if (depends_on_state(function)) return;
  add_law({fmt::format("the load \"{}\"", name), "value", most_missed_share}, function,
          resolve_time_law(function, design), time, findings);
}

/// What the motor of a load follows.
void add_target(const std::string& name, const TimeFunction& target, const Design<double>& design,
                const Eigen::VectorXd& time, std::vector<Finding>& findings) {
  add_law({fmt::format("the motor of the load \"{}\"", name), "target", most_missed_share}, target,
          resolve_time_law(target, design, LawOf::motion), time, findings);
}

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

void add_drive(const Joint& joint, const TimeLaw<double>& law, const Eigen::VectorXd& time,
               std::vector<Finding>& findings) {
  const std::string who = fmt::format("the drive of the joint \"{}\"", joint.name);
  const bool is_formula = std::holds_alternative<ExpressionFunction>(joint.drive->motion);
  if (const auto jump = speed_jump(joint.drive->motion, law, time(time.size() - 1))) {
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
  const std::vector<double> knots = sharp_times(joint.drive->motion, time(time.size() - 1));
  if (joint.drive->coordinate == DrivenCoordinate::angle) {
    const MissedValues turned = missed_by(
        time,
        [&](double t) -> ObservedValues {
          const double angle = law.at(t).value;
          return {std::cos(angle), std::sin(angle)};
        },
        knots);
    add_missed({who, "direction", most_missed_direction}, turned, 1.0, findings);
    if (turned.largest > most_missed_direction) return;
  }
  const MissedValues moved = missed_by(
      time,
      [&](double t) -> ObservedValues {
        return {law.at(t).acceleration, 0.0};
      },
      knots);
  add_missed({who, "acceleration", most_missed_share}, moved, moved.scale, findings);
}

/// @param time  the instants of the steps
std::vector<Finding> find_fast_laws(const Scene& scene, const Design<double>& design,
                                    const Eigen::VectorXd& time) {
  std::vector<Finding> findings;
  for (const Joint& joint : scene.joints) {
    if (!joint.drive) continue;
    add_drive(joint, resolve_time_law(joint.drive->motion, design, LawOf::motion), time, findings);
  }
  const auto add = [&](const std::string& name, const TimeFunction& function) {
    add_load(name, function, design, time, findings);
  };
  for (const Load& load : scene.loads) {
    if (const auto* force = std::get_if<PointForce>(&load.element)) {
      add(load.name, force->value);
    } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
      add(load.name, torque->value);
    } else if (const auto* joint = std::get_if<JointForce>(&load.element)) {
      if (joint->motor) add(load.name, *joint->motor);
      if (joint->control) add_target(load.name, joint->control->target, design, time, findings);
    }
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

}  // namespace pleuel
