#include "optimization/design/multi_start.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/stop.hpp"
#include "core/base/stopwatch.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/problem.hpp"
#include "optimization/result.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

namespace {

constexpr double same_objective = 1e-3;  ///< relative
constexpr double same_variable = 2e-2;   ///< of its magnitude
constexpr unsigned seed_of_starts = 1;

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
    if (!result.is_optimum()) continue;
    const auto known = std::ranges::find_if(
        optima, [&](const LocalOptimum& one) { return is_same(one, result, scales); });
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
  std::ranges::stable_sort(optima, {}, &LocalOptimum::objective);
  return optima;
}

/// Counts, time and history of all runs, in their order.
Result effort_of(const std::vector<StagedSolution>& solutions) {
  Result all;
  for (const StagedSolution& solution : solutions) {
    Result next = with_effort_of(solution.result, {});
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

/// A solution for another process, with what the problem of its last stage differs by from the file.
std::string pack_solution(const StagedSolution& solution) {
  const DesignProblem& problem = *solution.problem;
  std::vector<EffectSettings> effects;
  std::vector<std::optional<GradientChoice>> methods;
  for (std::size_t c = 0; c < problem.case_count(); ++c) {
    effects.push_back(problem.load_case(c).file().effects);
    methods.push_back(problem.load_case(c).method());
  }
  return packed(solution.result, solution.stages, effects, methods);
}

/// @param file     that was solved
/// @param threads  of the problem that is made again
StagedSolution unpack_solution(const std::string& bytes, const ProblemFile& file, int threads) {
  StagedSolution solution;
  ProblemFile solved = file;
  std::vector<EffectSettings> effects;
  std::vector<std::optional<GradientChoice>> methods;
  unpack(bytes, solution.result, solution.stages, effects, methods);
  const std::vector<ProblemFile*> problems = simulated_problems(solved);
  for (std::size_t c = 0; c < problems.size(); ++c) {
    problems[c]->effects = std::move(effects[c]);
    const bool is_chosen = !solution.stages.empty() && !solution.stages.back().settings.empty();
    if (!is_chosen) continue;
    *problems[c] = refined(std::move(*problems[c]), solution.stages.back().settings[c].setting);
  }
  solution.problem = std::make_unique<DesignProblem>(std::move(solved), threads);
  for (std::size_t c = 0; c < methods.size(); ++c) {
    if (methods[c]) solution.problem->load_case(c).decide_method(*methods[c]);
  }
  return solution;
}

/// What a message of a search is.
enum class MessageKind : char { record, notice };

/// A search from each of several designs.
struct SearchData {
  static constexpr const char* kind = search_work_name;

  ProblemFile file;
  std::vector<Eigen::VectorXd> starts;
  SolveOptions options;

  std::string run(int task, const std::string& /*needed*/, TaskCaller& caller,
                  EvaluationStore* store) const {
    const SearchSetup setup = {
        options,
        {{.jobs = available_threads()}, store},
        [&](const EvaluationRecord& record) { caller.tell(packed(MessageKind::record, record)); },
        [&](const std::string& text) { caller.tell(packed(MessageKind::notice, text)); }};
    return pack_solution(solve_in_stages(file, starts[task], setup));
  }
};

/// Hears of the searches.
class Searches : public StoredTasks<SearchData> {
 public:
  Searches(SearchData data, const SearchSetup& setup)
      : StoredTasks(std::move(data), setup.execution.store), setup_(setup) {}

  int count() const override { return int_size(data().starts); }

  void hear(int task, const std::string& message) override {
    announce(task);
    Unpacker unpacker(message);
    MessageKind kind = MessageKind::record;
    unpacker(kind);
    if (kind == MessageKind::notice) {
      std::string text;
      unpacker(text);
      return notify(setup_.notice, text);
    }
    EvaluationRecord record;
    unpacker(record);
    seen_.push_back(record);
    show(setup_.observer, following(record, before_));
  }

  void take(int task, const std::string& answer) override {
    announce(task);
    add(unpack_solution(answer, data().file, setup_.execution.tasks.jobs));
  }

  void fail(int task, const std::string& failure) override {
    announce(task);
    StagedSolution none;
    none.problem = std::make_unique<DesignProblem>(data().file);
    none.result.status = Status::failed;
    none.result.message = fmt::format("the search from start {} was lost: {}", task + 1, failure);
    none.result.x = data().starts[task];
    none.result.history = std::move(seen_);
    none.result.evaluations = int_size(none.result.history);
    notify(setup_.notice, none.result.message);
    add(std::move(none));
  }

  std::vector<StagedSolution> take_solutions() { return std::move(solutions_); }

 private:
  /// What comes from here on is of this search. After a stop, others are heard after a search that did
  /// not end.
  void announce(int task) {
    if (task < announced_) return;
    if (!seen_.empty()) {
      const EvaluationRecord& last = seen_.back();
      add_effort(last.evaluation, last.iteration, last.seconds);
    }
    announced_ = task + 1;
    notify(setup_.notice, fmt::format("start {} of {}", task + 1, data().starts.size()));
  }

  void add(StagedSolution solution) {
    const Result& result = solution.result;
    add_effort(result.evaluations, result.iterations, result.seconds);
    solutions_.push_back(std::move(solution));
  }

  void add_effort(int evaluations, int iterations, double seconds) {
    before_.evaluations += evaluations;
    before_.iterations += iterations;
    before_.seconds += seconds;
    seen_.clear();
  }

  const SearchSetup& setup_;
  std::vector<StagedSolution> solutions_;
  Result before_;  ///< the counts of all that have ended
  History seen_;   ///< of the one that has not
  int announced_ = 0;
};

}  // namespace

std::vector<Eigen::VectorXd> starts_of(const ProblemFile& file, const Eigen::VectorXd& first,
                                       int count) {
  std::vector<Eigen::VectorXd> starts = {first};
  for (const std::vector<double>& given : file.optimizer.given_starts) {
    starts.push_back(Eigen::Map<const Eigen::VectorXd>(given.data(), given.size()));
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

std::unique_ptr<TaskWork> make_search_work(const std::string& content) {
  return make_stored_work<SearchData>(content);
}

MultiStart combined(const std::vector<Eigen::VectorXd>& starts,
                    std::vector<StagedSolution> solutions) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < solutions.size(); ++i) {
    if (is_better(solutions[i].result, solutions[best].result, Tolerances().violation)) best = i;
  }
  MultiStart all;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    const Result& result = solutions[i].result;
    all.runs.push_back({starts[i], result.status, result.evaluation.objective, result.max_violation,
                        result.evaluations, std::nullopt});
  }
  if (solutions[best].problem) {
    all.optima = distinct_optima(
        solutions, variable_scales(*solutions[best].problem, solutions[best].result.x));
  }
  for (std::size_t k = 0; k < all.optima.size(); ++k) {
    for (const std::size_t i : all.optima[k].starts) all.runs[i].optimum = k;
  }
  Result effort = effort_of(solutions);
  all.best = std::move(solutions[best]);
  Result& result = all.best.result;
  result = with_effort_of(std::move(effort), std::move(result));
  if (all.runs.size() > 1) result.message += sentence_of(all);
  return all;
}

MultiStart solve_from_starts(const ProblemFile& file, const std::vector<Eigen::VectorXd>& starts,
                             SearchSetup setup) {
  setup.options.starts = int_size(starts);
  if (starts.size() == 1) {
    std::vector<StagedSolution> solutions;
    solutions.push_back(solve_in_stages(file, starts.front(), setup));
    return combined(starts, std::move(solutions));
  }
  const Stopwatch all_searches;
  Searches searches({file, starts, setup.options}, setup);
  run_tasks(searches, setup.execution.tasks);
  MultiStart all = combined(starts, searches.take_solutions());
  all.best.result.seconds = all_searches.seconds();  // they run at the same time
  return all;
}

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
      static_cast<int>(std::ranges::count_if(seen, [](const EvaluationRecord& record) {
        return record.request == Request::values_and_gradients;
      }));
  result.max_violation = best.max_violation;
  result.seconds = seen.back().seconds;
  result.history = seen;
  return result;
}

}  // namespace

WholeSearch search_design(const ProblemFile& file, const std::vector<Eigen::VectorXd>& starts,
                          const SearchSetup& setup) {
  auto first = std::make_unique<DesignProblem>(file, setup.execution.tasks.jobs);
  History seen;
  const SearchSetup seeing = setup.heard_by([&](const EvaluationRecord& record) {
    seen.push_back(record);
    show(setup.observer, record);
  });
  WholeSearch search;
  try {
    search.all = solve_from_starts(file, starts, seeing);
    if (has_choices(file)) search.sizes = choose_sizes(search.all.best, seeing);
  } catch (const Stopped&) {
    if (seen.empty() || seen.front().has_failed()) throw;
    search = {};
    search.all.best.result = interrupted_result(*first, setup.options, seen);
    search.all.best.problem = std::move(first);
  }
  return search;
}

}  // namespace pleuel
