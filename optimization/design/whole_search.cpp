#include "optimization/design/whole_search.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/stop.hpp"

namespace pleuel {

namespace {

/// What was simulated as the last evaluation was: others have other errors.
History with_last_setting(History seen) {
  const double step = seen.back().time_step;
  const int elements = seen.back().elements;
  std::erase_if(seen, [&](const EvaluationRecord& record) {
    return record.time_step != step || record.elements != elements;
  });
  return seen;
}

/// Those whose sizes are chosen, if there are any.
History chosen_ones(const ProblemFile& problem, const History& seen) {
  History chosen = seen;
  std::erase_if(chosen, [&](const EvaluationRecord& record) {
    return record.has_failed() || !keeps_choices(problem, record.x);
  });
  return chosen.empty() ? seen : chosen;
}

/// The best design so far, by the numbers of the last setting. Nothing is proven of it.
Result interrupted_result(const DesignProblem& problem, const SolveOptions& options,
                          const History& seen) {
  const History last = chosen_ones(problem.file(), with_last_setting(seen));
  const EvaluationRecord& best =
      best_record(last.front().has_failed() ? seen : last, options.verdict.violation);
  Result result;
  result.status = Status::interrupted;
  const std::string limits =
      best.max_violation > 0.0
          ? fmt::format("exceeds no limit by more than {:.1e} (relative)", best.max_violation)
          : "keeps all limits";
  result.message = fmt::format(
      "{} {} made; the best design among them has {} = {} and {}", seen.size(),
      seen.size() == 1 ? "evaluation was" : "evaluations were", problem.file().objective->response,
      problem.objective_text(best.objective), limits);
  if (!keeps_choices(problem.file(), best.x)) {
    result.message += "; its sizes are not chosen from their lists yet";
  }
  result.backend = options.backend;
  result.x = best.x;
  result.evaluations = seen.back().evaluation;
  result.iterations = seen.back().iteration;
  result.gradient_evaluations =
      static_cast<int>(std::count_if(seen.begin(), seen.end(), [](const EvaluationRecord& record) {
        return record.request == Request::values_and_gradients;
      }));
  result.max_violation = best.max_violation;
  result.seconds = seen.back().seconds;
  result.history = seen;
  return result;
}

}  // namespace

WholeSearch search_design(const ProblemFile& file, const std::vector<Eigen::VectorXd>& starts,
                          const SolveOptions& options, const Execution& execution,
                          const Observer& observer, const Notice& notice) {
  auto first = std::make_unique<DesignProblem>(file, execution.tasks.jobs);
  History seen;
  const Observer see = [&](const EvaluationRecord& record) {
    seen.push_back(record);
    if (observer) observer(record);
  };
  WholeSearch search;
  try {
    search.all = solve_from_starts(file, starts, options, execution, see, notice);
    if (has_choices(file)) {
      search.sizes = choose_sizes(search.all.best, options, execution, see, notice);
    }
  } catch (const Stopped&) {
    if (seen.empty() || seen.front().has_failed()) throw;
    search = {};
    search.all.best.result = interrupted_result(*first, options, seen);
    search.all.best.problem = std::move(first);
  }
  return search;
}

}  // namespace pleuel
