#include "cli/commands/commands.hpp"
#include "cli/reports/derivative_report.hpp"
#include "cli/reports/effects_report.hpp"
#include "cli/reports/scene_report.hpp"
#include "core/scene/body_rules.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/initial_sensitivity.hpp"

namespace pleuel {

namespace {

struct Examination {
  std::shared_ptr<Analysis> analysis;
  DegreesOfFreedom freedoms;
  double simulation_seconds = 0.0, gradient_seconds = 0.0;
  Ties ties;
  std::vector<EffectInfluence> influences;
  std::shared_ptr<const DesignInfluence> influence;  ///< likewise
  DerivativeChecks derivatives;                      ///< empty without variables
  bool is_interrupted = false;                       ///< before the derivatives were verified
  std::vector<std::string> warnings;
  int consequences = 0;  ///< so many warnings are not told, since they follow from others
};

Examination examine(const ProblemFile& problem, const Eigen::VectorXd& x,
                    const Arguments& arguments) {
  Examination findings;
  const auto warn = [&](const std::vector<std::string>& sentences) {
    findings.warnings.insert(findings.warnings.end(), sentences.begin(), sentences.end());
  };
  warn(impossible_corners(problem));
  warn(unknown_derivatives(problem, Design<double>(x.begin(), x.end())));
  const Stopwatch simulation;
  findings.analysis = analyze(problem, x);
  findings.simulation_seconds = simulation.seconds();
  const State initial = findings.analysis->trajectory.state_at(0);
  const Model& model = findings.analysis->model;
  findings.freedoms = rigid_degrees_of_freedom(model.mechanism, initial);
  findings.freedoms.blocked = blocked_drives(model.mechanism, initial, drive_rows(model));
  findings.ties = make_ties(*findings.analysis, find_kinks(*findings.analysis, problem.variables));
  const std::vector<Finding> of_checks = check_run(problem, x, *findings.analysis);
  warn(texts_of(of_checks));
  if (!arguments.wants_all_warnings) findings.consequences = count_consequences(of_checks);
  ProgressLine progress(arguments, "measuring effects");
  try {
    findings.influences = effect_influences(
        problem, x, arguments.wants_effects ? InfluenceTimes::measured : InfluenceTimes::none);
    if (problem.variables.empty() || problem.responses.empty()) return findings;
    const Stopwatch gradient;
    findings.influence =
        std::make_shared<DesignInfluence>(DesignInfluence{direct_gradients(*findings.analysis)});
    findings.gradient_seconds = gradient.seconds();
    const auto see_differences = [&](int simulations) {
      const std::string line =
          fmt::format("verifying derivatives by {} simulations for differences …", simulations);
      if (!progress.is_shown()) progress.print(line);
      progress.expect(line,
                      simulations * findings.simulation_seconds / std::max(1, arguments.jobs));
    };
    findings.derivatives =
        check_derivatives(problem, x, *findings.analysis, {arguments.jobs, see_differences});
  } catch (const Stopped&) {
    findings.is_interrupted = true;
  }
  const std::vector<std::string> noise =
      noise_warnings(problem, *findings.analysis, findings.derivatives.responses);
  findings.warnings.insert(findings.warnings.end() - findings.consequences, noise.begin(),
                           noise.end());
  return findings;
}

Json responses_with_verdicts(const ProblemFile& problem, const Examination& findings) {
  Json document = responses_document(problem, *findings.analysis);
  for (std::size_t i = 0; i < findings.derivatives.responses.size(); ++i) {
    document[findings.analysis->responses[i].name]["derivatives"] = derivative_document(
        problem, findings.derivatives.directions, findings.derivatives.responses[i]);
  }
  for (std::size_t i = 0; i < findings.ties.size(); ++i) {
    if (!findings.ties[i]) continue;
    const Response& response = findings.analysis->responses[i];
    document[response.name]["tie"] = tie_document(*findings.ties[i], response);
  }
  return document;
}

Json check_document(const ProblemFile& problem, const Examination& findings) {
  const Analysis& analysis = *findings.analysis;
  Json document = {{"status", study_status(!findings.is_interrupted)},
                   {"name", problem.name},
                   {"bodies", bodies_document(analysis.model)},
                   {"coordinates", analysis.model.mechanism.system->coordinates()},
                   {"multipliers", analysis.model.mechanism.system->multipliers()},
                   {"rigid_motion", freedoms_document(findings.freedoms, analysis.model)},
                   {"steps", analysis.trajectory.steps()},
                   {"effects", effects_document(problem, analysis.model, findings.influences)},
                   {"variables", variables_document(problem)},
                   {"responses", responses_with_verdicts(problem, findings)},
                   {"warnings", findings.warnings},
                   {"seconds", {{"simulate", findings.simulation_seconds}}}};
  mark_effects({problem, values_of(analysis), findings.influences}, document["effects"]);
  if (!findings.derivatives.directions.empty()) {
    document["directions"] = directions_document(problem, findings.derivatives.directions);
  }
  if (!findings.derivatives.responses.empty())
    document["seconds"]["direct"] = findings.gradient_seconds;
  return document;
}

std::string time_text(const ProblemFile& problem, const Examination& findings) {
  std::string text = "\nTime: one simulation " + duration(findings.simulation_seconds);
  if (findings.derivatives.responses.empty()) return text + "\n";
  text += ", its gradients " + duration(findings.gradient_seconds) + " more";
  if (problem.objective) {
    const double iteration = findings.simulation_seconds + findings.gradient_seconds;
    text += fmt::format("; an optimization of 20 to 50 iterations takes about {} to {}",
                        duration(20 * iteration), duration(50 * iteration));
  }
  return wrapped(text, "  ") + "\n";
}

std::string make_text(const ProblemFile& problem, const Examination& findings, bool wants_effects) {
  const Analysis& analysis = *findings.analysis;
  std::string text =
      findings.is_interrupted ? "INTERRUPTED before the derivatives were verified\n\n" : "";
  text += fmt::format("{}: a valid problem\n{}\n\n{}\n{}", problem.name, size_text(analysis),
                      bodies_text(analysis.model),
                      freedoms_text(findings.freedoms, analysis.model) + assembly_text(analysis));
  const bool shows_all = wants_effects || findings.influences.empty();
  text += shows_all ? effects_text(analysis.model) : left_out_text(analysis.model);
  if (!findings.influences.empty()) {
    text += influences_text({problem, values_of(analysis), findings.influences}, wants_effects);
  }
  if (!problem.variables.empty()) text += "\n" + variables_text(problem);
  text += "\n" + (findings.derivatives.responses.empty()
                      ? responses_text(problem, analysis)
                      : derivatives_text(problem, analysis, findings.derivatives));
  text += ties_text(findings.ties, analysis);
  if (!findings.warnings.empty())
    text += "\n" + warnings_text(findings.warnings, findings.consequences);
  return text + time_text(problem, findings);
}

}  // namespace

Outcome run_check(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const ProblemFile& problem = input.problem;
  if (problem.objective) solve_options(problem, arguments);  // what `optimize` would refuse
  show_warnings_before(problem);
  std::optional<RunRecord> record;  // before the work: the folder may not be free
  if (arguments.output) record.emplace(arguments, input, Json::object());
  const Examination findings = examine(problem, input.design, arguments);
  Outcome outcome{findings.is_interrupted ? ExitCode::not_verified : ExitCode::done,
                  check_document(problem, findings),
                  make_text(problem, findings, arguments.wants_effects)};
  if (!record) return outcome;
  record->finish(outcome, [&] {
    return run_picture(
        problem, {{input.design_name, input.design, findings.analysis, {}, findings.influence}});
  });
  return outcome;
}

}  // namespace pleuel
