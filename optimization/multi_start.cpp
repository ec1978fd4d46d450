#include "optimization/multi_start.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "optimization/scaling.hpp"
#include "optimization/starts.hpp"

namespace pleuel {

namespace {

constexpr double same_objective = 1e-3;  ///< relative
constexpr double same_variable = 2e-2;   ///< of its magnitude
constexpr unsigned seed_of_starts = 1;

bool is_optimum(const Result& result) {
  return result.status == Status::verified || result.status == Status::unresolved;
}

int rank(const Result& result) {
  if (!result.evaluation.has_gradients()) return 0;
  if (result.status == Status::verified) return 4;
  if (result.status == Status::unresolved) return 3;
  return result.max_violation <= Tolerances().violation ? 2 : 1;
}

bool is_better(const Result& one, const Result& other) {
  if (rank(one) != rank(other)) return rank(one) > rank(other);
  if (rank(one) == 0) return false;
  if (rank(one) == 1) return one.max_violation < other.max_violation;
  return one.evaluation.objective < other.evaluation.objective;
}

bool is_same(const LocalOptimum& one, const Result& other, const Eigen::VectorXd& scales) {
  const double difference = std::abs(one.objective - other.evaluation.objective);
  const Eigen::VectorXd moved = (one.x - other.x).cwiseQuotient(scales);
  return difference <= same_objective * std::abs(one.objective) &&
         moved.lpNorm<Eigen::Infinity>() <= same_variable;
}

/// Distinct ones of the results, the best first.
std::vector<LocalOptimum> distinct_optima(const std::vector<StagedSolution>& solutions,
                                          const Eigen::VectorXd& scales) {
  std::vector<LocalOptimum> optima;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    const Result& result = solutions[i].result;
    if (!is_optimum(result)) continue;
    const auto known = std::find_if(optima.begin(), optima.end(), [&](const LocalOptimum& one) {
      return is_same(one, result, scales);
    });
    if (known == optima.end()) {
      optima.push_back({result.x, result.evaluation.objective, {i}});
      continue;
    }
    known->starts.push_back(i);
    if (result.evaluation.objective < known->objective) {
      known->x = result.x;
      known->objective = result.evaluation.objective;
    }
  }
  std::stable_sort(optima.begin(), optima.end(),
                   [](const LocalOptimum& one, const LocalOptimum& other) {
                     return one.objective < other.objective;
                   });
  return optima;
}

/// Counts, time and history of all runs, in their order.
Result effort_of(const std::vector<StagedSolution>& solutions) {
  Result all;
  for (const StagedSolution& solution : solutions) {
    Result next;
    next.history = solution.result.history;
    next.evaluations = solution.result.evaluations;
    next.gradient_evaluations = solution.result.gradient_evaluations;
    next.iterations = solution.result.iterations;
    next.restarts = solution.result.restarts - 1;
    next.seconds = solution.result.seconds;
    continue_from(all, next);
    all = std::move(next);
  }
  return all;
}

/// What the other starts say of the best answer.
std::string sentence_of(const MultiStart& all) {
  const std::size_t starts = all.runs.size();
  if (all.optima.empty()) return fmt::format("; the best of {} starts", starts);
  std::string text =
      all.optima.size() == 1
          ? fmt::format("; the only local optimum that {} starts found, from {} of them", starts,
                        all.optima.front().starts.size())
          : fmt::format("; the best of {} local optima from {} starts, found from {} of them",
                        all.optima.size(), starts, all.optima.front().starts.size());
  const double best = all.best.result.evaluation.objective;
  for (std::size_t i = 0; i < starts; ++i) {
    const StartRun& run = all.runs[i];
    const bool is_within =
        run.status == Status::stalled && run.max_violation <= Tolerances().violation;
    if (is_within && run.objective < best - same_objective * std::abs(best)) {
      text += fmt::format("; start {} came to a lower objective, unproven", i + 1);
      break;
    }
  }
  return text;
}

Eigen::VectorXd scales_of(const ProblemFile& file, const Eigen::VectorXd& x) {
  Eigen::VectorXd scales(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const DesignVariable& variable = file.variables[static_cast<std::size_t>(i)];
    const double range = variable.upper - variable.lower;
    scales(i) = std::clamp(std::abs(x(i)), 0.1 * range, std::max(range, 1e-300));
  }
  return scales;
}

}  // namespace

std::vector<Eigen::VectorXd> starts_of(const ProblemFile& file, const Eigen::VectorXd& first,
                                       int count) {
  std::vector<Eigen::VectorXd> starts = {first};
  for (const std::vector<double>& given : file.optimizer.given_starts) {
    starts.push_back(
        Eigen::Map<const Eigen::VectorXd>(given.data(), static_cast<Eigen::Index>(given.size())));
  }
  if (starts.size() > 1 || count <= 1) return starts;
  std::vector<Variable> variables;
  for (const DesignVariable& variable : file.variables) {
    variables.push_back({variable.name, variable.start, variable.lower, variable.upper});
  }
  for (Eigen::VectorXd& x : latin_hypercube(variables, count - 1, seed_of_starts)) {
    starts.push_back(std::move(x));
  }
  return starts;
}

MultiStart combined(const std::vector<Eigen::VectorXd>& starts,
                    std::vector<StagedSolution> solutions) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < solutions.size(); ++i) {
    if (is_better(solutions[i].result, solutions[best].result)) best = i;
  }
  MultiStart all;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    const Result& result = solutions[i].result;
    all.runs.push_back({starts[i], result.status, result.evaluation.objective, result.max_violation,
                        result.evaluations, std::nullopt});
  }
  if (solutions[best].problem) {
    all.optima = distinct_optima(
        solutions, scales_of(solutions[best].problem->file(), solutions[best].result.x));
  }
  for (std::size_t k = 0; k < all.optima.size(); ++k) {
    for (const std::size_t i : all.optima[k].starts) all.runs[i].optimum = k;
  }
  Result effort = effort_of(solutions);
  all.best = std::move(solutions[best]);
  Result& result = all.best.result;
  result.history = std::move(effort.history);
  result.evaluations = effort.evaluations;
  result.gradient_evaluations = effort.gradient_evaluations;
  result.iterations = effort.iterations;
  result.restarts = effort.restarts;
  result.seconds = effort.seconds;
  if (all.runs.size() > 1) result.message += sentence_of(all);
  return all;
}

MultiStart solve_from_starts(const ProblemFile& file, const std::vector<Eigen::VectorXd>& starts,
                             SolveOptions options, int threads, const Observer& observer,
                             const Notice& notice) {
  options.starts = static_cast<int>(starts.size());
  std::vector<StagedSolution> solutions;
  Result before;  // the counts of all so far
  std::size_t best = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (notice && starts.size() > 1) {
      notice(fmt::format("start {} of {}", i + 1, starts.size()));
    }
    const Observer following_observer = [&](const EvaluationRecord& record) {
      if (observer) observer(following(record, before));
    };
    solutions.push_back(
        solve_in_stages(file, starts[i], options, threads, following_observer, notice));
    const Result& result = solutions.back().result;
    before.evaluations += result.evaluations;
    before.iterations += result.iterations;
    before.seconds += result.seconds;
    // The trajectory of a problem may be large: that of the best is kept.
    if (i > 0 && is_better(result, solutions[best].result)) {
      solutions[best].problem.reset();
      best = i;
    } else if (i > 0) {
      solutions[i].problem.reset();
    }
  }
  return combined(starts, std::move(solutions));
}

}  // namespace pleuel
