#include "core/trust/error_bars.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pleuel {

namespace {

/// How far the observed order may be from the promised one.
constexpr double order_room = 0.5;
/// On estimates, for the terms of higher order and for differences that are small by accident.
constexpr double safety = 1.5;
/// Relative differences up to this are resolved, whatever their order.
constexpr double small_share = 1e-2;
/// Relative differences up to this are round-off.
constexpr double round_off = 1e-13;
/// What half the step changes says so much of the limit where no order is seen.
constexpr double unknown_factor = 3.0;
/// Errors in space: bending has a higher order than two, sampled stress an uneven one.
constexpr double element_safety = 1.5;

const double unknown = std::numeric_limits<double>::quiet_NaN();

ErrorPart unresolved(double bound) {
  return {0.0, bound, false};
}

bool is_there(const NestedRun* run) {
  return run != nullptr && !run->has_failed();
}

double value_of(const NestedRun& run, std::size_t response) {
  return run.values(static_cast<Eigen::Index>(response));
}

Eigen::Index nearest(const Eigen::VectorXd& times, double time) {
  Eigen::Index index = 0;
  (times.array() - time).abs().minCoeff(&index);
  return index;
}

/// Σ weight (y − y_other) over what a value depends on, each at the nearest instant of the other
/// run: the difference at a fixed time, where that of two peaks leaves out what moved them.
double local_difference(const Analysis& analysis, std::size_t response, const NestedRun& other) {
  const Eigen::MatrixXd& history = analysis.histories[response];
  if (history.size() == 0 || other.histories[response].rows() != history.rows()) return 0.0;
  const Eigen::VectorXd& time = analysis.trajectory.time;
  double difference = 0.0;
  for (const Sample& sample : analysis.reductions[response].samples) {
    const Eigen::Index there = nearest(other.time, time(sample.step));
    const Eigen::Index here = nearest(time, other.time(there));
    difference += sample.weight * (history(sample.channel, here) -
                                   other.histories[response](sample.channel, there));
  }
  return std::abs(difference);
}

class Bar {
 public:
  Bar(const Analysis& analysis, std::size_t response, const JudgingRuns& runs, double order)
      : analysis_(analysis), response_(response), runs_(runs), order_(order) {
    value_ = analysis.reductions[response].value;
    const Eigen::MatrixXd& history = analysis.histories[response];
    magnitude_ = history.size() > 0 ? history.cwiseAbs().maxCoeff() : std::abs(value_);
  }

  ErrorBar make() {
    ErrorBar bar;
    bar.step = step(bar.order);
    bar.elements = elements();
    bar.newton = newton();
    return bar;
  }

 private:
  double of(const NestedRun& run) const { return value_of(run, response_); }

  ErrorPart step(std::optional<double>& order) const {
    if (!is_there(runs_.twice_step)) return unresolved(unknown);
    const double twice = of(*runs_.twice_step);
    if (is_there(runs_.half_step) && is_there(runs_.quarter_step)) {
      const double half = of(*runs_.half_step);
      return step_by_finer(of(*runs_.quarter_step), half, value_, order);
    }
    if (is_there(runs_.half_step)) return step_by_finer(of(*runs_.half_step), value_, twice, order);
    const double local = local_difference(analysis_, response_, *runs_.twice_step);
    if (!is_there(runs_.four_steps)) return unresolved(std::max(std::abs(value_ - twice), local));
    const Extrapolation found =
        extrapolate(value_, twice, of(*runs_.four_steps), order_, local, small());
    order = found.order;
    return found.part;
  }

  /// From three values whose finest has a smaller step than the simulation.
  ErrorPart step_by_finer(double fine, double middle, double coarse,
                          std::optional<double>& order) const {
    const Extrapolation found = extrapolate(fine, middle, coarse, order_, 0.0, 0.0);
    order = found.order;
    if (found.part.is_resolved) {
      const double change = fine - value_ + found.part.change;
      return {change, safety * std::abs(change), true};
    }
    // Without an order the last change, times three, is what is left.
    const double left = unknown_factor * std::abs(fine - middle);
    const double bound = middle == value_ ? left : std::abs(fine - value_) + left;
    return {0.0, bound, bound <= small()};
  }

  double small() const { return small_share * magnitude_; }

  ErrorPart elements() const {
    const double share = runs_.element_factor > 1.0 ? 4.0 / 3.0 : -1.0 / 3.0;
    ErrorPart part = part_of(runs_.elements, share, element_safety);
    part.add(part_of(runs_.modes, 1.0, element_safety));
    return part;
  }

  ErrorPart newton() const { return part_of(runs_.newton, 1.0, safety); }

  /// @param share  of the difference of both runs that is missing in the simulation
  ErrorPart part_of(const Comparison& comparison, double share, double factor) const {
    if (!comparison.is_asked()) return {};
    if (!is_there(comparison.run) || !is_there(comparison.beside)) return unresolved(unknown);
    const double change = share * (of(*comparison.run) - of(*comparison.beside));
    if (std::abs(change) <= round_off * magnitude_) return {};
    return {change, factor * std::abs(change), true};
  }

  const Analysis& analysis_;
  std::size_t response_;
  const JudgingRuns& runs_;
  double order_, value_ = 0.0, magnitude_ = 0.0;
};

}  // namespace

int scheme_order(const SimulationSettings& settings) {
  const bool is_second =
      settings.scheme == SchemeType::generalized_alpha ||
      (settings.scheme == SchemeType::newmark && settings.spectral_radius == 1.0);
  return is_second ? 2 : 1;
}

Extrapolation extrapolate(double fine, double middle, double coarse, double order, double local,
                          double small) {
  const double last = fine - middle, before = middle - coarse;
  Extrapolation found;
  if (last != 0.0 && last * before > 0.0) found.order = std::log2(before / last);
  const double largest = std::max({std::abs(last), std::abs(before), local});
  if (largest <= round_off * std::abs(fine)) return {};
  if (found.order && std::abs(*found.order - order) <= order_room) {
    const double remaining = 1.0 / (std::pow(2.0, order) - 1.0);
    found.part.change = remaining * last;
    found.part.bound = safety * remaining * std::max(std::abs(last), local);
    return found;
  }
  found.part.is_resolved = largest <= small;
  found.part.bound = found.part.is_resolved ? safety * largest : largest;
  return found;
}

ErrorBar error_bar(const Analysis& analysis, std::size_t response, const JudgingRuns& runs,
                   double order) {
  return Bar(analysis, response, runs, order).make();
}

}  // namespace pleuel
