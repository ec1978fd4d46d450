#include "studies/accuracy_optimum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/stop.hpp"
#include "optimization/design/design_solve.hpp"

namespace pleuel {

namespace {

constexpr std::size_t most_settings = 6;

bool has_design(const Result& result) {
  const bool is_within = result.max_violation <= Tolerances().violation;
  return result.is_optimum() || (result.status == Status::stalled && is_within);
}

Result solve_from(ProblemFile problem, const Eigen::VectorXd* start, const SolveOptions& options,
                  EvaluationStore* store = nullptr) {
  problem.simulation.checks_resolution = false;
  DesignProblem design(std::move(problem), 1, store);
  if (start != nullptr) design.start_from(within_bounds(design, *start));
  return solve_design(design, options);
}

/// @param start  by default that of the file; from another one it is timed once
OptimumRun optimize_with(const ProblemFile& problem, const Discretization& settings,
                         const SolveOptions& options, const Eigen::VectorXd* start = nullptr) {
  OptimumRun run;
  run.settings = settings;
  const ProblemFile discrete = discretized(problem, settings);
  Result result;
  const auto solve = [&] { result = solve_from(discrete, start, options); };
  run.seconds = start != nullptr ? processor_seconds(solve) : least_seconds(solve);
  if (result.status == Status::interrupted) throw Stopped{};
  run.status = result.status;
  run.evaluations = result.evaluations;
  if (has_design(result)) {
    run.x = result.x;
    run.objective = problem.objective->sign() * result.evaluation.objective;
  } else {
    run.failure = to_string(result.status) + ": " + result.message;
  }
  return run;
}

OptimumRun try_to_optimize(const ProblemFile& problem, const Discretization& settings,
                           const SolveOptions& options) {
  OptimumRun run;
  const std::string failure = failure_of([&] { run = optimize_with(problem, settings, options); });
  run.settings = settings;
  if (!failure.empty()) run.failure = failure;
  return run;
}

std::optional<double> error_of(const OptimumRun& reference, const ProblemFile& problem,
                               const SolveOptions& options) {
  const ProblemFile finest = discretized(problem, reference.settings);
  const PricedDesign design(finest, reference.x);
  const std::optional<double> at_finest = design.lagrangian(finest);
  const auto coarser =
      design.change(at_finest, discretized(problem, slightly_coarser(reference.settings)));
  if (!coarser) return std::nullopt;
  const auto other = design.change(at_finest, other_formulation(problem).of(finest));
  const double error =
      std::max(richardson_share * std::abs(*coarser), std::abs(other.value_or(0.0)));
  return error + options.tolerance * std::abs(reference.objective);
}

/// Runs than which no other is faster and more accurate, the fastest first.
std::vector<std::size_t> efficient_runs(const AccuracyStudy& study) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    if (!study.runs[i].has_failed()) order.push_back(i);
  }
  std::ranges::stable_sort(order, [&](std::size_t one, std::size_t other) {
    return study.runs[one].seconds() < study.runs[other].seconds();
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    const double error = study.counted_error(study.runs[i].errors);
    if (error >= least) continue;
    least = error;
    front.push_back(i);
  }
  return front;
}

}  // namespace

double OptimumStudy::relative_floor() const {
  const double size = std::abs(reference.objective);
  return size > 0.0 ? reference_error.value_or(0.0) / size : 0.0;
}

double OptimumStudy::relative_error(const OptimumRun& run) const {
  const double size = std::abs(reference.objective);
  return std::max(size > 0.0 ? std::abs(run.change) / size : 0.0, relative_floor());
}

Result plain_optimum(ProblemFile problem, const SolveOptions& options, EvaluationStore* store) {
  return solve_from(std::move(problem), nullptr, options, store);
}

std::vector<Discretization> efficient_settings(const AccuracyStudy& study) {
  std::vector<std::size_t> chosen;
  const auto choose = [&](std::size_t i) {
    const bool is_new = std::ranges::find(chosen, i) == chosen.end();
    if (is_new && chosen.size() < most_settings) chosen.push_back(i);
  };
  for (const Recommendation& one : study.recommendations) {
    if (one.values) choose(*one.values);
  }
  const std::vector<std::size_t> front = efficient_runs(study);
  // Both ends, then what lies between.
  if (!front.empty()) choose(front.back());
  for (const std::size_t i : front) choose(i);
  std::ranges::sort(chosen, [&](std::size_t one, std::size_t other) {
    return study.runs[one].seconds() < study.runs[other].seconds();
  });
  std::vector<Discretization> settings;
  for (const std::size_t i : chosen) settings.push_back(study.runs[i].settings);
  return settings;
}

OptimumStudy optimum_study(const ProblemFile& problem, const Eigen::VectorXd& x,
                           const AccuracyStudy& study, const SolveOptions& options,
                           const OptimumObserver& observer, PartStore* parts) {
  OptimumStudy optima;
  optima.reference = kept_part(parts, "optimum of the reference", [&] {
    return optimize_with(problem, study.reference.settings, options, &x);
  });
  if (observer) observer(optima.reference);
  try {
    if (!optima.reference.has_failed()) {
      optima.reference_error = kept_part(parts, "error of the optimum of the reference", [&] {
        return error_of(optima.reference, problem, options);
      });
    }
    for (const Discretization& settings : efficient_settings(study)) {
      OptimumRun run = kept_part(parts, "optimum with " + name_of(settings),
                                 [&] { return try_to_optimize(problem, settings, options); });
      if (!run.has_failed()) run.change = run.objective - optima.reference.objective;
      optima.runs.push_back(std::move(run));
      if (observer) observer(optima.runs.back());
    }
  } catch (const Stopped&) {
    optima.is_interrupted = true;
  }
  return optima;
}

}  // namespace pleuel
