
#include "cli/commands/commands.hpp"
#include "cli/reports/derivative_report.hpp"
#include "cli/reports/time_text.hpp"
#include "sensitivity/initial_sensitivity.hpp"
#include "sensitivity/method_choice.hpp"
#include "studies/method_comparison.hpp"

namespace pleuel {

namespace {

struct MethodResult {
  GradientMethod method;
  Eigen::MatrixXd gradients;  ///< responses × variables [SI]
  double seconds = 0.0;
};

std::vector<GradientMethod> chosen_methods(const Arguments& arguments, const ProblemFile& problem) {
  std::vector<GradientMethod> methods;
  for (const std::string& name : arguments.methods) methods.push_back(gradient_method(name));
  if (methods.empty()) methods.push_back(problem.sensitivity.method);
  return methods;
}

/// Replaces "auto" by what it chooses.
std::optional<MethodChoice> resolve(Analysis& analysis, std::vector<GradientMethod>& methods) {
  const auto found = std::ranges::find(methods, GradientMethod::automatic);
  if (found == methods.end()) return std::nullopt;
  const MethodChoice choice = choose_method(analysis, response_values(analysis));
  const auto chosen =
      choice.method == ExactMethod::direct ? GradientMethod::direct : GradientMethod::adjoint;
  *found = chosen;
  if (std::ranges::count(methods, chosen) > 1) methods.erase(found);
  return choice;
}

/// How long a method takes, in simulations: of exact ones what is usual for few variables.
double simulations_of(GradientMethod method, Eigen::Index variables, int threads) {
  const double one_each = std::ceil(double(variables) / std::max(1, threads));
  if (method == GradientMethod::forward_difference) return one_each;
  if (method == GradientMethod::central_difference) return 2.0 * one_each;
  return 3.0;
}

struct MethodFindings {
  std::shared_ptr<Analysis> analysis;
  double simulation_seconds = 0.0;
  std::optional<MethodChoice> choice;  ///< if it was left to the program
  std::vector<MethodResult> results;
  std::optional<std::vector<Kink>> kinks;  ///< of an exact method, by the way
  Ties ties;
  std::vector<std::string> warnings;
  int consequences = 0;                  ///< so many of the last ones are not told
  ErrorBars errors;                      ///< of the values
  std::vector<ComparedMethod> compared;  ///< empty: not asked for
};

void compute(const ProblemInput& input, const std::vector<GradientMethod>& methods, int threads,
             ProgressLine& progress, MethodFindings& findings) {
  const GradientOptions options = {input.problem.sensitivity.difference_step, threads};
  Analysis& analysis = *findings.analysis;
  for (const GradientMethod method : methods) {
    progress.expect(to_string(method), simulations_of(method, input.design.size(), threads) *
                                           findings.simulation_seconds);
    const Stopwatch stopwatch;
    MethodResult result{method, {}, 0.0};
    if (is_difference(method)) {
      result.gradients = gradients(input.problem, input.design, analysis, method, options);
    } else {
      GradientsAndKinks found =
          gradients_and_kinks(analysis, input.problem.variables, exact_method(method));
      result.gradients = std::move(found.gradients);
      findings.kinks = std::move(found.kinks);
    }
    result.seconds = stopwatch.seconds();
    findings.results.push_back(std::move(result));
  }
}

Json comparison_document(const ProblemFile& problem, const std::vector<ComparedMethod>& compared) {
  return list_of(compared, [&](const ComparedMethod& one) {
    Json entry = {{"method", to_string(one.method)},
                  {"step", one.step > 0.0 ? Json(one.step) : Json(nullptr)},
                  {"seconds", one.seconds},
                  {"errors", by_name(problem.responses, one.errors)}};
    if (one.beside_direct) entry["time"] = time_change_document(*one.beside_direct);
    return entry;
  });
}

/// Of each method with its best step.
std::string comparison_text(const ProblemFile& problem,
                            const std::vector<ComparedMethod>& compared) {
  if (compared.empty()) return "";
  std::map<GradientMethod, const ComparedMethod*> best;
  for (const ComparedMethod& one : compared) {
    const ComparedMethod*& known = best[one.method];
    if (!known || one.errors.maxCoeff() < known->errors.maxCoeff()) known = &one;
  }
  Table table({left_aligned("method"), "best step", "time", "beside direct", "largest error",
               left_aligned("of")});
  for (const auto& [method, one] : best) {
    Eigen::Index worst = 0;
    const double error = one->errors.maxCoeff(&worst);
    table.add_row({to_string(method), one->step > 0.0 ? magnitude(one->step) : "–",
                   duration(one->seconds),
                   one->beside_direct ? time_change_text(*one->beside_direct) : "–",
                   magnitude(error), problem.responses[worst].name});
  }
  return "\nEffort and accuracy of the methods, with the step that is best for differences; errors "
         "relative,\ndirect and adjoint against each other\n" +
         table.text();
}

Json gradient_document(const ProblemFile& problem, const MethodFindings& findings) {
  const Analysis& analysis = *findings.analysis;
  Json document = {{"responses", responses_document(problem, analysis, findings.errors)},
                   {"seconds", {{"simulate", findings.simulation_seconds}}}};
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    Json& response = document["responses"][analysis.responses[i].name];
    response["gradients"] = Json::object();
    for (const MethodResult& result : findings.results) {
      response["gradients"][to_string(result.method)] =
          by_name(problem.variables, result.gradients.row(i));
    }
    if (findings.ties[i]) response["tie"] = tie_document(*findings.ties[i], analysis.responses[i]);
  }
  if (!findings.compared.empty()) {
    document["comparison"] = comparison_document(problem, findings.compared);
  }
  if (const auto& choice = findings.choice) {
    document["choice"] = {{"method", to_string(choice->method)}, {"reason", choice->reason}};
  }
  document["warnings"] = findings.warnings;
  for (const MethodResult& result : findings.results) {
    document["seconds"][to_string(result.method)] = result.seconds;
  }
  if (const RecomputedStates* states = analysis.trajectory.recomputed()) {
    document["memory"] = {{"checkpoints", states->checkpoints()},
                          {"most_states", states->most_held()},
                          {"repeated_steps", states->recomputed_steps()}};
  }
  return document;
}

std::vector<Table::Column> method_columns(const std::vector<MethodResult>& results) {
  std::vector<Table::Column> columns = {left_aligned("response"), left_aligned("variable")};
  for (const MethodResult& result : results) columns.push_back({to_string(result.method)});
  columns.push_back(left_aligned("unit"));
  if (results.size() > 1) columns.push_back("relative difference");
  return columns;
}

/// Of the entries of one row, relative to the largest.
double spread(const std::vector<MethodResult>& results, Eigen::Index i, Eigen::Index j) {
  Eigen::VectorXd entries(results.size());
  for (Eigen::Index k = 0; k < entries.size(); ++k) {
    entries(k) = results[k].gradients(i, j);
  }
  const double largest = entries.cwiseAbs().maxCoeff();
  return largest > 0.0 ? (entries.maxCoeff() - entries.minCoeff()) / largest : 0.0;
}

std::string gradients_text(const ProblemFile& problem, const std::vector<MethodResult>& results) {
  if (results.empty()) return "";
  const std::vector<ShownUnit> variable_unit = variable_units(problem);
  Table table(method_columns(results), 2);
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    const ShownUnit value_unit = unit_of(problem.responses[i]);
    for (std::size_t j = 0; j < problem.variables.size(); ++j) {
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      const ShownUnit& unit = variable_unit[j];
      std::vector<std::string> cells = {j == 0 ? problem.responses[i].name : "",
                                        problem.variables[j].name};
      for (const MethodResult& result : results) {
        const double shown = value_unit.shown(result.gradients(row, column)) * unit.factor;
        cells.push_back(significant(shown, 7));
      }
      cells.push_back(fmt::format("{}/{}", value_unit.name, unit.name));
      if (results.size() > 1) cells.push_back(magnitude(spread(results, row, column)));
      table.add_row(std::move(cells));
    }
  }
  return table.text();
}

std::string choice_text(const std::optional<MethodChoice>& choice) {
  if (!choice) return "";
  return wrapped(fmt::format("\nMethod: {} ({})\n", to_string(choice->method), choice->reason),
                 "  ");
}

/// What it took that the trajectory does not fit into the memory.
std::string memory_text(const Trajectory& trajectory) {
  const RecomputedStates* states = trajectory.recomputed();
  if (!states) return "";
  return fmt::format(
      "\nMemory: {} checkpoints, at most {} states at once; {} steps simulated again for the {} of "
      "the trajectory\n",
      states->checkpoints(), states->most_held(), states->recomputed_steps(), trajectory.steps());
}

std::string seconds_text(const std::vector<MethodResult>& results, double simulation_seconds) {
  std::string text = "\nTime: simulation " + duration(simulation_seconds);
  for (const MethodResult& result : results) {
    text += fmt::format(", {} {}", to_string(result.method), duration(result.seconds));
  }
  return text + "\n";
}

/// Into the run folder.
void write_run(RunRecord& record, const Arguments& arguments, const ProblemInput& input,
               const std::shared_ptr<Analysis>& analysis, Outcome& outcome) {
  record.begin_phase("histories");
  record.write_result(outcome.document);
  write_trajectory(record.result("trajectory.csv"), *analysis);
  if (arguments.wants_histories) {
    write_history_gradients(record.result("gradients.csv"), input.problem, *analysis);
  }
  record.finish(outcome, [&] {
    return run_picture(input.problem, {{input.design_name, input.design, analysis}});
  });
}

Outcome make_outcome(const Arguments& arguments, const ProblemInput& input,
                     const MethodFindings& findings) {
  const ProblemFile& problem = input.problem;
  Outcome outcome{
      ExitCode::done, gradient_document(problem, findings),
      fmt::format("Gradients at {} of {}\n\n{}{}", arguments.design ? "the design" : "the start",
                  problem.name, gradients_text(problem, findings.results),
                  ties_text(findings.ties, *findings.analysis))};
  if (!findings.warnings.empty()) {
    outcome.text += "\n" + warnings_text(findings.warnings, findings.consequences);
  }
  outcome.text += choice_text(findings.choice) + comparison_text(problem, findings.compared) +
                  memory_text(findings.analysis->trajectory) +
                  seconds_text(findings.results, findings.simulation_seconds);
  if (!arguments.differentiated_body) return outcome;
  const std::string& body = *arguments.differentiated_body;  // derivatives by each number of it
  const ConstantGradients found = constant_gradients(problem, input.design, body);
  outcome.document["by_invariants"] = constant_gradients_document(problem, body, found);
  outcome.text += constant_gradients_text(problem, body, found, values_of(*findings.analysis));
  return outcome;
}

}  // namespace

Outcome run_gradient(const Arguments& arguments) {
  const ProblemInput input = read_input_with_accuracy(arguments);
  const ProblemFile& problem = input.problem;
  std::vector<GradientMethod> methods = chosen_methods(arguments, problem);
  if (problem.variables.empty()) {
    if (!arguments.differentiated_body) {
      throw InputError("/variables is missing: there is nothing to differentiate for");
    }
    methods.clear();
  }
  std::optional<RunRecord> record;  // before the work: the folder may not be free
  if (arguments.wants_histories || arguments.compares_methods || arguments.output) {
    record.emplace(arguments, input, Json::object());
  }
  MethodFindings findings;
  ProgressLine progress(arguments, "simulating");
  const Stopwatch stopwatch;
  findings.analysis = analyze(problem, input.design);
  findings.simulation_seconds = stopwatch.seconds();
  findings.choice = resolve(*findings.analysis, methods);
  compute(input, methods, arguments.jobs, progress, findings);
  if (arguments.compares_methods) {
    findings.compared = compare_methods(problem, input.design, *findings.analysis,
                                        {arguments.jobs, [&](double step) {
                                           const std::string line = fmt::format(
                                               "differences with the step {:g} …", step);
                                           if (!progress.is_shown()) progress.print(line);
                                           progress.show_share(line, 0.0);
                                         }});
  }
  const bool is_checked = arguments.scrutiny != Scrutiny::none;
  if (is_checked) progress.show_share("checking the numbers", 0.0);
  if (!findings.kinks) findings.kinks = find_kinks(*findings.analysis, problem.variables);
  findings.ties = make_ties(*findings.analysis, *findings.kinks);
  const Analysis& analysis = *findings.analysis;
  const Monitors monitors = is_checked ? monitor(analysis.model, analysis.trajectory) : Monitors{};
  TrustedRun judged{problem, input.design, analysis, monitors, arguments.scrutiny};
  if (input.choice) judged.known = &input.choice->bars;
  Trust trust = judge_run(judged);
  findings.warnings =
      unknown_derivatives(problem, Design<double>(input.design.begin(), input.design.end()));
  add_new(findings.warnings, texts_of(trust.findings));
  if (!arguments.wants_all_warnings) findings.consequences = count_consequences(trust.findings);
  findings.errors = std::move(trust.errors);
  Outcome outcome = make_outcome(arguments, input, findings);
  if (record) write_run(*record, arguments, input, findings.analysis, outcome);
  return outcome;
}

}  // namespace pleuel
