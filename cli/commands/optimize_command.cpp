#include <limits>

#include "cli/commands/commands.hpp"
#include "cli/files/command_text.hpp"
#include "cli/reports/case_report.hpp"
#include "cli/reports/effects_report.hpp"
#include "cli/reports/iteration_lines.hpp"
#include "cli/reports/optimum_document.hpp"
#include "cli/reports/scene_report.hpp"
#include "cli/reports/setting_report.hpp"
#include "cli/reports/starts_report.hpp"
#include "core/response/value_over_cases.hpp"
#include "core/scene/body_rules.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/override.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/refined_runs.hpp"
#include "optimization/design/number_judgement.hpp"
#include "picture/companions.hpp"

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
  ShownDesign start, end;
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
  const Eigen::VectorXd &start = first_design(optimum.result.history).x, &end = optimum.result.x;
  for (const ProblemFile* problem : simulated_problems(optimum.problem)) {
    CaseDesigns one{problem, {"start", start, analyze(*problem, start, values_only)}, {}};
    write_trajectory(record.result(name_of_case_file("trajectory-start", *problem)),
                     *one.start.analysis);
    one.end = {name_of_end(to_string(optimum.result.status)), end, analyze(*problem, end),
               bands_of_case(optimum.problem, optimum.result, all.size())};
    write_trajectory(record.result(name_of_case_file("trajectory-optimum", *problem)),
                     *one.end.analysis, one.end.bands);
    all.push_back(std::move(one));
  }
  return all;
}

/// Of all cases, in the order of the joined problem.
Eigen::VectorXd joined_values(const ProblemFile& joined, const std::vector<CaseDesigns>& designs,
                              ShownDesign CaseDesigns::*which) {
  std::vector<Eigen::VectorXd> values;
  for (const CaseDesigns& one : designs) values.push_back(values_of(*(one.*which).analysis));
  if (!joined.has_cases()) return values.front();
  const ValueInCase value_of = [&](std::size_t response) {
    const auto [load_case, index] = joined.case_responses[response];
    return values[load_case](static_cast<Eigen::Index>(index));
  };
  Eigen::VectorXd all(std::ssize(joined.responses));
  for (std::size_t i = 0; i < joined.responses.size(); ++i) {
    try {
      all(i) = value_over_cases(joined, i, (designs.front().*which).x, value_of);
    } catch (const SimulationError&) {  // of one that is only looked at
      all(i) = std::numeric_limits<double>::quiet_NaN();
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

/// Of the responses of all cases, NaN of those that have none; empty if those of a case are not known.
Eigen::MatrixXd joined_gradients(const Optimum& optimum, const std::vector<CaseDesigns>& designs) {
  const ProblemFile& joined = optimum.problem;
  for (const CaseDesigns& one : designs) {
    if (!one.end.influence) return {};
  }
  if (!joined.has_cases()) return designs.front().end.influence->gradients;
  const ValueInCase value_of = [&](std::size_t part) { return optimum.responses(part); };
  Eigen::MatrixXd all =
      Eigen::MatrixXd::Constant(std::ssize(joined.responses), std::ssize(joined.variables),
                                std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < joined.responses.size(); ++i) {
    try {
      const LinearizedResponse linear =
          linearized_over_cases(joined, i, optimum.result.x, value_of);
      Eigen::RowVectorXd gradient = linear.design;
      for (const WeightedResponse& part : linear.parts) {
        const auto [load_case, index] = joined.case_responses[part.response];
        gradient += part.weight * designs[load_case].end.influence->gradients.row(index);
      }
      all.row(i) = gradient;
    } catch (const SimulationError&) {
    }
  }
  return all;
}

const char* word_of(DriveNumber number) {
  if (number == DriveNumber::torque) return "torque";
  return number == DriveNumber::force ? "force" : "power";
}

/// "Drive bearing: torque 464.28 → 199.13 N m (−57.1 %), power 92856 → 39826 W (−57.1 %)", a line
/// for each drive: the largest magnitudes over time of two designs. Empty without drives.
std::string drives_text(const ProblemFile& problem, const Analysis& start,
                        const Analysis& optimum) {
  const Companions before = find_drive_efforts(problem, start),
                   after = find_drive_efforts(problem, optimum);
  std::string text, line;
  for (std::size_t i = 0; i < after.all.size(); ++i) {
    const ResponseSettings& settings = after.all[i].settings;
    const ShownUnit unit = unit_of(settings);
    const double from = before.all[i].value, to = after.all[i].value;
    const auto& drive = *settings.as<DriveResponse>();
    const bool is_power = drive.kind == DriveNumber::power;
    line += fmt::format("{} {} → {} {}{}", word_of(drive.kind), significant(unit.shown(from)),
                        significant(unit.shown(to)), unit.name,
                        from == 0.0 ? "" : fmt::format(" ({})", signed_percent(to / from - 1.0)));
    if (!is_power) {
      line += ", ";
      continue;
    }
    text += wrapped(fmt::format("Drive {}: {}\n", drive.joint, line), "  ");
    line.clear();
  }
  return text;
}

/// What each case says of the design; several are told apart by their names. The findings are known:
/// they are part of the verdict.
Examined examine_cases(Optimum& optimum, std::vector<CaseDesigns>& designs) {
  Examined examined;
  for (CaseDesigns& one : designs) {
    Analysis& end = *one.end.analysis;
    one.end.influence = design_influence(*one.problem, end);
    const Monitors monitors = monitor(end.model, end.trajectory);
    if (&one == &designs.front()) optimum.monitors = monitors;
    add_monitors(optimum.monitors, monitors);
    const std::string& load_case = one.problem->load_case;
    for (Json& effect : effects_document(*one.problem, end.model, optimum.influences)) {
      if (!load_case.empty()) effect["case"] = load_case;
      examined.effects.push_back(std::move(effect));
    }
    const std::string drives = drives_text(*one.problem, *one.start.analysis, end);
    if (!drives.empty() && !load_case.empty()) {
      examined.drives += fmt::format("Case \"{}\":\n", load_case);
    }
    examined.drives += drives;
  }
  return examined;
}

/// Of all cases; that which decides is shown first.
Json picture_of(const Optimum& optimum, const std::vector<CaseDesigns>& designs) {
  std::vector<Json> cases;
  for (const CaseDesigns& one : designs) {
    cases.push_back(run_picture(*one.problem, {one.start, one.end}, designs.size()));
  }
  if (!optimum.problem.has_cases()) return cases.front();
  return picture_of_cases(optimum.problem, std::move(cases),
                          deciding_case(optimum.problem, optimum.result));
}

/// Simulates both for their trajectory files and for what is reported of them.
Examined examine_designs(RunRecord& record, Optimum& optimum) {
  std::vector<CaseDesigns> designs = simulate_designs(record, optimum);
  optimum.start_responses = joined_values(optimum.problem, designs, &CaseDesigns::start);
  optimum.responses = joined_values(optimum.problem, designs, &CaseDesigns::end);
  record.begin_phase("influence");
  Examined examined = examine_cases(optimum, designs);
  optimum.gradients = joined_gradients(optimum, designs);
  record.show_picture([&] { return picture_of(optimum, designs); });
  record.begin_phase("trajectories");
  return examined;
}

/// What each effect brings and costs at an optimum with prices.
std::vector<EffectInfluence> influences_at(const Optimum& optimum, InfluenceTimes times) {
  if (optimum.problem.has_cases()) return {};  // of one case: `pleuel simulate --effects`
  if (!has_prices(optimum.result) || !optimum.problem.simulation.checks_resolution) return {};
  constexpr double factor = 2.0;  // of the step: effects change little of the errors by it
  try {
    return effect_influences(refined(optimum.problem, {factor, 1.0}), optimum.result.x, times);
  } catch (const Stopped&) {
    return {};
  }
}

/// Simulates both designs in every load case, for their trajectory files, the picture of the page, and
/// what else is told of the optimum. An interrupt ends that, but not what was found.
Examined examine_optimum(RunRecord& record, Optimum& optimum, InfluenceTimes times) {
  try {
    record.begin_phase("effects");
    optimum.influences = influences_at(optimum, times);
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

// What is left of a design that could not be evaluated, so that it can be looked at.

constexpr const char* dossier_name = "failed_design.json";

/// For the folder in which the optimization was called. Where gradients were asked for, they are
/// what may have failed.
std::string command_again(const RunRecord& record, const Arguments& arguments,
                          const ProblemFile& problem, const EvaluationRecord& failed) {
  const bool takes_gradients =
      failed.request != Request::values ||
      std::ranges::any_of(problem.constraints, [](const ConstraintSettings& constraint) {
        return constraint.deviations > 0.0;
      });
  std::string text =
      command_on(takes_gradients ? "gradient" : "simulate", arguments, arguments.file);
  // By its pointer: the value of a variable that is called by its name would take the place of that in
  // the file.
  for (const std::string& assignment : arguments.overrides) {
    text += " --set " +
            shell_word(assigned_pointer(assignment) + assignment.substr(assignment.find('=')));
  }
  if (arguments.allows_programs) text += " --allow-programs";
  if (takes_gradients) {
    for (const std::string& method : arguments.methods) text += " --method " + method;
  }
  return text + " --design " + shell_word((record.folder() / dossier_name).string());
}

/// Writes failed_design.json: design, failure, and the command that evaluates that design again.
void write_failed_design(RunRecord& record, const Arguments& arguments, const ProblemFile& problem,
                         const EvaluationRecord& failed) {
  record.write(dossier_name, {{"evaluation", failed.evaluation},
                              {"request", request_name(failed.request)},
                              {"failure", failed.failure},
                              {"command", command_again(record, arguments, problem, failed)},
                              {"variables", variables_document(problem, failed.x)}});
}

/// Says where the last failed design is and how to run it; empty if none failed.
std::string failed_design_text(const RunRecord& record, const Arguments& arguments,
                               const ProblemFile& problem, const History& history) {
  const auto last =
      std::find_if(history.rbegin(), history.rend(), std::mem_fn(&EvaluationRecord::has_failed));
  if (last == history.rend()) return "";
  const std::string sentence = fmt::format(
      "{} of {} evaluations failed; the last such design is in {}, and this runs it again:\n",
      count_failures(history), history.size(), (record.folder() / dossier_name).string());
  return wrapped(sentence, "  ") +
         fmt::format("  {}\n", command_again(record, arguments, problem, *last));
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
  Optimum optimum = optimum_of(answer);
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
    add_search(answer, document);
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
