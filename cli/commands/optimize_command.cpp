#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/commands/examined_optimum.hpp"
#include "cli/files/failed_design.hpp"
#include "cli/input/run_setting.hpp"
#include "cli/reports/effects_report.hpp"
#include "cli/reports/iteration_lines.hpp"
#include "cli/reports/optimum_report.hpp"
#include "cli/reports/setting_report.hpp"
#include "cli/reports/starts_report.hpp"
#include "core/scene/body_rules.hpp"
#include "core/scene/load_cases.hpp"
#include "core/trust/lint.hpp"
#include "optimization/design/multi_start.hpp"
#include "optimization/design/number_judgement.hpp"
#include "optimization/design/staged_solve.hpp"

namespace pleuel {

namespace {

const char* const cut_message =
    "interrupted after the search had ended: its result stands, but trajectories, influences and "
    "effects were not all computed";

ExitCode exit_code(const Optimum& optimum) {
  if (optimum.result.status == Status::interrupted) return ExitCode::not_verified;
  if (!optimum.has_design()) return ExitCode::simulation_failed;
  return optimum.result.status == Status::verified ? ExitCode::done : ExitCode::not_verified;
}

/// A missing unit is told when the first design is known, not after a search for nothing.
std::vector<std::string> far_limits_of(const ProblemFile& problem, const EvaluationRecord& record) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const double value = record.constraints(i);
    if (const auto text = far_limit_text(problem, problem.constraints[i], value)) {
      warnings.push_back("at the start " + *text);
    }
  }
  return warnings;
}

WholeSearch solve_visibly(const ProblemInput& input, const SolveOptions& options,
                          RunRecord& run_record, RunStore& store, const Arguments& arguments) {
  const int count = arguments.starts.value_or(input.problem.optimizer.starts);
  const DesignProblem problem(input.problem, arguments.jobs);
  std::FILE* out = arguments.progress();
  show(out, wrapped(fmt::format(
                "{}: {} {} by {} variable{} under {} constraint{}, with {}\n\n",
                problem.file().name, problem.objective_sign() < 0.0 ? "maximize" : "minimize",
                problem.file().objective->response, problem.variables().size(),
                problem.variables().size() == 1 ? "" : "s", problem.constraints().size(),
                problem.constraints().size() == 1 ? "" : "s", options.backend)));
  show(out, warnings_text(impossible_corners(problem.file())));
  std::optional<HistoryCsv> history;  // with the first evaluation
  IterationLines lines(out, problem.file());
  bool is_first = true;
  const Observer observer = [&](const EvaluationRecord& record) {
    if (!history) history.emplace(run_record.result("history.csv"), problem);
    history->add(record);
    store.add(record);
    if (!record.has_failed() && std::exchange(is_first, false)) {
      show(stderr, warnings_text(far_limits_of(problem.file(), record)));
    }
    lines.see(record);
    if (record.has_failed()) {
      write_failed_design(run_record, arguments, problem.file(), record);
    }
  };
  const Notice notice = [out](const std::string& text) {
    show(out, wrapped("  " + text, "  ") + "\n");
  };
  return search_design(input.problem, starts_of(input.problem, input.design, count),
                       {options, {arguments.tasks(), &store}, observer, notice});
}

/// Steps and elements of the last stage; of several load cases each has its own.
Json setting_of(const Json& effective, const ProblemFile& solved) {
  Json all = Json::object();
  for (const ProblemFile* one : simulated_problems(solved)) {
    const Json setting = {{"step", one->simulation.step},
                          {"overrides", overrides_document(effective, *one)}};
    if (!solved.has_cases()) return setting;
    all["cases"][one->load_case] = setting;
  }
  return all;
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
  const WholeSearch answer = solve_visibly(input, options, record, store, arguments);
  const MultiStart& all = answer.all;
  const StagedSolution& solution = all.best;
  const ProblemFile& solved = solution.problem->file();
  const Result& result = solution.result;
  Optimum optimum{
      solved, result, {}, {}, {}, result.warnings, result.consequences, solution.problem->method()};
  if (answer.sizes) optimum.sizes = &*answer.sizes;
  // What has been found is told and written first: the rest is made from it at any time.
  Json effects = Json::array();
  bool is_whole = true;
  const auto result_document = [&] {
    Json document = optimum_document(optimum);
    document["effects"] = effects;
    if (!is_whole) {
      document["interrupted"] = cut_message;
      document.erase("monitors");
    }
    if (all.runs.size() > 1) document["starts"] = starts_document(solved, all);
    if (answer.sizes) document["choices"] = sizes_document(solved, *answer.sizes, result);
    if (solution.stages.empty()) return document;  // interrupted
    document["stages"] = stages_document(solution.stages);
    document["setting"] = setting_of(input.effective, solved);
    return document;
  };
  if (arguments.wants_all_warnings) optimum.consequences = 0;
  const Json document = result_document();
  show(arguments.progress(), optimum_report(optimum, document, arguments.is_verbose) +
                                 (answer.sizes ? sizes_text(solved, *answer.sizes, result) : "") +
                                 starts_text(solved, all) + stages_text(solution.stages));
  record.write_result(document);
  Examined examined;
  solution.problem->forget_analyses();
  if (optimum.has_design()) {
    examined = examine_optimum(
        record, optimum, arguments.wants_effects ? InfluenceTimes::measured : InfluenceTimes::none);
  }
  is_whole = examined.is_whole;
  if (optimum.has_design() && is_whole) {
    effects = std::move(examined.effects);
    const MeasuredEffects measured = {solved, optimum.responses, optimum.influences,
                                      [&](const Eigen::VectorXd& changes) {
                                        return optimum_change(*solution.problem, result, changes);
                                      }};
    mark_effects(measured, effects);
    if (arguments.is_verbose) show(arguments.progress(), examined.drives);
    if (arguments.is_verbose || arguments.wants_effects) {
      show(arguments.progress(), influences_text(measured, arguments.wants_effects) + "\n");
    }
  }
  const std::string cut = is_whole ? "" : wrapped(fmt::format("{}\n", cut_message));
  Outcome outcome{is_whole ? exit_code(optimum) : ExitCode::not_verified, result_document(),
                  failed_design_text(record, arguments, input.problem, result.history) + cut};
  store.finish(outcome);
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
