#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/commands/accurate_input.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/progress_line.hpp"
#include "cli/files/csv_file.hpp"
#include "cli/files/run_picture.hpp"
#include "cli/files/run_record.hpp"
#include "cli/files/run_store.hpp"
#include "cli/reports/error_report.hpp"
#include "cli/reports/warnings.hpp"
#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/trust/doubts.hpp"
#include "studies/missing_settings.hpp"
#include "studies/uncertainty.hpp"

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
  Json document = {{"value", response.value},
                   {"unit", unit},
                   {"deviation", response.deviation},
                   {"bounds", {response.value - response.bound, response.value + response.bound}},
                   {"shares", Json::object()},
                   {"gradients", Json::object()}};
  const auto& parameters = problem.uncertainty->parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string& name = name_of(problem, parameters[i]);
    document["shares"][name] = response.shares(i);
    document["gradients"][name] = response.gradient(i);
  }
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
  Json document = {
      {"status", study_status(!study.is_interrupted)},
      {"parameters", Json::object()},
      {"responses", Json::object()},
      {"limits", Json::array()},
      {"samples", study.samples},
      {"failures", study.failures},
      {"warnings", texts_of(study.doubts)},
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
  for (const LimitScatter& limit : study.limits) {
    document["limits"].push_back(limit_document(problem, study, limit));
  }
  return document;
}

/// uncertainty.csv: every history with its deviation [SI].
void write_histories(const ResultFile& file, const ProblemFile& problem,
                     const UncertaintyStudy& study) {
  std::vector<std::string> header = {"time"};
  for (const UncertainHistory& history : study.histories) {
    const std::string& name = problem.responses[history.response].name;
    header.push_back(name);
    header.push_back(name + ":deviation");
    if (history.sampled_deviations.size() > 0) header.push_back(name + ":sampled_deviation");
  }
  CsvFile csv(file, header);
  for (Eigen::Index i = 0; i < study.time.size(); ++i) {
    csv.add(study.time(i));
    for (const UncertainHistory& history : study.histories) {
      csv.add(history.values(i)).add(history.deviations(i));
      if (history.sampled_deviations.size() > 0) csv.add(history.sampled_deviations(i));
    }
    csv.end_row();
  }
}

std::string parameters_text(const ProblemFile& problem) {
  const std::vector<ShownUnit> units = variable_units(problem);
  Table table({{"parameter", Table::Align::left},
               {"value"},
               {"deviation"},
               {"half width"},
               {"unit", Table::Align::left},
               {"sampled as", Table::Align::left}});
  for (const UncertainParameter& parameter : problem.uncertainty->parameters) {
    const std::size_t index = parameter.variable;
    const ShownUnit& unit = units[index];
    table.add_row({name_of(problem, parameter),
                   significant(unit.shown(problem.variables[index].start)),
                   significant(unit.shown(parameter.standard_deviation()), 3),
                   significant(unit.shown(parameter.half_width()), 3), unit.name,
                   parameter.deviation > 0.0 ? "normal" : "uniform"});
  }
  return table.text();
}

/// "rod_height 78 %, crank_height 20 %"
std::string largest_shares(const ProblemFile& problem, const UncertainResponse& response) {
  const auto& parameters = problem.uncertainty->parameters;
  std::vector<std::size_t> order(parameters.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto share = [&](std::size_t i) { return response.shares(i); };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return share(a) > share(b); });
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(2, order.size()); ++k) {
    if (share(order[k]) < 0.005) break;
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ",
                        name_of(problem, parameters[order[k]]), 100.0 * share(order[k]));
  }
  return text;
}

std::string responses_text(const ProblemFile& problem, const UncertaintyStudy& study) {
  std::vector<Table::Column> columns = {{"response", Table::Align::left},
                                        {"value"},
                                        {"deviation"},
                                        {"bounds ±"},
                                        {"unit", Table::Align::left},
                                        {"error of value", Table::Align::left},
                                        {"from", Table::Align::left}};
  const bool is_sampled = study.samples > 1;
  if (is_sampled) {
    columns.insert(columns.end(),
                   {{"sampled mean"}, {"sampled deviation"}, {"lowest"}, {"highest"}});
  }
  Table table(columns);
  for (std::size_t i = 0; i < study.responses.size(); ++i) {
    const UncertainResponse& response = study.responses[i];
    const ShownUnit unit = unit_of(problem.responses[i]);
    const auto shown = [&](double value, int digits) {
      return significant(unit.shown(value), digits);
    };
    std::vector<std::string> cells = {problem.responses[i].name,
                                      shown(response.value, 5),
                                      shown(response.deviation, 3),
                                      shown(response.bound, 3),
                                      unit.name,
                                      error_text(error_of(study.errors, i), unit),
                                      largest_shares(problem, response)};
    if (response.sampled) {
      cells.insert(cells.end(),
                   {shown(response.sampled->mean, 5), shown(response.sampled->deviation, 3),
                    shown(response.sampled->lowest, 5), shown(response.sampled->highest, 5)});
    }
    table.add_row(std::move(cells));
  }
  return table.text();
}

/// "the limits hold in all 200 samples; nearest: crank_strength, 4.2 deviations away"
std::string answer_text(const ProblemFile& problem, const UncertaintyStudy& study) {
  const auto distance_of = [](const LimitScatter& limit) {  // of one that does not scatter, none
    return std::isfinite(limit.distance) ? limit.distance : HUGE_VAL;
  };
  const auto nearest = std::min_element(study.limits.begin(), study.limits.end(),
                                        [&](const LimitScatter& a, const LimitScatter& b) {
                                          return distance_of(a) < distance_of(b);
                                        });
  if (nearest == study.limits.end() || distance_of(*nearest) == HUGE_VAL) return "";
  const auto most = std::max_element(
      study.limits.begin(), study.limits.end(),
      [](const LimitScatter& a, const LimitScatter& b) { return a.broken < b.broken; });
  const auto name = [&](const LimitScatter& limit) {
    return problem.constraints[limit.constraint].name;
  };
  const std::string distance = fmt::format(
      "nearest: {}, {} deviations {} its limit", name(*nearest),
      significant(std::abs(nearest->distance), 2), nearest->distance < 0.0 ? "beyond" : "from");
  if (study.samples == 0) return fmt::format("To first order, {}.\n\n", distance);
  if (most->broken == 0) {
    return fmt::format("Every limit holds in all {} samples; {}.\n\n", study.samples, distance);
  }
  return fmt::format("Limits are broken: {} in {} of {} samples; {}.\n\n", name(*most),
                     most->broken, study.samples, distance);
}

/// Does it still hold? A row a limit.
std::string limits_text(const ProblemFile& problem, const UncertaintyStudy& study) {
  std::vector<Table::Column> columns = {
      {"constraint", Table::Align::left}, {"value"},    {"limit"},
      {"unit", Table::Align::left},       {"distance"}, {"at worst"}};
  if (study.samples > 0) columns.push_back({"broken in"});
  Table table(columns);
  for (const LimitScatter& limit : study.limits) {
    const ShownUnit unit = unit_of(problem.responses[limit.response]);
    std::vector<std::string> cells = {
        problem.constraints[limit.constraint].name,
        significant(unit.shown(study.responses[limit.response].value)),
        (limit.is_upper ? "≤ " : "≥ ") + significant(unit.shown(limit.limit)),
        unit.name,
        std::isfinite(limit.distance) ? significant(limit.distance, 3) + " σ" : "–",
        significant(unit.shown(limit.worst))};
    if (study.samples > 0) cells.push_back(percent(double(limit.broken) / study.samples));
    table.add_row(std::move(cells));
  }
  return table.is_empty() ? "" : table.text() + "\n";
}

std::string study_text(const ProblemFile& problem, const UncertaintyStudy& study) {
  const std::size_t samples = study.samples + study.failures;
  const std::size_t all = problem.uncertainty->samples;
  std::string text = study.is_interrupted ? interrupted_text(samples, all, "samples") : "";
  text += fmt::format(
      "{}: what uncertain parameters make of the responses, to first order\n\n{}{}{}\n{}\n"
      "Time: gradients {}",
      problem.name, answer_text(problem, study), limits_text(problem, study),
      parameters_text(problem), responses_text(problem, study), duration(study.gradient_seconds));
  if (samples > 0) {
    text += fmt::format("; {} samples {}", samples, duration(study.sampling_seconds));
  }
  text += "\n" + warnings_text(texts_of(study.doubts));
  if (study.failures > 0) {
    text += fmt::format("{} samples could not be simulated and are left out\n", study.failures);
  }
  return text;
}

UncertaintyStudy run_study(const ProblemFile& problem, const Arguments& arguments,
                           EvaluationStore& store) {
  ProgressLine progress(arguments, "gradients of the responses");
  const int samples = problem.uncertainty->samples;
  return uncertainty_study(problem, {arguments.tasks(), &store}, [&](int done) {
    const std::string line = fmt::format("{} of {} samples", done, samples);
    if (progress.is_shown()) {
      progress.show_share(line, double(done) / samples);
    } else {
      progress.print("  " + line);
    }
  });
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
                  make_document(problem, study), study_text(problem, study)};
  outcome.text += "\n";
  if (study.is_interrupted) {
    outcome.text += resume_text(arguments, record.folder(), Status::interrupted);
  }
  outcome.text +=
      store.text() +
      fmt::format("Written to {}: uncertainty.csv, result.json, run_card.json, run.sqlite\n",
                  record.folder().string());
  store.finish(outcome);
  record.write("result.json", outcome.document);
  write_histories(record.result("uncertainty.csv"), problem, study);
  record.show_picture([&] {
    return run_picture(input.problem, {{arguments.design ? "design" : "start", input.design}});
  });
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
