#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/files/command_text.hpp"
#include "cli/files/failed_design.hpp"
#include "cli/files/history_csv.hpp"
#include "cli/files/run_picture.hpp"
#include "cli/files/run_record.hpp"
#include "cli/files/run_store.hpp"
#include "cli/files/trajectory_csv.hpp"
#include "cli/input/solve_settings.hpp"
#include "cli/reports/drives_report.hpp"
#include "cli/reports/effects_report.hpp"
#include "cli/reports/iteration_lines.hpp"
#include "cli/reports/monitors_report.hpp"
#include "cli/reports/optimum_document.hpp"
#include "cli/reports/optimum_report.hpp"
#include "cli/reports/setting_report.hpp"
#include "cli/reports/starts_report.hpp"
#include "cli/reports/warnings.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/stop.hpp"
#include "core/scene/body_rules.hpp"
#include "core/trust/doubts.hpp"
#include "core/trust/nested_runs.hpp"
#include "optimization/design_problem.hpp"
#include "optimization/design_solve.hpp"
#include "optimization/multi_start.hpp"
#include "optimization/optimum_error.hpp"
#include "optimization/prices.hpp"
#include "optimization/staged_solve.hpp"

namespace pleuel {

namespace {

/// What is told of the first and the last design.
struct Examined {
  Json effects = Json::array();  ///< that are simulated
  std::string drives;            ///< what they need at both designs, for people
};

/// Simulates both for their trajectory files and for what is reported of them.
Examined examine_designs(RunRecord& record, Optimum& optimum) {
  const auto start = analyze(optimum.problem, first_design(optimum.result.history).x);
  write_trajectory(record.result("trajectory-start.csv"), *start);
  optimum.start_responses = values_of(*start);
  const auto end = analyze(optimum.problem, optimum.result.x);
  write_trajectory(record.result("trajectory-optimum.csv"), *end, optimum.result.response_bands);
  optimum.responses = values_of(*end);
  record.begin_phase("influence");
  optimum.influence = design_influence(optimum.problem, *end);
  record.show_picture([&] {
    return run_picture(
        optimum.problem,
        {{"start", first_design(optimum.result.history).x, start.get()},
         {name_of_end(to_string(optimum.result.status)), optimum.result.x, end.get(),
          optimum.result.response_bands, optimum.influence ? &*optimum.influence : nullptr}});
  });
  record.begin_phase("trajectories");
  optimum.monitors = monitor(end->model, end->trajectory);
  // Of an answer with gradients the doubts are known: they are part of its verdict.
  optimum.warnings = optimum.result.evaluation.has_gradients()
                         ? optimum.result.warnings
                         : texts_of(find_doubts(TrustedRun{optimum.problem, optimum.result.x, *end,
                                                           optimum.monitors}));
  return {effects_document(optimum.problem, end->model, optimum.influences),
          drives_text(optimum.problem, *start, *end)};
}

/// What each effect brings and costs at an optimum with prices.
std::vector<EffectInfluence> influences_at(const Optimum& optimum) {
  if (!has_prices(optimum.result) || !optimum.problem.simulation.checks_resolution) return {};
  constexpr double factor = 2.0;  // of the step: effects change little of the errors by it
  std::vector<EffectInfluence> influences;
  try {
    influences = effect_influences(refined(optimum.problem, {factor, 1.0}), optimum.result.x);
  } catch (const Stopped&) {
    return {};
  }
  for (EffectInfluence& one : influences) one.seconds *= factor;
  return influences;
}

ExitCode exit_code(const Optimum& optimum) {
  if (optimum.result.status == Status::interrupted) return ExitCode::not_verified;
  if (!optimum.has_design()) return ExitCode::simulation_failed;
  return optimum.result.status == Status::verified ? ExitCode::done : ExitCode::not_verified;
}

/// What was simulated as the last evaluation was: others have other errors.
History with_last_setting(History seen) {
  const double step = seen.back().time_step;
  const int elements = seen.back().elements;
  std::erase_if(seen, [&](const EvaluationRecord& record) {
    return record.time_step != step || record.elements != elements;
  });
  return seen;
}

/// The best design so far, by the numbers of the last setting. Nothing is proven of it.
Result interrupted_result(const DesignProblem& problem, const SolveOptions& options,
                          const History& seen) {
  const History last = with_last_setting(seen);
  const EvaluationRecord& best =
      best_record(last.front().has_failed() ? seen : last, options.verdict.violation);
  Result result;
  result.status = Status::interrupted;
  result.message = fmt::format(
      "{} evaluations were made; the best design among them has {} = {} and exceeds no limit by "
      "more than {:.1e} (relative)",
      seen.size(), problem.file().objective->response, problem.objective_text(best.objective),
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

MultiStart solve_visibly(const ProblemInput& input, const SolveOptions& options,
                         RunRecord& run_record, RunStore& store, const Arguments& arguments) {
  const int count = arguments.starts.value_or(input.problem.optimizer.starts);
  auto first = std::make_unique<DesignProblem>(input.problem, arguments.jobs);
  const DesignProblem& problem = *first;
  std::FILE* out = arguments.progress();
  show(out, wrapped(fmt::format("{}: {} {} by {} variables under {} constraints, with {}\n\n",
                                problem.file().name,
                                problem.objective_sign() < 0.0 ? "maximize" : "minimize",
                                problem.file().objective->response, problem.variables().size(),
                                problem.constraints().size(), options.backend)));
  show(out, warnings_text(impossible_corners(problem.file())));
  std::optional<HistoryCsv> history;  // with the first evaluation
  IterationLines lines(out, problem.file());
  History seen;
  const Observer observer = [&](const EvaluationRecord& record) {
    if (!history) history.emplace(run_record.result("history.csv"), problem);
    history->add(record);
    store.add(record);
    lines.see(record);
    if (record.has_failed()) {
      write_failed_design(run_record, arguments, problem.file(), record);
    }
    seen.push_back(record);
  };
  try {
    return solve_from_starts(
        input.problem, starts_of(input.problem, input.design, count), options,
        {arguments.tasks(), &store}, observer,
        [out](const std::string& notice) { show(out, wrapped("  " + notice, "  ") + "\n"); });
  } catch (const Stopped&) {
    if (seen.empty() || seen.front().has_failed()) throw;
    MultiStart solution;
    solution.best.result = interrupted_result(problem, options, seen);
    solution.best.problem = std::move(first);
    return solution;
  }
}

std::string files_text(const RunRecord& record, const Optimum& optimum) {
  return wrapped(
      fmt::format("Written to {}: history.csv, result.json, run_card.json, run.sqlite{}\n",
                  record.folder().string(),
                  optimum.has_design() ? ", trajectory-start.csv, trajectory-optimum.csv" : ""),
      "  ");
}

}  // namespace

Outcome run_optimize(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const SolveOptions options = solve_options(input.problem, arguments);
  Json used = options_document(options, input.problem);
  used["starts"] = arguments.starts.value_or(input.problem.optimizer.starts);
  RunRecord record(arguments, input, used);
  RunStore store(record, arguments, input, std::move(used));
  show_warnings_before(input.problem);
  record.begin_phase("optimize");
  const MultiStart all = solve_visibly(input, options, record, store, arguments);
  const StagedSolution& solution = all.best;
  const ProblemFile& solved = solution.problem->file();
  const Result& result = solution.result;
  Optimum optimum{solved, result, {}, {}, {}, result.warnings, solution.problem->method()};
  // What has been found is told and written first: the rest is made from it at any time.
  Json effects = Json::array();
  const auto result_document = [&] {
    Json document = optimum_document(optimum);
    document["effects"] = effects;
    if (all.runs.size() > 1) document["starts"] = starts_document(solved, all);
    // An interrupted run may have ended no stage; its setting is that of the last design all the same.
    const bool has_stages = !solution.stages.empty();
    if (!has_stages && !(input.problem.accuracy.target > 0.0)) return document;
    if (has_stages) document["stages"] = stages_document(solution.stages);
    document["setting"] = {{"step", solved.simulation.step},
                           {"overrides", overrides_document(input.effective, solved)}};
    return document;
  };
  show(arguments.progress(),
       optimum_report(optimum) + starts_text(solved, all) + stages_text(solution.stages));
  record.write("result.json", result_document());
  if (optimum.has_design()) {
    record.begin_phase("effects");
    optimum.influences = influences_at(optimum);
    record.begin_phase("trajectories");
    Examined examined = examine_designs(record, optimum);
    effects = std::move(examined.effects);
    const auto price = [&](const Eigen::VectorXd& changes) {
      return optimum_change(*solution.problem, result, changes);
    };
    show(arguments.progress(),
         examined.drives + influences_text(solved, optimum.responses, optimum.influences, price));
  }
  Outcome outcome{exit_code(optimum), result_document(),
                  failed_design_text(record, arguments, input.problem, result.history) +
                      resume_text(arguments, record.folder(), result.status) + store.text() +
                      files_text(record, optimum)};
  store.finish(outcome);
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
