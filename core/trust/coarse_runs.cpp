#include "core/trust/coarse_runs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/jobs/parallel.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

namespace {

/// Of the largest magnitude in a history: values below it are "near zero".
constexpr double near_zero_value = 1e-2;
/// A place that comes near to the zero of its axis: of its motion.
constexpr double near_zero_place = 0.1;
/// Of a limit: values below it do not come near to it.
constexpr double far_from_limit = 0.1;
/// Motions that are none, of a coordinate.
constexpr double least_motion = 1e-4;
/// Of the largest magnitude in histories of the same unit, and of what formulas and integrals add
/// up.
constexpr double round_off_of_unit = 1e-12, round_off_of_sums = 1e-9, cancelled = 1e-6;

class ResponseChanges {
 public:
  ResponseChanges(const ProblemFile& problem, const Analysis& reference, const Analysis& other)
      : problem_(problem), reference_(reference), other_(other) {
    for (std::size_t i = 0; i < problem.responses.size(); ++i) {
      double& largest = largest_of_unit_[reference.responses[i].unit];
      largest = std::max(largest, magnitude(i));
    }
  }

  ResponseChange of(std::size_t i) const {
    if (is_monitor(problem_, i)) return {};
    const double difference = std::abs(other_.reductions[i].value - value(i));
    const Measure measure = measure_of(i);
    if (!(difference > measure.round_off)) return {};
    const double far_limit = is_coordinate(i) ? 0.0 : far_from_limit * largest_limit(i);
    return {difference / measure.scale, difference / std::max(measure.scale, far_limit)};
  }

 private:
  struct Measure {
    double scale, round_off;
  };

  double value(std::size_t i) const { return reference_.reductions[i].value; }
  double magnitude(std::size_t i) const { return magnitude_of(reference_, i); }

  Measure measure_of(std::size_t i) const {
    const double size = std::abs(value(i));
    // What vanishes in the reference alone changes by a number that can be read.
    const double least = near_zero_value * std::abs(other_.reductions[i].value);
    const Response& response = reference_.responses[i];
    if (response.expression() != nullptr) {
      return {std::max({size, cancelled * magnitude(i), least}), round_off_of_sums * magnitude(i)};
    }
    if (problem_.responses[i].is(FatigueNumber::damage)) return {std::max(size, least), 0.0};
    if (response.is_reduced_by(OverTime::integral)) {
      const Eigen::VectorXd& time = reference_.trajectory.time;
      const double sum = magnitude(i) * (time(time.size() - 1) - time(0));
      return {std::max(size, near_zero_value * sum), round_off_of_sums * sum};
    }
    const double round_off = round_off_of_unit * largest_of_unit_.at(response.unit);
    if (is_coordinate(i)) {
      const double motion = std::max(motion_of(i), least_motion * size);
      return {std::clamp(size, near_zero_place * motion, motion), round_off};
    }
    return {std::max(size, near_zero_value * magnitude(i)), round_off};
  }

  bool is_coordinate(std::size_t i) const {
    const ResponseSettings& response = problem_.responses[i];
    return time_derivative_of(response) == TimeDerivative::none ||
           response.is(LoadNumber::spring_length);
  }

  /// The farthest from where the file draws it.
  double motion_of(std::size_t i) const {
    const Eigen::MatrixXd& history = reference_.histories[i];
    if (history.size() == 0) return 0.0;
    Signal& signal = *reference_.responses[i].history()->signal;
    if (signal.channels() != history.rows()) {
      return (history.rowwise().maxCoeff() - history.rowwise().minCoeff()).maxCoeff();
    }
    Eigen::VectorXd drawn(signal.channels());
    signal.observe(reference_.model.mechanism.guess, drawn);
    return (history.colwise() - drawn).cwiseAbs().maxCoeff();
  }

  double largest_limit(std::size_t i) const {
    double largest = 0.0;
    for (const ConstraintSettings& limit : problem_.constraints) {
      if (limit.response != problem_.responses[i].name) continue;
      largest = std::max(
          {largest, std::abs(limit.lower.value_or(0.0)), std::abs(limit.upper.value_or(0.0))});
    }
    return largest;
  }

  const ProblemFile& problem_;
  const Analysis& reference_;
  const Analysis& other_;
  std::map<std::string, double> largest_of_unit_;
};

/// Changes of what is asked by which a coarser run says the same: half of those that are told.
constexpr double same_values = 0.005;
/// Runs of fewer steps may agree on having seen nothing.
constexpr int fewest_coarse_steps = 64;

/// Not where it failed, or where windows of time hold too few of its larger steps.
bool knows_what_is_asked(const TrustedRun& run, const NestedRun& coarse) {
  return coarse.analysis && std::ranges::all_of(asked_parts(run.problem), [&](std::size_t i) {
           return std::isfinite(coarse.analysis->reductions[i].value);
         });
}

bool says_the_same(const TrustedRun& run, const NestedRun& coarse) {
  if (!knows_what_is_asked(run, coarse)) return false;
  if (coarse.analysis->trajectory.steps() < fewest_coarse_steps) return false;
  const std::vector<ResponseChange> changes =
      response_changes(run.problem, run.analysis, *coarse.analysis);
  return std::ranges::all_of(asked_parts(run.problem),
                             [&](std::size_t i) { return changes[i].of_value <= same_values; });
}

}  // namespace

std::vector<ResponseChange> response_changes(const ProblemFile& problem, const Analysis& reference,
                                             const Analysis& other) {
  const ResponseChanges changes(problem, reference, other);
  std::vector<ResponseChange> all;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) all.push_back(changes.of(i));
  return all;
}

const CoarseRuns& coarse_runs(const TrustedRun& run) {
  std::optional<CoarseRuns>& coarse = run.shared->coarse;
  if (coarse) return *coarse;
  coarse.emplace();
  for_each_in_parallel(2, available_threads(), [&](int i) {
    NestedRun& nested = i == 0 ? coarse->twice : coarse->four;
    nested = simulate_refined(run.problem, run.x, {i == 0 ? 2.0 : 4.0}, &run.analysis.trajectory);
  });
  coarse->is_four_enough = says_the_same(run, coarse->four);
  return *coarse;
}

namespace {

/// Null: the run that is judged.
const NestedRun* basis_of(const TrustedRun& run) {
  const CoarseRuns& coarse = coarse_runs(run);
  if (coarse.is_four_enough) return &coarse.four;
  return knows_what_is_asked(run, coarse.twice) ? &coarse.twice : nullptr;
}

}  // namespace

const Analysis& basis_of_variants(const TrustedRun& run) {
  const NestedRun* basis = basis_of(run);
  return basis != nullptr ? *basis->analysis : run.analysis;
}

void compare_at_twice(const TrustedRun& run) {
  coarse_runs(run);
  run.shared->coarse->is_four_enough = false;
}

TrustedRun in_larger_steps(const TrustedRun& run) {
  const Analysis& analysis = run.shared->coarse ? basis_of_variants(run) : run.analysis;
  return {run.problem, run.x, analysis, run.monitors};
}

const Analysis& in_twice_the_step(const TrustedRun& run) {
  const bool is_there = run.shared->coarse && says_the_same(run, run.shared->coarse->twice);
  return is_there ? *run.shared->coarse->twice.analysis : run.analysis;
}

std::unique_ptr<Analysis> analyze_variant(const TrustedRun& run,
                                          const std::function<void(ProblemFile&)>& change) {
  const NestedRun* basis = basis_of(run);
  ProblemFile variant = basis != nullptr ? basis->problem : run.problem;
  change(variant);
  try {
    variant = with_steps_of(basis_of_variants(run).trajectory, std::move(variant));
    return analyze(variant, run.x, judging(&run.analysis.trajectory));
  } catch (const SimulationError&) {
    if (!run.shared->coarse->is_four_enough) throw;
  }
  compare_at_twice(run);
  return analyze_variant(run, change);
}

}  // namespace pleuel
