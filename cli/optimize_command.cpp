#include <fmt/format.h>

#include "cli/commands.hpp"
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

/// Simulates a design for its trajectory file and gives the values of its responses.
Eigen::VectorXd write_design(const std::filesystem::path& path, const ProblemFile& problem,
                             const Eigen::VectorXd& x) {
  const auto analysis = analyze(problem, x);
  write_trajectory(path, *analysis);
  Eigen::VectorXd values(static_cast<Eigen::Index>(analysis->reductions.size()));
  for (std::size_t i = 0; i < analysis->reductions.size(); ++i) {
    values(static_cast<Eigen::Index>(i)) = analysis->reductions[i].value;
  }
  return values;
}

ExitCode exit_code(const Optimum& optimum) {
  if (!optimum.has_design()) return ExitCode::simulation_failed;
  return optimum.result.status == Status::verified ? ExitCode::done : ExitCode::not_verified;
}

Result solve_visibly(DesignProblem& problem, const SolveOptions& options,
                     const std::filesystem::path& folder, std::FILE* out) {
  fmt::print(out, "{}: minimize {} by {} variables under {} constraints, with {}\n\n",
             problem.file().name, problem.objective_name(), problem.variables().size(),
             problem.constraints().size(), options.backend);
  HistoryCsv history(folder / "history.csv", problem);
  IterationLines lines(out, problem.file());
  return solve_design(problem, options, [&](const EvaluationRecord& record) {
    history.add(record);
    lines.see(record);
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
  DesignProblem problem(input.problem);
  RunRecord record(arguments, input, options_document(options));
  record.begin_phase("optimize");
  const Result result = solve_visibly(problem, options, record.folder(), arguments.progress());
  Optimum optimum{input.problem, result, {}, {}};
  if (optimum.has_design()) {
    record.begin_phase("trajectories");
    optimum.start_responses = write_design(record.folder() / "trajectory-start.csv", input.problem,
                                           start_design(input.problem));
    optimum.responses =
        write_design(record.folder() / "trajectory-optimum.csv", input.problem, result.x);
  }
  const Outcome outcome{exit_code(optimum), optimum_document(optimum),
                        optimum_report(optimum) + files_text(record, optimum)};
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
