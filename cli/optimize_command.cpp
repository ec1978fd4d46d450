#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "cli/command_text.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/failed_design.hpp"
#include "cli/history_csv.hpp"
#include "cli/iteration_lines.hpp"
#include "cli/monitors_report.hpp"
#include "cli/optimum_document.hpp"
#include "cli/optimum_report.hpp"
#include "cli/run_record.hpp"
#include "cli/solve_settings.hpp"
#include "cli/trajectory_csv.hpp"
#include "cli/warnings.hpp"
#include "cli/wrapped_text.hpp"
#include "core/base/stop.hpp"
#include "core/scene/body_rules.hpp"
#include "core/trust/doubts.hpp"
#include "optimization/design_problem.hpp"
#include "optimization/design_solve.hpp"

namespace pleuel {

namespace {

/// Simulates the first and the last design for their trajectory files and for what is reported of
/// them.
void examine_designs(RunRecord& record, Optimum& optimum) {
  const auto start = analyze(optimum.problem, optimum.result.history.front().x);
  write_trajectory(record.result("trajectory-start.csv"), *start);
  optimum.start_responses = values_of(*start);
  const auto end = analyze(optimum.problem, optimum.result.x);
  write_trajectory(record.result("trajectory-optimum.csv"), *end);
  optimum.responses = values_of(*end);
  optimum.monitors = monitor(end->model, end->trajectory);
  // Of an answer with gradients the doubts are known: they are part of its verdict.
  optimum.warnings = optimum.result.evaluation.has_gradients()
                         ? optimum.result.warnings
                         : texts_of(find_doubts(TrustedRun{optimum.problem, optimum.result.x, *end,
                                                           optimum.monitors}));
}

ExitCode exit_code(const Optimum& optimum) {
  if (optimum.result.status == Status::interrupted) return ExitCode::not_verified;
  if (!optimum.has_design()) return ExitCode::simulation_failed;
  return optimum.result.status == Status::verified ? ExitCode::done : ExitCode::not_verified;
}

/// The best design so far. Nothing is proven of it.
Result interrupted_result(const DesignProblem& problem, const SolveOptions& options,
                          const History& seen) {
  const EvaluationRecord& best = best_record(seen, options.verdict.violation);
  Result result;
  result.status = Status::interrupted;
  result.message = fmt::format(
      "{} evaluations were made; the best design among them has {} = {} and exceeds no limit by "
      "more than {:.1e} (relative)",
      seen.size(), problem.objective_name(), problem.objective_text(best.objective),
      best.max_violation);
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

Result solve_visibly(DesignProblem& problem, const SolveOptions& options, RunRecord& run_record,
                     const Arguments& arguments) {
  std::FILE* out = arguments.progress();
  show(out, wrapped(fmt::format("{}: minimize {} by {} variables under {} constraints, with {}\n\n",
                                problem.file().name, problem.objective_name(),
                                problem.variables().size(), problem.constraints().size(),
                                options.backend)));
  show(out, warnings_text(impossible_corners(problem.file())));
  std::optional<HistoryCsv> history;  // with the first evaluation
  IterationLines lines(out, problem.file());
  History seen;
  const Observer observer = [&](const EvaluationRecord& record) {
    if (!history) history.emplace(run_record.result("history.csv"), problem);
    history->add(record);
    lines.see(record);
    if (record.has_failed()) {
      write_failed_design(run_record, arguments, problem.file(), record);
    }
    seen.push_back(record);
  };
  try {
    return solve_design(problem, options, observer, [out](const std::string& notice) {
      show(out, wrapped("  " + notice, "  ") + "\n");
    });
  } catch (const Stopped&) {
    if (seen.empty() || seen.front().has_failed()) throw;
    return interrupted_result(problem, options, seen);
  }
}

/// How to go on from an interrupted run, in a folder of its own.
std::string resume_text(const RunRecord& record, const Arguments& arguments,
                        const Optimum& optimum) {
  if (optimum.result.status != Status::interrupted) return "";
  return "To go on from there: " +
         command_at("optimize", arguments, record.folder() / "result.json") + "\n";
}

std::string files_text(const RunRecord& record, const Optimum& optimum) {
  return wrapped(
      fmt::format("Written to {}: history.csv, result.json, run_card.json{}\n",
                  record.folder().string(),
                  optimum.has_design() ? ", trajectory-start.csv, trajectory-optimum.csv" : ""),
      "  ");
}

}  // namespace

Outcome run_optimize(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const SolveOptions options = solve_options(input.problem, arguments);
  DesignProblem problem(input.problem, arguments.jobs);
  if (arguments.design) problem.start_from(input.design);
  RunRecord record(arguments, input, options_document(options, input.problem));
  show_warnings_before(input.problem);
  record.begin_phase("optimize");
  const Result result = solve_visibly(problem, options, record, arguments);
  Optimum optimum{input.problem, result, {}, {}, {}, result.warnings, problem.method()};
  // What has been found is told and written first: the rest is made from it at any time.
  show(arguments.progress(), optimum_report(optimum));
  record.write("result.json", optimum_document(optimum));
  if (optimum.has_design()) {
    record.begin_phase("trajectories");
    examine_designs(record, optimum);
  }
  Outcome outcome{exit_code(optimum), optimum_document(optimum),
                  failed_design_text(record, arguments, input.problem, result.history) +
                      resume_text(record, arguments, optimum) + files_text(record, optimum)};
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
