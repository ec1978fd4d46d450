#include <fmt/format.h>

#include "cli/analysis_report.hpp"
#include "cli/commands.hpp"
#include "cli/number_text.hpp"
#include "cli/problem_input.hpp"
#include "cli/scene_report.hpp"
#include "cli/shown_unit.hpp"
#include "cli/stopwatch.hpp"
#include "cli/table.hpp"
#include "cli/ties.hpp"
#include "sensitivity/gradients.hpp"
#include "studies/derivative_check.hpp"

namespace pleuel {

namespace {

/// Central differences of simulations reach about 1e-8; a wrong term shows as 1e-3 and more.
constexpr double agreement = 1e-6;

struct Findings {
  std::unique_ptr<Analysis> analysis;
  double simulation_seconds = 0.0, gradient_seconds = 0.0;
  Ties ties;
  std::vector<DerivativeCheck> derivatives;  ///< empty without variables
};

Findings examine(const ProblemFile& problem, const Eigen::VectorXd& x) {
  Findings findings;
  const Stopwatch simulation;
  findings.analysis = analyze(problem, x);
  findings.simulation_seconds = simulation.seconds();
  findings.ties = find_ties(*findings.analysis);
  if (problem.variables.empty() || problem.responses.empty()) return findings;
  const Stopwatch gradient;
  direct_gradients(*findings.analysis);
  findings.gradient_seconds = gradient.seconds();
  findings.derivatives = check_derivatives(problem, x, *findings.analysis, [](double step) {
    fmt::print(stderr, "verifying derivatives by central differences, step {:g} …\n", step);
  });
  return findings;
}

/// "agrees", "kink" where two unlike peaks tie, or "differs"
std::string verdict(const Findings& findings, std::size_t response) {
  if (findings.derivatives[response].error <= agreement) return "agrees";
  const std::optional<Tie>& tie = findings.ties[response];
  return tie && tie->is_kink() ? "kink" : "differs";
}

Json responses_with_verdicts(const Findings& findings) {
  Json document = responses_document(*findings.analysis);
  for (std::size_t i = 0; i < findings.derivatives.size(); ++i) {
    Json& response = document[findings.analysis->responses[i].name];
    response["derivatives"] = {{"verdict", verdict(findings, i)},
                               {"error", findings.derivatives[i].error},
                               {"difference_step", findings.derivatives[i].step}};
  }
  for (std::size_t i = 0; i < findings.ties.size(); ++i) {
    if (!findings.ties[i]) continue;
    const Response& response = findings.analysis->responses[i];
    document[response.name]["tie"] = tie_document(*findings.ties[i], response);
  }
  return document;
}

Json make_document(const ProblemFile& problem, const Findings& findings) {
  const Analysis& analysis = *findings.analysis;
  Json document = {{"name", problem.name},
                   {"bodies", bodies_document(analysis.model)},
                   {"coordinates", analysis.model.mechanism.system->coordinates()},
                   {"multipliers", analysis.model.mechanism.system->multipliers()},
                   {"steps", analysis.trajectory.steps()},
                   {"effects", effects_document(analysis.model)},
                   {"variables", variables_document(problem)},
                   {"responses", responses_with_verdicts(findings)},
                   {"seconds", {{"simulate", findings.simulation_seconds}}}};
  if (!findings.derivatives.empty()) document["seconds"]["direct"] = findings.gradient_seconds;
  return document;
}

std::string derivatives_text(const ProblemFile& problem, const Findings& findings) {
  Table table({{"response", Table::Align::left},
               {"value"},
               {"unit", Table::Align::left},
               {"derivative", Table::Align::left}});
  for (std::size_t i = 0; i < findings.derivatives.size(); ++i) {
    const ShownUnit unit = unit_of(problem.responses[i]);
    const std::string word = verdict(findings, i);
    const double error = findings.derivatives[i].error;
    table.add_row({problem.responses[i].name,
                   significant(unit.shown(findings.analysis->reductions[i].value)), unit.name,
                   error == 0.0 ? "agrees exactly"
                                : fmt::format("{} {} {}{}", word == "agrees" ? "agrees" : "DIFFERS",
                                              word == "agrees" ? "to" : "by", magnitude(error),
                                              word == "kink" ? ": a kink, see below" : "")});
  }
  return "Responses; direct differentiation against central differences (relative)\n" +
         table.text();
}

std::string time_text(const ProblemFile& problem, const Findings& findings) {
  std::string text = "\nTime: one simulation " + duration(findings.simulation_seconds);
  if (findings.derivatives.empty()) return text + "\n";
  text += ", its gradients " + duration(findings.gradient_seconds) + " more";
  if (problem.objective) {
    const double iteration = findings.simulation_seconds + findings.gradient_seconds;
    text += fmt::format("; an optimization of 20 to 50 iterations takes about {} to {}",
                        duration(20 * iteration), duration(50 * iteration));
  }
  return text + "\n";
}

std::string make_text(const ProblemFile& problem, const Findings& findings) {
  const Analysis& analysis = *findings.analysis;
  std::string text =
      fmt::format("{}: a valid problem\n{}\n\n{}\n{}", problem.name, size_text(analysis),
                  bodies_text(analysis.model), effects_text(analysis.model));
  if (!problem.variables.empty()) text += "\n" + variables_text(problem);
  text += "\n" + (findings.derivatives.empty() ? responses_text(problem, analysis)
                                               : derivatives_text(problem, findings));
  return text + ties_text(findings.ties, analysis) + time_text(problem, findings);
}

}  // namespace

Outcome run_check(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const ProblemFile& problem = input.problem;
  const Findings findings = examine(problem, input.design);
  return {ExitCode::done, make_document(problem, findings), make_text(problem, findings)};
}

}  // namespace pleuel
