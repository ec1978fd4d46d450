#include "core/trust/laws_over_joints.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "core/model/scene_geometry.hpp"
#include "core/response/gauge_signal.hpp"
#include "core/trust/missed_values.hpp"

namespace pleuel {

namespace {

/// Of the largest value: peaks and teeth, where runs with other steps see no more of them.
constexpr double most_passed_over = 0.3;
/// The same of a ripple that swings within most steps: so much is left of it where they are halved.
constexpr double most_ripple = 0.01, left_by_halves = 0.5;
/// A direction is known from what it was a step before [rad].
constexpr double most_turned = 0.5 * std::numbers::pi;

/// A law of a load over the coordinate of a joint.
struct LawOverJoint {
  std::string load, joint;
  DrivenCoordinate coordinate;
  TimeLaw<double> law;
  double rest = 0.0;  ///< is taken off the coordinate
};

/// The coordinate of a joint in a simulation, between the instants as a cubic.
class JointHistory {
 public:
  JointHistory(const TrustedRun& run, const std::string& joint, DrivenCoordinate coordinate)
      : time_(run.analysis.trajectory.time), values_(time_.size()), rates_(time_.size()) {
    ResponseSettings settings;
    settings.name = settings.joint = joint;
    settings.coordinate = coordinate;
    settings.type = ResponseType::joint_position;
    read(run, settings, values_);
    settings.type = ResponseType::joint_velocity;
    read(run, settings, rates_);
    if (coordinate == DrivenCoordinate::angle) count_turns();
  }

  /// @param step  whose end is the instant `step`
  double at(int step, double share) const {
    const double h = time_(step) - time_(step - 1), rest = 1.0 - share;
    const double chord = values_(step - 1) + share * (values_(step) - values_(step - 1));
    const double slope = values_(step) - values_(step - 1);
    return chord + share * rest *
                       (rest * (h * rates_(step - 1) - slope) - share * (h * rates_(step) - slope));
  }
  double rate_before(int step) const { return rates_(step - 1); }
  double value(int instant) const { return values_(instant); }

 private:
  static void read(const TrustedRun& run, const ResponseSettings& settings,
                   Eigen::VectorXd& history) {
    const std::unique_ptr<Signal> signal = make_gauge_signal(settings, run.analysis.model);
    State state;
    for (int i = 0; i < static_cast<int>(history.size()); ++i) {
      run.analysis.trajectory.states->load(i, state);
      signal->observe(state, history.segment(i, 1));
    }
  }

  /// In space an angle is known but for whole turns: rates tell.
  void count_turns() {
    constexpr double turn = 2.0 * std::numbers::pi;
    for (Eigen::Index i = 1; i < values_.size(); ++i) {
      const double expected =
          values_(i - 1) + 0.5 * (time_(i) - time_(i - 1)) * (rates_(i - 1) + rates_(i));
      values_(i) += turn * std::round((expected - values_(i)) / turn);
    }
  }

  const Eigen::VectorXd& time_;
  Eigen::VectorXd values_, rates_;
};

std::vector<LawOverJoint> laws_over_joints(const TrustedRun& run) {
  const Design<double> design(run.x.begin(), run.x.end());
  std::vector<LawOverJoint> laws;
  const auto add = [&](const std::string& load, const JointCoordinate& over,
                       const TimeFunction& function, double rest) {
    const bool is_table = std::holds_alternative<TableFunction>(function);
    if (!is_table && !std::holds_alternative<ExpressionFunction>(function)) return;
    TimeLaw<double> law = resolve_time_law(function, design);
    if (is_table && law.argument != LawArgument::coordinate) return;
    laws.push_back({load, over.joint, over.coordinate, std::move(law), rest});
  };
  for (const Load& load : run.problem.scene.loads) {
    if (const auto* force = std::get_if<PointForce>(&load.element)) {
      if (force->over) add(load.name, *force->over, force->value, 0.0);
    } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
      if (torque->over) add(load.name, *torque->over, torque->value, 0.0);
    } else if (const auto* joint = std::get_if<JointForce>(&load.element)) {
      const JointCoordinate over{joint->joint, joint->coordinate};
      if (joint->motor) add(load.name, over, *joint->motor, 0.0);
      if (joint->resistance) {
        add(load.name, over, *joint->resistance, resolve(joint->rest, design));
      }
    }
  }
  return laws;
}

/// Times at which the coordinate passes the points of a table.
std::vector<double> passages(const LawOverJoint& one, const JointHistory& history,
                             const Eigen::VectorXd& time) {
  std::vector<double> times;
  const TimeLaw<double>& law = one.law;
  for (int step = 1; step < static_cast<int>(time.size()); ++step) {
    const double begin = history.value(step - 1) - one.rest, end = history.value(step) - one.rest;
    if (begin == end) continue;
    std::vector<double> shares;
    for (const double knot : law.knots) {
      const double period = law.period > 0.0 ? law.period : 1.0;
      const double first =
          law.period > 0.0 ? std::ceil((std::min(begin, end) - knot) / period) : 0.0;
      const double share = (knot + first * period - begin) / (end - begin);
      if (share > 0.0 && share < 1.0) shares.push_back(share);
    }
    std::sort(shares.begin(), shares.end());
    for (const double share : shares) {
      times.push_back(time(step - 1) + share * (time(step) - time(step - 1)));
    }
  }
  return times;
}

}  // namespace

std::vector<Doubt> doubt_laws_over_joints(const TrustedRun& run) {
  const Eigen::VectorXd& time = run.analysis.trajectory.time;
  std::vector<Doubt> doubts;
  if (time.size() < 2) return doubts;
  for (const LawOverJoint& one : laws_over_joints(run)) {
    const JointHistory history(run, one.joint, one.coordinate);
    int step = 1;
    // By the coordinate alone: friction that changes its sign is seen by other steps.
    const ObservedFunction value = [&](double t) -> ObservedValues {
      while (step > 1 && t < time(step - 1)) --step;
      while (step + 1 < static_cast<int>(time.size()) && t > time(step)) ++step;
      const double share = (t - time(step - 1)) / (time(step) - time(step - 1));
      return {one.law.value_at(t, history.at(step, share) - one.rest, history.rate_before(step)),
              0.0};
    };
    const MissedValues missed = missed_by(time, value, passages(one, history, time));
    const bool is_ripple = missed.median_of_halves > left_by_halves * missed.median &&
                           missed.median > most_ripple * missed.scale;
    add_missed({fmt::format("the load \"{}\"", one.load), "value",
                is_ripple ? most_ripple : most_passed_over},
               missed, missed.scale, doubts);
  }
  return doubts;
}

std::vector<Doubt> doubt_fast_turning(const TrustedRun& run) {
  const Trajectory& trajectory = run.analysis.trajectory;
  double most = most_turned, step_size = 0.0, time = 0.0;
  const BodyModel* fastest = nullptr;
  State state;
  for (int step = 1; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
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
