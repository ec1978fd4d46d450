#include <fmt/format.h>

#include "cli/commands.hpp"
#include "cli/failed_design.hpp"
#include "cli/history_csv.hpp"
#include "cli/iteration_lines.hpp"
#include "cli/optimum_document.hpp"
#include "cli/optimum_report.hpp"
#include "cli/run_record.hpp"
#include "cli/solve_settings.hpp"
#include "cli/trajectory_csv.hpp"
#include "optimization/design_problem.hpp"
#include "optimization/design_solve.hpp"

namespace pleuel {

namespace {

/// Simulates the first and the last design for their trajectory files and for what is reported of
/// them.
void examine_designs(const RunRecord& record, Optimum& optimum) {
  const auto start = analyze(optimum.problem, start_design(optimum.problem));
  write_trajectory(record.folder() / "trajectory-start.csv", *start);
  optimum.start_responses = values_of(*start);
  const auto end = analyze(optimum.problem, optimum.result.x);
  write_trajectory(record.folder() / "trajectory-optimum.csv", *end);
  optimum.responses = values_of(*end);
  optimum.monitors = monitor(end->model, end->trajectory);
}

ExitCode exit_code(const Optimum& optimum) {
  if (!optimum.has_design()) return ExitCode::simulation_failed;
  return optimum.result.status == Status::verified ? ExitCode::done : ExitCode::not_verified;
}

Result solve_visibly(DesignProblem& problem, const SolveOptions& options,
                     const RunRecord& run_record, const Arguments& arguments) {
  std::FILE* out = arguments.progress();
  fmt::print(out, "{}: minimize {} by {} variables under {} constraints, with {}\n\n",
             problem.file().name, problem.objective_name(), problem.variables().size(),
             problem.constraints().size(), options.backend);
  HistoryCsv history(run_record.folder() / "history.csv", problem);
  IterationLines lines(out, problem.file());
  const Observer observer = [&](const EvaluationRecord& record) {
    history.add(record);
    lines.see(record);
    if (!record.has_failed()) return;
    write_failed_design(run_record, arguments, problem.file(), record);
  };
  return solve_design(problem, options, observer, [out](const std::string& notice) {
    fmt::print(out, "  {}\n", notice);
    std::fflush(out);
  });
}

std::string files_text(const RunRecord& record, const Optimum& optimum) {
  return fmt::format("Written to {}: history.csv, result.json, run_card.json{}\n",
                     record.folder().string(),
                     optimum.has_design() ? ", trajectory-start.csv, trajectory-optimum.csv" : "");
}

}  // namespace

Outcome run_optimize(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const SolveOptions options = solve_options(input.problem, arguments);
  DesignProblem problem(input.problem, arguments.jobs);
  RunRecord record(arguments, input, options_document(options, input.problem));
  record.begin_phase("optimize");
  const Result result = solve_visibly(problem, options, record, arguments);
  Optimum optimum{input.problem, result, {}, {}, {}, problem.method()};
  if (optimum.has_design()) {
    record.begin_phase("trajectories");
    examine_designs(record, optimum);
  }
  const Outcome outcome{exit_code(optimum), optimum_document(optimum),
                        optimum_report(optimum) +
                            failed_design_text(record, arguments, input.problem, result.history) +
                            files_text(record, optimum)};
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
