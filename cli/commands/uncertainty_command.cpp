#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/reports/case_report.hpp"
#include "studies/missing_settings.hpp"

namespace pleuel {

namespace {

const std::string& name_of(const ProblemFile& problem, const UncertainParameter& parameter) {
  return problem.variables[parameter.variable].name;
}

Json sampled_document(const Sampled& sampled) {
  return {{"mean", sampled.mean},
          {"deviation", sampled.deviation},
          {"lowest", sampled.lowest},
          {"highest", sampled.highest}};
}

Json response_document(const ProblemFile& problem, const UncertaintyStudy& study,
                       std::size_t index) {
  const UncertainResponse& response = study.responses[index];
  const std::string unit = unit_of(problem.responses[index]).si;
  Json document = {{"value", response.value}, {"unit", unit}};
  document.update(uncertain_document(problem, response));
  if (!study.errors.empty()) document["error"] = error_document(error_of(study.errors, index));
  if (response.sampled) document["sampled"] = sampled_document(*response.sampled);
  return document;
}

/// {"value", "limit", "side", "unit", "distance": in deviations, "worst", "broken": samples} [SI]
Json limit_document(const ProblemFile& problem, const UncertaintyStudy& study,
                    const LimitScatter& limit) {
  Json document = {{"name", problem.constraints[limit.constraint].name},
                   {"value", study.responses[limit.response].value},
                   {"limit", limit.limit},
                   {"side", limit.is_upper ? "upper" : "lower"},
                   {"unit", unit_of(problem.responses[limit.response]).si},
                   {"worst", limit.worst}};
  if (std::isfinite(limit.distance)) document["distance"] = limit.distance;
  if (study.samples > 0) document["broken"] = limit.broken;
  return document;
}

Json make_document(const ProblemFile& problem, const UncertaintyStudy& study) {
  const auto limit_entry = [&](const LimitScatter& limit) {
    return limit_document(problem, study, limit);
  };
  Json document = {
      {"status", study_status(!study.is_interrupted)},
      {"parameters", Json::object()},
      {"responses", Json::object()},
      {"limits", list_of(study.limits, limit_entry)},
      {"samples", study.samples},
      {"failures", study.failures},
      {"warnings", texts_of(study.findings)},
      {"seconds", {{"gradients", study.gradient_seconds}, {"samples", study.sampling_seconds}}}};
  for (const UncertainParameter& parameter : problem.uncertainty->parameters) {
    const auto& variable = problem.variables[parameter.variable];
    document["parameters"][variable.name] = {{"value", variable.start},
                                             {"deviation", parameter.standard_deviation()},
                                             {"interval", parameter.half_width()}};
  }
  for (std::size_t i = 0; i < study.responses.size(); ++i) {
    document["responses"][problem.responses[i].name] = response_document(problem, study, i);
  }
  return document;
}

/// uncertainty.csv: every history with its deviation [SI].
void write_histories(const ResultFile& file, const ProblemFile& problem,
                     const UncertaintyStudy& study) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> columns;
  for (const UncertainHistory& history : study.histories) {
    const std::string& name = problem.responses[history.response].name;
    columns.emplace_back(name, history.values);
    columns.emplace_back(name + ":deviation", history.deviations);
    if (history.sampled_deviations.size() == 0) continue;
    columns.emplace_back(name + ":sampled_deviation", history.sampled_deviations);
  }
  write_histories(file, study.time, columns);
}

std::string parameters_text(const ProblemFile& problem, const Json& parameters) {
  const NamedUnits units = units_of_variables(problem);
  const auto distribution = [&](const std::string& name, const Json&) {
    const auto& all = problem.uncertainty->parameters;
    const auto is_it = [&](const UncertainParameter& one) { return name_of(problem, one) == name; };
    return std::ranges::find_if(all, is_it)->deviation > 0.0 ? "normal" : "uniform";
  };
  return table_of(parameters,
                  {name_column("parameter"),
                   shown_column("value", "/value", units),
                   shown_column("deviation", "/deviation", units, significant_digits(3)),
                   shown_column("half width", "/interval", units, significant_digits(3)),
                   unit_column(units),
                   {"sampled as", distribution, Table::Align::left}})
      .text();
}

/// "rod_height 78 %, crank_height 20 %"
std::string largest_shares(const std::string&, const Json& response) {
  constexpr std::size_t most_names = 2;
  constexpr double least = 0.005;
  std::multimap<double, std::string, std::greater<>> shares;
  for (const auto& [name, share] : response.at("shares").items()) shares.emplace(share, name);
  std::vector<std::string> parts;
  for (const auto& [share, name] : shares) {
    if (share < least || parts.size() == most_names) break;
    parts.push_back(fmt::format("{} {:.0f} %", name, 100.0 * share));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string responses_text(const ProblemFile& problem, const Json& document) {
  const NamedUnits units = units_of_responses(problem);
  const NumberText three = significant_digits(3);
  const auto half_width = [&](const std::string& name, const Json& response) {
    const double bound = response["bounds"][1].get<double>() - response["value"].get<double>();
    return three(units.at(name).shown(bound));
  };
  const auto error = [&](const std::string& name, const Json& response) {
    return error_text(response.value("error", Json()), units.at(name));
  };
  std::vector<DocumentColumn> columns = {name_column("response"),
                                         shown_column("value", "/value", units),
                                         shown_column("deviation", "/deviation", units, three),
                                         {"bounds ±", half_width},
                                         unit_column(units),
                                         {"error of value", error, Table::Align::left},
                                         {"from", largest_shares, Table::Align::left}};
  if (document.at("samples") > 1) {
    columns.insert(columns.end(),
                   {shown_column("sampled mean", "/sampled/mean", units),
                    shown_column("sampled deviation", "/sampled/deviation", units, three),
                    shown_column("lowest", "/sampled/lowest", units),
                    shown_column("highest", "/sampled/highest", units)});
  }
  return table_of(document.at("responses"), columns).text();
}

/// "the limits hold in all 200 samples; nearest: crank_strength, 4.2 deviations away"
std::string answer_text(const ProblemFile& problem, const UncertaintyStudy& study) {
  const auto distance_of = [](const LimitScatter& limit) {  // of one that does not scatter, none
    return std::isfinite(limit.distance) ? limit.distance : HUGE_VAL;
  };
  const auto nearest =
      std::ranges::min_element(study.limits, [&](const LimitScatter& a, const LimitScatter& b) {
        return distance_of(a) < distance_of(b);
      });
  if (nearest == study.limits.end() || distance_of(*nearest) == HUGE_VAL) return "";
  const auto most = std::ranges::max_element(
      study.limits,
      [](const LimitScatter& a, const LimitScatter& b) { return a.broken < b.broken; });
  const auto name = [&](const LimitScatter& limit) {
    return problem.constraints[limit.constraint].name;
  };
  const bool is_beyond = nearest->distance < 0.0;
  const std::string distance = fmt::format(
      "{}: {}, {} deviations {} its limit", is_beyond ? "worst" : "nearest", name(*nearest),
      significant(std::abs(nearest->distance), 2), is_beyond ? "beyond" : "from");
  if (study.samples == 0) return fmt::format("To first order, {}.\n\n", distance);
  if (most->broken == 0) {
    return fmt::format("Every limit holds in all {} samples; {}.\n\n", study.samples, distance);
  }
  return fmt::format("Limits are broken: {} in {} of {} samples; {}.\n\n", name(*most),
                     most->broken, study.samples, distance);
}

/// Does it still hold? A row a limit.
std::string scatter_text(const ProblemFile& problem, const Json& document) {
  const NamedUnits units = units_of_limits(problem);
  const int samples = document.at("samples").get<int>();
  std::vector<DocumentColumn> columns = {
      name_column("constraint"),
      shown_column("value", "/value", units),
      limit_column(units),
      unit_column(units),
      number_column("distance", "/distance",
                    [](double distance) { return significant(distance, 3) + " σ"; }),
      shown_column("at worst", "/worst", units)};
  if (samples > 0) {
    columns.push_back(number_column("broken in", "/broken",
                                    [=](double broken) { return percent(broken / samples); }));
  }
  const Table table = table_of(document.at("limits"), columns);
  return table.is_empty() ? "" : table.text() + "\n";
}

std::string study_text(const ProblemFile& problem, const UncertaintyStudy& study,
                       const Json& document) {
  const std::size_t samples = study.samples + study.failures;
  const std::size_t all = problem.uncertainty->samples;
  std::string text = study.is_interrupted ? interrupted_text(samples, all, "samples") : "";
  text += fmt::format(
      "{}: what uncertain parameters make of the responses, to first order\n\n{}{}{}\n{}\n"
      "Time: gradients {}",
      problem.name, wrapped(answer_text(problem, study)), scatter_text(problem, document),
      parameters_text(problem, document["parameters"]), responses_text(problem, document),
      duration(study.gradient_seconds));
  if (samples > 0) {
    text += fmt::format("; {} samples {}", samples, duration(study.sampling_seconds));
  }
  text += "\n" + warnings_text(texts_of(study.findings));
  if (study.failures > 0) {
    text += fmt::format("{} samples could not be simulated and are left out\n", study.failures);
  }
  return text;
}

UncertaintyStudy run_study(const ProblemFile& problem, const Arguments& arguments,
                           EvaluationStore& store) {
  ProgressLine progress(arguments, "gradients of the responses");
  const int samples = problem.uncertainty->samples;
  const auto see = [&](int done, double seconds_left) {
    const std::string line = fmt::format("{} of {} samples", done, samples);
    progress.expect(line, seconds_left);
    if (progress.is_shown()) return;
    const std::string left =
        done < samples ? fmt::format(", about {} left", duration(seconds_left)) : "";
    progress.print(fmt::format("  {}{}", line, left));
  };
  return uncertainty_study(
      problem, {arguments.tasks(), &store}, see,
      arguments.wants_histories ? SampledNumbers::histories : SampledNumbers::values);
}

}  // namespace

Outcome run_uncertainty(const Arguments& arguments) {
  ProblemInput input = read_input_with_accuracy(arguments);
  for (std::size_t i = 0; i < input.problem.variables.size(); ++i) {
    input.problem.variables[i].start = input.design(i);  // that of --design, if there is one
  }
  const ProblemFile& problem = input.problem;
  require_uncertainty(problem);
  RunRecord record(arguments, input, {{"jobs", arguments.jobs}});
  RunStore store(record, arguments, input, Json::object());
  show_warnings_before(problem);
  record.begin_phase("uncertainty");
  const UncertaintyStudy study = run_study(problem, arguments, store);
  Outcome outcome{study.is_interrupted ? ExitCode::not_verified : ExitCode::done,
                  make_document(problem, study), ""};
  outcome.text = study_text(problem, study, outcome.document) + "\n";
  store.finish(outcome);
  record.write_result(outcome.document);
  write_histories(record.result("uncertainty.csv"), problem, study);
  record.finish(outcome, [&] { return run_picture(problem, {{input.design_name, input.design}}); });
  return outcome;
}

}  // namespace pleuel
