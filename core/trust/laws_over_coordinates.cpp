#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/response/force_signals.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/fast_laws.hpp"

namespace pleuel {

namespace {

/// Of the largest value: peaks and teeth, where runs with other steps see no more of them.
constexpr double most_passed_over = 0.3;
/// The same of a ripple that swings within most steps: so much is left of it where they are halved.
constexpr double most_ripple = 0.01, left_by_halves = 0.5;
/// Of the largest force, by which it exceeds those at both ends of a step: of a law over a rate, as
/// friction at rest. Where it only changes from one to the other, runs with other steps see it.
constexpr double most_exceeded = 0.1;

/// A law of a load over the coordinate of a joint, or the elongation of a spring where the name of
/// the joint is empty.
struct LawOverCoordinate {
  std::string load, joint;
  DrivenCoordinate coordinate;
  TimeLaw<double> law;
  double rest = 0.0;  ///< is taken off the coordinate
};

/// Such a coordinate in a simulation, between the instants as a cubic.
class CoordinateHistory {
 public:
  CoordinateHistory(const TrustedRun& run, const LawOverCoordinate& of)
      : time_(run.analysis.trajectory.time), values_(time_.size()), rates_(time_.size()) {
    const auto read_motion = [&](TimeDerivative derivative, Eigen::VectorXd& history) {
      const JointMotionResponse motion{of.joint, of.coordinate, derivative};
      read(run, *make_gauge_signal(of.load, motion, run.analysis.model), history);
    };
    if (of.joint.empty()) {
      const LoadResponse length{of.load, LoadNumber::spring_length};
      read(run, *make_gauge_signal(of.load, length, run.analysis.model), values_);
      take_differences();
      return;
    }
    read_motion(TimeDerivative::none, values_);
    read_motion(TimeDerivative::first, rates_);
    if (of.coordinate == DrivenCoordinate::angle) count_turns();
  }

  /// @param step  whose end is the instant `step`
  double at(int step, double share) const {
    const double h = time_(step) - time_(step - 1), rest = 1.0 - share;
    const double chord = values_(step - 1) + share * (values_(step) - values_(step - 1));
    const double slope = values_(step) - values_(step - 1);
    return chord + share * rest *
                       (rest * (h * rates_(step - 1) - slope) - share * (h * rates_(step) - slope));
  }
  double rate(int instant) const { return rates_(instant); }
  double rate_at(int step, double share) const {
    return rates_(step - 1) + share * (rates_(step) - rates_(step - 1));
  }
  double value(int instant) const { return values_(instant); }

 private:
  static void read(const TrustedRun& run, Signal& signal, Eigen::VectorXd& history) {
    for (int i = 0; i < static_cast<int>(history.size()); ++i) {
      const State state = run.analysis.trajectory.state_at(i);
      signal.observe(state, history.segment(i, 1));
    }
  }

  /// For want of rates.
  void take_differences() {
    const Eigen::Index last = time_.size() - 1;
    for (Eigen::Index i = 0; i <= last; ++i) {
      const Eigen::Index from = std::max<Eigen::Index>(0, i - 1), to = std::min(last, i + 1);
      rates_(i) = (values_(to) - values_(from)) / (time_(to) - time_(from));
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

double free_length(const SpringDamper& spring, const Design<double>& design) {
  if (spring.free_length) return resolve(*spring.free_length, design);
  return (resolve_point(spring.at[1], design) - resolve_point(spring.at[0], design)).norm();
}

std::vector<LawOverCoordinate> laws_over_coordinates(const TrustedRun& run) {
  const Design<double> design(run.x.begin(), run.x.end());
  std::vector<LawOverCoordinate> laws;
  const auto add = [&](const std::string& load, const JointCoordinate& over,
                       const TimeFunction& function, double rest) {
    const bool is_table = std::holds_alternative<TableFunction>(function);
    if (!is_table && !std::holds_alternative<ExpressionFunction>(function)) return;
    TimeLaw<double> law = resolve_time_law(function, design);
    if (is_table && law.argument == LawArgument::time) return;
    laws.push_back({load, over.joint, over.coordinate, std::move(law), rest});
  };
  for (const Load& load : run.problem.scene.loads) {
    if (const auto* point = std::get_if<PointLoad>(&load.element)) {
      if (point->over) add(load.name, *point->over, point->value, 0.0);
    } else if (const auto* joint = std::get_if<JointForce>(&load.element)) {
      const JointCoordinate over{joint->joint, joint->coordinate};
      if (joint->motor) add(load.name, over, *joint->motor, 0.0);
      if (joint->resistance) {
        add(load.name, over, *joint->resistance, resolve(joint->rest, design));
      }
    } else if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
      if (spring->resistance) add(load.name, {}, *spring->resistance, free_length(*spring, design));
    }
  }
  return laws;
}

/// Times at which the argument of a table passes its points.
std::vector<double> passages(const LawOverCoordinate& one, const CoordinateHistory& history,
                             const Eigen::VectorXd& time) {
  std::vector<double> times;
  const TimeLaw<double>& law = one.law;
  const auto argument = [&](int instant) {
    return law.argument == LawArgument::rate ? history.rate(instant)
                                             : history.value(instant) - one.rest;
  };
  for (int step = 1; step < static_cast<int>(time.size()); ++step) {
    const double begin = argument(step - 1), end = argument(step);
    if (begin == end) continue;
    std::vector<double> shares;
    for (const double knot : law.knots) {
      const double period = law.period > 0.0 ? law.period : 1.0;
      const double first =
          law.period > 0.0 ? std::ceil((std::min(begin, end) - knot) / period) : 0.0;
      const double share = (knot + first * period - begin) / (end - begin);
      if (share > 0.0 && share < 1.0) shares.push_back(share);
    }
    std::ranges::sort(shares);
    for (const double share : shares) {
      times.push_back(time(step - 1) + share * (time(step) - time(step - 1)));
    }
  }
  return times;
}

/// What a law is between the instants.
class LawBetweenInstants {
 public:
  LawBetweenInstants(const LawOverCoordinate& one, const CoordinateHistory& history,
                     const Eigen::VectorXd& time)
      : one_(one), history_(history), time_(time) {}

  /// By the coordinate and the time alone, at the rate before the step: friction that turns round
  /// within it is seen by other steps.
  MissedValues at_frozen_rates(const std::vector<double>& knots) {
    return missed_by(
        time_,
        [this](double t) {
          const auto [step, share] = place_of(t);
          return value(t, step, share, history_.rate(step - 1));
        },
        knots);
  }

  /// What exceeds the values at both ends of the step, as the rate changes.
  MissedValues beyond_ends(const std::vector<double>& knots) {
    return missed_by(
        time_,
        [this](double t) {
          const auto [step, share] = place_of(t);
          const double begin = value(time_(step - 1), step, 0.0, history_.rate(step - 1)),
                       end = value(time_(step), step, 1.0, history_.rate(step));
          const double found = value(t, step, share, history_.rate_at(step, share));
          const double within = std::clamp(found, std::min(begin, end), std::max(begin, end));
          return begin + share * (end - begin) + found - within;
        },
        knots);
  }

 private:
  struct Place {
    int step;
    double share;
  };
  Place place_of(double t) {
    while (step_ > 1 && t < time_(step_ - 1)) --step_;
    while (step_ + 1 < static_cast<int>(time_.size()) && t > time_(step_)) ++step_;
    return {step_, (t - time_(step_ - 1)) / (time_(step_) - time_(step_ - 1))};
  }
  double value(double t, int step, double share, double rate) const {
    return one_.law.value_at(t, history_.at(step, share) - one_.rest, rate);
  }

  const LawOverCoordinate& one_;
  const CoordinateHistory& history_;
  const Eigen::VectorXd& time_;
  int step_ = 1;
};

}  // namespace

std::vector<Finding> check_laws_over_coordinates(const TrustedRun& run) {
  const Eigen::VectorXd& time = run.analysis.trajectory.time;
  std::vector<Finding> findings;
  if (time.size() < 2) return findings;
  for (const LawOverCoordinate& one : laws_over_coordinates(run)) {
    const CoordinateHistory history(run, one);
    LawBetweenInstants law(one, history, time);
    const std::vector<double> knots = passages(one, history, time);
    const std::string who = fmt::format("the load \"{}\"", one.load);
    const std::size_t before = findings.size();
    if (one.law.argument != LawArgument::rate) {
      const MissedValues missed = law.at_frozen_rates(knots);
      const bool is_ripple = missed.median_of_halves > left_by_halves * missed.median &&
                             missed.median > most_ripple * missed.scale;
      add_missed({who, "value", is_ripple ? most_ripple : most_passed_over}, missed, missed.scale,
                 findings);
    }
    const bool has_rate = one.law.argument == LawArgument::rate || one.law.expression;
    if (findings.size() > before || !has_rate) continue;
    const MissedValues exceeded = law.beyond_ends(knots);
    add_missed({who, "value", most_exceeded}, exceeded, exceeded.scale, findings);
  }
  return findings;
}

}  // namespace pleuel
