#include "core/trust/error_bars.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/eager_matrices.hpp"
#include "core/response/history_reduction.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

namespace {

/// Relative bounds up to this are resolved, whatever the order.
constexpr double small_share = 0.05;
/// Relative differences up to this are round-off.
constexpr double value_round_off = 1e-13;
/// Peaks of stress lie at nodes, so that two divisions can agree by accident. Where differences by
/// fewer and by more elements do not approach the limit from one side, this share of the larger one
/// may be missing (order two: a third); where they fall by more than `most_fall` (order four: 16),
/// the other one, as an uneven division tells little of a place that is none of its nodes.
constexpr double share_of_turning = 0.25, share_of_falling = 0.1, most_fall = 40.0;

const double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of runs that failed: nothing bounds it.
constexpr double any_bound = std::numeric_limits<double>::infinity();

ErrorPart unresolved(double bound) {
  return {0.0, bound, false};
}

/// @returns nothing without a run, NaN of one that failed
std::optional<double> value_of(const RefinedRun* run, std::size_t response) {
  if (run == nullptr) return std::nullopt;
  return run->has_failed() ? unknown : run->values(response);
}

std::optional<double> difference(const Comparison& comparison, std::size_t response) {
  if (!comparison.is_asked()) return std::nullopt;
  return value_of(comparison.run, response).value_or(unknown) -
         value_of(comparison.beside, response).value_or(unknown);
}

bool is_there(const std::optional<double>& value) {
  return value && std::isfinite(*value);
}

/// The index of the first of increasing times that is not before a time.
Eigen::Index first_from(const Eigen::VectorXd& times, double time) {
  return std::ranges::lower_bound(times, time) - times.begin();
}

/// Of values at increasing times, straight between them.
template <class Values>
double value_at(const Eigen::VectorXd& times, const Values& values, double time) {
  const Eigen::Index next = std::clamp<Eigen::Index>(first_from(times, time), 1, times.size() - 1);
  const double before = times(next - 1);
  const double share = std::clamp((time - before) / (times(next) - before), 0.0, 1.0);
  return (1.0 - share) * values(next - 1) + share * values(next);
}

/// Of a response that is no expression:
/// Σ weight (y − y_other) over what a value depends on: the difference at a fixed time, where that of
/// two peaks leaves out what moved them. The larger one of both instants of the coarser run beside
/// it counts, as a vibration may pass through zero at one of them.
double local_difference(const Analysis& analysis, std::size_t response, const RefinedRun& other) {
  const Eigen::MatrixXd& history = analysis.histories[response];
  if (history.size() == 0 || other.histories[response].rows() != history.rows()) return 0.0;
  const Eigen::VectorXd& time = analysis.trajectory.time;
  const auto difference_at = [&](const Sample& sample, Eigen::Index there) {
    const double here = value_at(time, history.row(sample.channel), other.time(there));
    return sample.weight * (here - other.histories[response](sample.channel, there));
  };
  double before = 0.0, after = 0.0;
  for (const Sample& sample : analysis.reductions[response].samples) {
    const Eigen::Index next =
        std::min(first_from(other.time, time(sample.step)), other.time.size() - 1);
    const bool is_there = other.time(next) <= time(sample.step);
    after += difference_at(sample, next);
    before += difference_at(sample, is_there ? next : std::max<Eigen::Index>(next - 1, 0));
  }
  return std::max(std::abs(before), std::abs(after));
}

/// Of an expression, what its parts differ by, without regard to signs.
double local_difference_of_parts(const Analysis& analysis, std::size_t response,
                                 const RefinedRun& other) {
  double sum = 0.0;
  for (const WeightedResponse& part : linearized(analysis, response).parts) {
    sum += std::abs(part.weight) * local_difference(analysis, part.response, other);
  }
  return sum;
}

double small(const Evidence& evidence) {
  return small_share * evidence.magnitude;
}

/// From three values whose finest has a smaller step than the simulation. Where they agree to round-off, but
/// histories do not where the value comes from, that is an accident: what happens there may be of the step.
ErrorPart step_by_finer(const Evidence& evidence, double fine, double middle, double coarse,
                        std::optional<double>& order) {
  const double apart = std::max(std::abs(fine - middle), std::abs(middle - coarse));
  const double local = apart <= value_round_off * std::abs(fine) ? evidence.local : 0.0;
  const Extrapolation found = extrapolate(fine, middle, coarse, evidence.order, local, 0.0);
  order = found.order;
  const double change = fine - evidence.value + found.part.change;
  const double bound = std::abs(fine - evidence.value) + found.part.bound;
  if (!found.has_promised_order) return {change, bound, bound <= small(evidence)};
  return {change, std::max(safety::of_seen * std::abs(change), bound), true};
}

ErrorPart step_part(const Evidence& runs, std::optional<double>& order) {
  if (is_there(runs.half_step) && is_there(runs.quarter_step)) {
    return step_by_finer(runs, *runs.quarter_step, *runs.half_step, runs.value, order);
  }
  if (!is_there(runs.twice_step)) return unresolved(any_bound);
  const double twice = *runs.twice_step;
  if (is_there(runs.half_step)) {
    return step_by_finer(runs, *runs.half_step, runs.value, twice, order);
  }
  if (!is_there(runs.four_steps)) {
    return unresolved(std::max(std::abs(runs.value - twice), runs.local));
  }
  const Extrapolation found =
      extrapolate(runs.value, twice, *runs.four_steps, runs.order, runs.local, small(runs));
  order = found.order;
  return found.part;
}

/// @param share  of the difference of two runs that is missing in the simulation
/// @param bound  the same of the bound
ErrorPart part_of(const Evidence& evidence, const std::optional<double>& difference, double share,
                  double bound) {
  if (!difference) return {};
  if (!std::isfinite(*difference)) return unresolved(any_bound);
  const double change = share * *difference;
  if (std::abs(change) <= value_round_off * evidence.magnitude) return {};
  return {change, bound * std::abs(*difference), true};
}

void add_to(std::optional<double>& sum, const std::optional<double>& value, double factor) {
  if (!value) {
    sum.reset();
  } else if (sum) {
    *sum += factor * *value;
  }
}

}  // namespace

int scheme_order(const SimulationSettings& settings) {
  const bool is_second =
      settings.scheme == SchemeType::generalized_alpha ||
      (settings.scheme == SchemeType::newmark && settings.spectral_radius == 1.0);
  return is_second ? 2 : 1;
}

double element_order(const ProblemFile& problem, std::size_t response) {
  const std::vector<std::size_t> parts = parts_of(problem, response);
  const bool is_of_shear = std::ranges::any_of(parts, [&](std::size_t part) {
    const ResponseSettings& one = problem.responses[part];
    if (one.is<ShearStressResponse>()) return true;
    const auto* force = one.as<SectionForceResponse>();
    return force != nullptr &&
           (force->part == SectionForcePart::shear_y || force->part == SectionForcePart::shear_z);
  });
  return is_of_shear ? 1.0 : 2.0;
}

bool is_near_order(const std::optional<double>& seen, double promised) {
  return seen && std::abs(*seen - promised) <= safety::order_room;
}

Extrapolation extrapolate(double fine, double middle, double coarse, double order, double local,
                          double small) {
  const double last = fine - middle, before = middle - coarse;
  Extrapolation found;
  if (last != 0.0 && last * before > 0.0) found.order = std::log2(before / last);
  if (std::max({std::abs(last), std::abs(before), local}) <= value_round_off * std::abs(fine))
    return {};
  const double share = std::pow(2.0, -order), remaining = share / (1.0 - share);
  found.has_promised_order = is_near_order(found.order, order);
  if (found.has_promised_order) {
    found.part.change = remaining * last;
    found.part.bound = safety::of_order * remaining * std::max(std::abs(last), local);
    return found;
  }
  const bool falls = found.order && *found.order >= 1.0;
  found.part.bound = (falls ? safety::of_falling : safety::of_difference) *
                     std::max({std::abs(last), share * std::abs(before), local});
  found.part.is_resolved = found.part.bound <= small;
  return found;
}

void Evidence::add(const Evidence& other, double factor) {
  value += factor * other.value;
  element_order = std::min(element_order, other.element_order);
  local += std::abs(factor) * other.local;
  add_to(quarter_step, other.quarter_step, factor);
  add_to(half_step, other.half_step, factor);
  add_to(twice_step, other.twice_step, factor);
  add_to(four_steps, other.four_steps, factor);
  add_to(more_elements, other.more_elements, factor);
  add_to(fewer_elements, other.fewer_elements, factor);
  add_to(modes, other.modes, factor);
  add_to(newton, other.newton, factor);
}

Evidence evidence_of(const Analysis& analysis, std::size_t response, const JudgingRuns& runs,
                     double order) {
  Evidence evidence;
  evidence.order = order;
  evidence.value = analysis.reductions[response].value;
  evidence.magnitude = magnitude_of(analysis, response);
  if (runs.twice_step != nullptr && !runs.twice_step->has_failed()) {
    evidence.local = local_difference_of_parts(analysis, response, *runs.twice_step);
  }
  evidence.quarter_step = value_of(runs.quarter_step, response);
  evidence.half_step = value_of(runs.half_step, response);
  evidence.twice_step = value_of(runs.twice_step, response);
  evidence.four_steps = value_of(runs.four_steps, response);
  evidence.more_elements = difference(runs.more_elements, response);
  evidence.fewer_elements = difference(runs.fewer_elements, response);
  if (!depends_on_motion(
          analysis, response)) {  // a constant does not depend on the step, though runs may fail
    for (auto* run : {&evidence.quarter_step, &evidence.half_step}) {
      if (*run) *run = evidence.value;
    }
    evidence.twice_step = evidence.four_steps = evidence.value;
  }
  evidence.modes = difference(runs.modes, response);
  evidence.newton = difference(runs.newton, response);
  return evidence;
}

namespace {

/// What of a difference by fewer and by more elements is missing, and factors of bounds.
struct ElementShares {
  double left, missing, of_fewer, of_more;

  explicit ElementShares(double order)
      : left(1.0 / (std::pow(2.0, order) - 1.0)),
        missing(1.0 + left),
        of_fewer(3.0 * left * safety::of_fewer),
        of_more(0.75 * missing * safety::of_more) {}
};

}  // namespace

ErrorPart element_part(const Evidence& runs) {
  const ElementShares shares(runs.element_order);
  if (!runs.more_elements) {
    return part_of(runs, runs.fewer_elements, -shares.left, shares.of_fewer);
  }
  ErrorPart part = part_of(runs, runs.more_elements, shares.missing, shares.of_more);
  if (!is_there(runs.more_elements) || !is_there(runs.fewer_elements)) return part;
  const double more = *runs.more_elements, fewer = *runs.fewer_elements;
  if (std::abs(fewer) <= value_round_off * runs.magnitude) return part;
  const bool turns = more * fewer >= 0.0;
  if (turns || std::abs(fewer) > most_fall * std::abs(more)) {
    const double share = turns ? share_of_turning : share_of_falling;
    part.bound = std::max(part.bound, share * std::abs(fewer));
  }
  return part;
}

ErrorPart mode_part(const Evidence& runs) {
  return part_of(runs, runs.modes, 1.0, safety::of_modes);
}

ErrorBar error_bar(const Evidence& evidence) {
  ErrorBar bar;
  bar.step = step_part(evidence, bar.order);
  bar.elements = element_part(evidence);
  bar.elements.add(mode_part(evidence));
  bar.newton = part_of(evidence, evidence.newton, 1.0, safety::of_newton);
  const double size = std::max(std::abs(evidence.value), evidence.magnitude);
  for (ErrorPart* part : {&bar.step, &bar.elements, &bar.newton}) {
    if (part->is_resolved && part->bound <= value_round_off * size) *part = {};
    part->is_resolved = part->is_resolved && !(part->bound > size);  // all of it may be wrong
  }
  return bar;
}

namespace {

/// Orders from here on say what is left.
constexpr double least_order = 0.7;
/// The bound at an instant is the largest within so many instants of twice the step.
constexpr Eigen::Index reach = 2;

struct Curve {
  Eigen::VectorXd time, values;
};

/// |fine − coarse| at the instants of the coarse one.
Curve difference(const Curve& fine, const Curve& coarse) {
  Curve curve = coarse;
  for (Eigen::Index i = 0; i < curve.time.size(); ++i) {
    curve.values(i) = std::abs(value_at(fine.time, fine.values, coarse.time(i)) - coarse.values(i));
  }
  return curve;
}

double root_mean_square(const Curve& curve) {
  return std::sqrt(curve.values.squaredNorm() / static_cast<double>(curve.values.size()));
}

/// The order that the histories show as wholes, up to the promised one.
double observed_order(const Curve& of_twice, const Curve& of_four, double promised) {
  const double now = root_mean_square(of_twice), before = root_mean_square(of_four);
  return now > 0.0 && before > 0.0 ? std::min(std::log2(before / now), promised) : 0.0;
}

Curve curve_of(const Response& response, const RefinedRun& run, std::size_t index) {
  return {run.time, shown_history(response, run.histories[index])};
}

bool is_there(const RefinedRun* run) {
  return run != nullptr && !run->has_failed();
}

/// The largest of a curve near each instant.
Eigen::VectorXd envelope(const Curve& curve, const Eigen::VectorXd& time) {
  Eigen::VectorXd largest(time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const Eigen::Index at = first_from(curve.time, time(i));
    const Eigen::Index first = std::max<Eigen::Index>(at - reach, 0);
    const Eigen::Index last = std::min(at + reach, curve.time.size() - 1);
    largest(i) = curve.values.segment(first, last - first + 1).maxCoeff();
  }
  return largest;
}

/// What is left by steps: of the differences, or of what those of the coarser runs promise of them where
/// that is more, as where differences are small by accident.
Eigen::VectorXd left_by_steps(const Curve& of_twice, const std::optional<Curve>& of_four,
                              double promised, const Eigen::VectorXd& time) {
  const double order = of_four ? observed_order(of_twice, *of_four, promised) : 0.0;
  const Eigen::VectorXd difference = envelope(of_twice, time);
  if (order < least_order) return safety::of_seen * difference;
  const double growth = std::pow(2.0, order);
  return safety::of_seen / (growth - 1.0) * difference.cwiseMax(envelope(*of_four, time) / growth);
}

}  // namespace

std::vector<Eigen::VectorXd> error_bands(const ProblemFile& problem, const Analysis& analysis,
                                         const JudgingRuns& runs, double order) {
  std::vector<Eigen::VectorXd> bands(analysis.responses.size());
  if (!is_there(runs.twice_step)) return bands;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const Response& response = analysis.responses[i];
    if (analysis.histories[i].size() == 0) continue;
    const Curve now{analysis.trajectory.time, shown_history(response, analysis.histories[i])};
    const Curve twice = curve_of(response, *runs.twice_step, i);
    const Curve of_twice = difference(now, twice);
    std::optional<Curve> of_four;
    if (is_there(runs.four_steps)) {
      of_four = difference(twice, curve_of(response, *runs.four_steps, i));
    }
    Eigen::VectorXd& band = bands[i];
    band = left_by_steps(of_twice, of_four, order, now.time);
    const auto add = [&](const Comparison& comparison, double factor) {
      if (!is_there(comparison.run) || !is_there(comparison.beside)) return;
      const Curve apart = difference(curve_of(response, *comparison.run, i),
                                     curve_of(response, *comparison.beside, i));
      band += factor * envelope(apart, now.time);
    };
    const ElementShares shares(element_order(problem, i));
    add(runs.more_elements, shares.of_more);
    if (!is_there(runs.more_elements.run)) add(runs.fewer_elements, shares.of_fewer);
    add(runs.modes, safety::of_modes);
    add(runs.newton, safety::of_newton);
  }
  return bands;
}

}  // namespace pleuel
