#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

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
#include "cli/reports/case_report.hpp"
#include "cli/reports/drives_report.hpp"
#include "cli/reports/effects_report.hpp"
#include "cli/reports/influence_report.hpp"
#include "cli/reports/iteration_lines.hpp"
#include "cli/reports/monitors_report.hpp"
#include "cli/reports/optimum_document.hpp"
#include "cli/reports/optimum_report.hpp"
#include "cli/reports/setting_report.hpp"
#include "cli/reports/sizes_report.hpp"
#include "cli/reports/starts_report.hpp"
#include "cli/reports/warnings.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/response/value_over_cases.hpp"
#include "core/scene/body_rules.hpp"
#include "core/scene/load_cases.hpp"
#include "core/trust/case_doubts.hpp"
#include "core/trust/doubts.hpp"
#include "core/trust/far_limits.hpp"
#include "core/trust/nested_runs.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/multi_start.hpp"
#include "optimization/design/optimum_error.hpp"
#include "optimization/design/size_choice.hpp"
#include "optimization/design/staged_solve.hpp"
#include "optimization/prices.hpp"

namespace pleuel {

namespace {

/// What is told of the first and the last design.
struct Examined {
  Json effects = Json::array();  ///< that are simulated
  std::string drives;            ///< what they need at both designs, for people
  bool is_whole = true;          ///< no interrupt has ended it
};

/// Both designs as one load case simulates them.
struct CaseDesigns {
  const ProblemFile* problem;
  std::unique_ptr<Analysis> start, end;
  std::vector<Eigen::VectorXd> bands;  ///< of histories at the end
  std::optional<DesignInfluence> influence;
};

std::vector<Eigen::VectorXd> bands_of_case(const ProblemFile& joined, const Result& result,
                                           std::size_t load_case) {
  if (!joined.has_cases() || result.response_bands.empty()) return result.response_bands;
  std::vector<Eigen::VectorXd> bands(joined.cases[load_case].responses.size());
  for (std::size_t i = 0; i < bands.size(); ++i) {
    bands[i] = result.response_bands[joined_response(joined, {load_case, i})];
  }
  return bands;
}

std::vector<CaseDesigns> simulate_designs(RunRecord& record, const Optimum& optimum) {
  std::vector<CaseDesigns> all;
  for (const ProblemFile* problem : simulated_problems(optimum.problem)) {
    CaseDesigns one{problem, analyze(*problem, first_design(optimum.result.history).x), {}, {}, {}};
    one.bands = bands_of_case(optimum.problem, optimum.result, all.size());
    write_trajectory(record.result(name_of_case_file("trajectory-start", *problem)), *one.start);
    one.end = analyze(*problem, optimum.result.x);
    write_trajectory(record.result(name_of_case_file("trajectory-optimum", *problem)), *one.end,
                     one.bands);
    all.push_back(std::move(one));
  }
  return all;
}

/// Of all cases, in the order of the joined problem.
Eigen::VectorXd joined_values(const ProblemFile& joined, const std::vector<CaseDesigns>& designs,
                              const Eigen::VectorXd& x,
                              const std::function<Eigen::VectorXd(const CaseDesigns&)>& values_in) {
  std::vector<Eigen::VectorXd> values;
  for (const CaseDesigns& one : designs) values.push_back(values_in(one));
  if (!joined.has_cases()) return values.front();
  const ValueInCase value_of = [&](std::size_t response) {
    const auto [load_case, index] = joined.case_responses[response];
    return values[load_case](static_cast<Eigen::Index>(index));
  };
  Eigen::VectorXd all(std::ssize(joined.responses));
  for (std::size_t i = 0; i < joined.responses.size(); ++i) {
    try {
      all(static_cast<Eigen::Index>(i)) = value_over_cases(joined, i, x, value_of);
    } catch (const SimulationError&) {  // of one that is only looked at
      all(static_cast<Eigen::Index>(i)) = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return all;
}

/// The largest of all cases.
void add_monitors(Monitors& all, const Monitors& one) {
  all.position_drift = std::max(all.position_drift, one.position_drift);
  all.velocity_drift = std::max(all.velocity_drift, one.velocity_drift);
  all.energy_error = std::max(all.energy_error, one.energy_error);
  all.elastic_energy_error = std::max(all.elastic_energy_error, one.elastic_energy_error);
  if (one.elastic_rotation <= all.elastic_rotation) return;
  all.elastic_rotation = one.elastic_rotation;
  all.most_bent = one.most_bent;
}

/// By those of single cases. @returns NaN where there is none
template <class GradientInCase>
Eigen::VectorXd gradient_over_cases(const Optimum& optimum, std::size_t response,
                                    const GradientInCase& gradient_in_case) {
  const ValueInCase value_of = [&](std::size_t part) {
    return optimum.responses(static_cast<Eigen::Index>(part));
  };
  try {
    const LinearizedResponse linear =
        linearized_over_cases(optimum.problem, response, optimum.result.x, value_of);
    Eigen::VectorXd gradient = linear.design;
    for (const WeightedResponse& part : linear.parts) {
      gradient += part.weight * gradient_in_case(part.response);
    }
    return gradient;
  } catch (const SimulationError&) {
    return Eigen::VectorXd::Constant(optimum.result.x.size(),
                                     std::numeric_limits<double>::quiet_NaN());
  }
}

/// Gradients of the responses of all cases; none if those of a case are not known.
std::optional<DesignInfluence> joined_influence(const Optimum& optimum,
                                                const std::vector<CaseDesigns>& designs) {
  const ProblemFile& joined = optimum.problem;
  if (!joined.has_cases()) return designs.front().influence;
  for (const CaseDesigns& one : designs) {
    if (!one.influence) return std::nullopt;
  }
  DesignInfluence all;
  all.gradients.resize(std::ssize(joined.responses), std::ssize(joined.variables));
  const auto gradient_in_case = [&](std::size_t response) -> Eigen::VectorXd {
    const auto [load_case, index] = joined.case_responses[response];
    return designs[load_case].influence->gradients.row(static_cast<Eigen::Index>(index));
  };
  for (std::size_t i = 0; i < joined.responses.size(); ++i) {
    all.gradients.row(static_cast<Eigen::Index>(i)) =
        is_over_cases(joined, i) ? gradient_over_cases(optimum, i, gradient_in_case)
                                 : gradient_in_case(i);
  }
  return all;
}

/// What each case says of the design; several are told apart by their names.
Examined examine_cases(Optimum& optimum, std::vector<CaseDesigns>& designs) {
  Examined examined;
  std::vector<std::vector<Doubt>> doubts;
  for (CaseDesigns& one : designs) {
    one.influence = design_influence(*one.problem, *one.end);
    const Monitors monitors = monitor(one.end->model, one.end->trajectory);
    if (&one == &designs.front()) optimum.monitors = monitors;
    add_monitors(optimum.monitors, monitors);
    // Of an answer with gradients the doubts are known: they are part of its verdict.
    if (!optimum.result.evaluation.has_gradients()) {
      doubts.push_back(find_doubts(TrustedRun{*one.problem, optimum.result.x, *one.end, monitors}));
    }
    const std::string& load_case = one.problem->load_case;
    for (Json& effect : effects_document(*one.problem, one.end->model, optimum.influences)) {
      if (!load_case.empty()) effect["case"] = load_case;
      examined.effects.push_back(std::move(effect));
    }
    const std::string drives = drives_text(*one.problem, *one.start, *one.end);
    if (!drives.empty() && !load_case.empty()) {
      examined.drives += fmt::format("Case \"{}\":\n", load_case);
    }
    examined.drives += drives;
  }
  optimum.warnings = optimum.result.evaluation.has_gradients()
                         ? optimum.result.warnings
                         : texts_of(joined_doubts(optimum.problem, doubts));
  return examined;
}

/// Of all cases; that which decides is shown first.
Json picture_of(const Optimum& optimum, const std::vector<CaseDesigns>& designs) {
  const Eigen::VectorXd& start = first_design(optimum.result.history).x;
  const std::string end = name_of_end(to_string(optimum.result.status));
  std::vector<Json> cases;
  for (const CaseDesigns& one : designs) {
    cases.push_back(run_picture(*one.problem,
                                {{"start", start, one.start.get()},
                                 {end, optimum.result.x, one.end.get(), one.bands,
                                  one.influence ? &*one.influence : nullptr}},
                                designs.size()));
  }
  if (!optimum.problem.has_cases()) return cases.front();
  return picture_of_cases(optimum.problem, std::move(cases),
                          deciding_case(optimum.problem, optimum.result));
}

/// Simulates both for their trajectory files and for what is reported of them.
Examined examine_designs(RunRecord& record, Optimum& optimum) {
  std::vector<CaseDesigns> designs = simulate_designs(record, optimum);
  const EvaluationRecord& first = first_design(optimum.result.history);
  optimum.start_responses =
      joined_values(optimum.problem, designs, first.x,
                    [](const CaseDesigns& one) { return values_of(*one.start); });
  optimum.responses = joined_values(optimum.problem, designs, optimum.result.x,
                                    [](const CaseDesigns& one) { return values_of(*one.end); });
  record.begin_phase("influence");
  Examined examined = examine_cases(optimum, designs);
  optimum.influence = joined_influence(optimum, designs);
  record.show_picture([&] { return picture_of(optimum, designs); });
  record.begin_phase("trajectories");
  return examined;
}

/// What each effect brings and costs at an optimum with prices.
std::vector<EffectInfluence> influences_at(const Optimum& optimum) {
  if (optimum.problem.has_cases()) return {};  // of one case: `pleuel simulate --effects`
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

/// Trajectories and what is reported of them. An interrupt ends that, but not what was found.
Examined examine_optimum(RunRecord& record, Optimum& optimum) {
  try {
    record.begin_phase("effects");
    optimum.influences = influences_at(optimum);
    record.begin_phase("trajectories");
    return examine_designs(record, optimum);
  } catch (const Stopped&) {
    Examined cut;
    cut.is_whole = false;
    return cut;
  }
}

const char* const cut_message =
    "interrupted after the search had ended: its result stands, but trajectories, influences and "
    "effects were not all computed";

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
  result.message = fmt::format(
      "{} evaluations were made; the best design among them has {} = {} and exceeds no limit by "
      "more than {:.1e} (relative)",
      seen.size(), problem.file().objective->response, problem.objective_text(best.objective),
      best.max_violation);
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

/// A missing unit is told when the first design is known, not after a search for nothing.
std::vector<std::string> far_limits_of(const ProblemFile& problem, const EvaluationRecord& record) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const double value = record.constraints(static_cast<Eigen::Index>(i));
    if (const auto text = far_limit_text(problem, problem.constraints[i], value)) {
      warnings.push_back("at the start " + *text);
    }
  }
  return warnings;
}

struct Solved {
  MultiStart all;
  std::optional<SizeChoiceReport> sizes;  ///< where some are chosen from lists
};

Solved solve_visibly(const ProblemInput& input, const SolveOptions& options, RunRecord& run_record,
                     RunStore& store, const Arguments& arguments) {
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
    seen.push_back(record);
  };
  const Notice notice = [out](const std::string& text) {
    show(out, wrapped("  " + text, "  ") + "\n");
  };
  const Execution execution = {arguments.tasks(), &store};
  try {
    Solved solved;
    solved.all = solve_from_starts(input.problem, starts_of(input.problem, input.design, count),
                                   options, execution, observer, notice);
    if (has_choices(input.problem)) {
      solved.sizes = choose_sizes(solved.all.best, options, execution, observer, notice);
    }
    return solved;
  } catch (const Stopped&) {
    if (seen.empty() || seen.front().has_failed()) throw;
    Solved solved;
    solved.all.best.result = interrupted_result(problem, options, seen);
    solved.all.best.problem = std::move(first);
    return solved;
  }
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

std::string files_text(const RunRecord& record, const Optimum& optimum) {
  return wrapped(
      fmt::format("Written to {}: history.csv, result.json, run_card.json, run.sqlite{}\n",
                  record.folder().string(),
                  !optimum.has_design() ? ""
                  : optimum.problem.has_cases()
                      ? ", trajectory-start-*.csv, trajectory-optimum-*.csv"
                      : ", trajectory-start.csv, trajectory-optimum.csv"),
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
  const Solved answer = solve_visibly(input, options, record, store, arguments);
  const MultiStart& all = answer.all;
  const StagedSolution& solution = all.best;
  const ProblemFile& solved = solution.problem->file();
  const Result& result = solution.result;
  Optimum optimum{solved, result, {}, {}, {}, result.warnings, solution.problem->method()};
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
  show(arguments.progress(), optimum_report(optimum) +
                                 (answer.sizes ? sizes_text(solved, *answer.sizes, result) : "") +
                                 starts_text(solved, all) + stages_text(solution.stages));
  record.write("result.json", result_document());
  Examined examined;
  if (optimum.has_design()) examined = examine_optimum(record, optimum);
  is_whole = examined.is_whole;
  if (optimum.has_design() && is_whole) {
    effects = std::move(examined.effects);
    const MeasuredEffects measured = {solved, optimum.responses, optimum.influences,
                                      [&](const Eigen::VectorXd& changes) {
                                        return optimum_change(*solution.problem, result, changes);
                                      }};
    mark_effects(measured, effects);
    show(arguments.progress(),
         examined.drives + influences_text(measured, arguments.wants_effects) + "\n");
  }
  const std::string cut = is_whole ? "" : wrapped(fmt::format("{}\n", cut_message));
  Outcome outcome{
      is_whole ? exit_code(optimum) : ExitCode::not_verified, result_document(),
      failed_design_text(record, arguments, input.problem, result.history) + cut +
          resume_text(arguments, record.folder(), is_whole ? result.status : Status::interrupted) +
          store.text() + (is_whole ? files_text(record, optimum) : "")};
  store.finish(outcome);
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
