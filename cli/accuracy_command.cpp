#include <optional>

#include <fmt/format.h>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/csv_file.hpp"
#include "cli/run_record.hpp"
#include "cli/table.hpp"
#include "cli/warnings.hpp"
#include "cli/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/reading/json_text.hpp"
#include "core/trust/doubts.hpp"
#include "studies/accuracy.hpp"

namespace pleuel {

namespace {

const AccuracyRun* recommended_run(const AccuracyStudy& study) {
  if (study.recommendations.empty() || !study.recommendations.front().values) return nullptr;
  return &study.runs[*study.recommendations.front().values];
}

/// Of the reference, and of the setting that is recommended.
std::vector<std::string> warnings_of(const AccuracyStudy& study) {
  std::vector<std::string> warnings = texts_of(study.reference.doubts);
  if (const AccuracyRun* run = recommended_run(study)) add_new(warnings, texts_of(run->doubts));
  return warnings;
}

std::string elements_text(const Discretization& settings) {
  return settings.elements > 0 ? std::to_string(settings.elements)
                               : fmt::format("×{:g}", settings.factor);
}

/// "a step of 0.2 ms and 4 elements", "… the elements of the file", "… 0.5 times its elements"
std::string setting_text(const Discretization& settings) {
  std::string text = fmt::format("a step of {:.4g} ms and ", 1e3 * settings.step);
  if (settings.elements > 0) return text + fmt::format("{} elements a segment", settings.elements);
  return text + (settings.factor == 1.0
                     ? std::string("the elements of the file")
                     : fmt::format("{:g} times the elements of the file", settings.factor));
}

Json settings_document(const AccuracyRun& run) {
  Json document = {{"step", run.settings.step}};
  if (run.settings.elements > 0) {
    document["elements"] = run.settings.elements;
  } else {
    document["element_factor"] = run.settings.factor;
  }
  return document;
}

/// {POINTER: value} of what --set has to change for a setting.
Json overrides_document(const ProblemInput& input, const Discretization& settings) {
  Json overrides = {{"/simulation/step", settings.step}};
  const ProblemFile divided = discretized(input.problem, settings);
  for (const Body& body : divided.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || beam->is_rigid) continue;
    const std::string pointer = child_pointer("/scene/bodies", body.name);
    const Json& written = input.effective[Json::json_pointer(pointer)];
    for (std::size_t i = 0; i < beam->segments.size(); ++i) {
      const std::string place =
          written.contains("segments") ? fmt::format("{}/segments/{}", pointer, i) : pointer;
      overrides[place + "/elements"] = beam->segments[i].elements;
    }
  }
  return overrides;
}

Json errors_document(const ProblemFile& problem, const Eigen::VectorXd& errors) {
  Json document = Json::object();
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    document[problem.responses[static_cast<std::size_t>(i)].name] = errors(i);
  }
  return document;
}

Json run_document(const ProblemFile& problem, const AccuracyRun& run) {
  Json document = {{"settings", settings_document(run)}};
  if (!run.failure.empty()) {
    document["failure"] = run.failure;
    return document;
  }
  document["warnings"] = texts_of(run.doubts);
  document["errors"] = errors_document(problem, run.errors);
  document["gradient_errors"] = errors_document(problem, run.gradient_errors);
  document["seconds"] = run.seconds();
  document["simulation_seconds"] = run.simulation_seconds;
  document["gradient_seconds"] = run.gradient_seconds;
  document["work"] = {{"steps", run.steps},
                      {"newton_iterations", run.newton_iterations},
                      {"factorizations", run.factorizations}};
  return document;
}

/// What is recommended for values, or for values and gradients; null if nothing is.
Json choice_document(const ProblemInput& input, const AccuracyStudy& study,
                     const std::optional<std::size_t>& choice, bool with_gradients) {
  if (!choice) return nullptr;
  const AccuracyRun& run = study.runs[*choice];
  Json document = settings_document(run);
  document["overrides"] = overrides_document(input, run.settings);
  document["seconds"] = with_gradients ? run.seconds() : run.simulation_seconds;
  document["errors"] = errors_document(input.problem, run.errors);
  return document;
}

Json make_document(const ProblemInput& input, const AccuracyStudy& study) {
  const ProblemFile& problem = input.problem;
  Json document = {{"status", study_status(!study.is_interrupted)},
                   {"error", problem.accuracy.target},
                   {"recommended", nullptr},
                   {"recommended_for_gradients", nullptr},
                   {"recommendations", Json::array()},
                   {"counted", Json::array()},
                   {"runs", Json::array()}};
  for (const std::size_t i : study.counted) {
    document["counted"].push_back(problem.responses[i].name);
  }
  for (const AccuracyRun& run : study.runs) {
    document["runs"].push_back(run_document(problem, run));
  }
  for (const Recommendation& one : study.recommendations) {
    document["recommendations"].push_back(
        {{"error", one.target},
         {"values", choice_document(input, study, one.values, false)},
         {"gradients", choice_document(input, study, one.gradients, true)}});
  }
  if (!study.recommendations.empty()) {
    document["recommended"] = document["recommendations"][0]["values"];
    document["recommended_for_gradients"] = document["recommendations"][0]["gradients"];
  }
  document["reference"] = settings_document(study.reference);
  document["reference"]["seconds"] = study.reference.seconds();
  document["warnings"] = warnings_of(study);
  document["reference"]["values"] = errors_document(problem, study.reference.values);
  document["reference"]["errors"] = errors_document(problem, study.reference.errors);
  document["reference"]["gradient_errors"] =
      errors_document(problem, study.reference.gradient_errors);
  return document;
}

/// accuracy.csv: a line for each run as it is done [SI].
class AccuracyCsv {
 public:
  AccuracyCsv(const ResultFile& file, const ProblemFile& problem)
      : csv_(file, header(problem)), responses_(problem.responses.size()) {}

  void add(const AccuracyRun& run) {
    csv_.add(run.settings.step);
    if (run.settings.elements > 0) {
      csv_.add(run.settings.elements);
    } else {
      csv_.add(elements_text(run.settings));
    }
    csv_.add(run.steps).add(run.newton_iterations).add(run.factorizations);
    csv_.add(run.simulation_seconds).add(run.gradient_seconds);
    add(run.errors);
    add(run.gradient_errors);
    csv_.add(run.failure);
    csv_.end_row();
  }

 private:
  /// Empty cells where nothing is known: after a failure, or without variables.
  void add(const Eigen::VectorXd& errors) {
    for (std::size_t i = 0; i < responses_; ++i) {
      if (errors.size() == 0) {
        csv_.add(std::string());
      } else {
        csv_.add(errors(static_cast<Eigen::Index>(i)));
      }
    }
  }

  static std::vector<std::string> header(const ProblemFile& problem) {
    std::vector<std::string> titles = {
        "step",           "elements",           "steps",           "newton_iterations",
        "factorizations", "simulation_seconds", "gradient_seconds"};
    for (const char* kind : {"error:", "gradient_error:"}) {
      for (const ResponseSettings& response : problem.responses) {
        titles.push_back(kind + response.name);
      }
    }
    titles.push_back("failure");
    return titles;
  }

  CsvFile csv_;
  std::size_t responses_;
};

/// The largest of some errors and whose it is: "3.1e-04 rod_stress"; with "≤" if it is below that
/// of the reference, which then stands there.
std::string worst(const ProblemFile& problem, const Eigen::VectorXd& errors,
                  const Eigen::VectorXd& of_reference) {
  if (errors.size() == 0) return "–";
  Eigen::Index index = 0;
  const double largest = errors.maxCoeff(&index);
  const bool is_bound = largest > 0.0 && largest <= of_reference(index);
  return fmt::format("{}{} {}", is_bound ? "≤ " : "", magnitude(largest),
                     problem.responses[static_cast<std::size_t>(index)].name);
}

std::vector<std::string> row(const ProblemFile& problem, const AccuracyRun& run,
                             const AccuracyRun& reference) {
  std::vector<std::string> cells = {fmt::format("{:.4g}", 1e3 * run.settings.step),
                                    elements_text(run.settings)};
  if (!run.failure.empty()) {
    cells.insert(cells.end(), {"failed", run.failure.substr(0, run.failure.find(". "))});
    return cells;
  }
  cells.insert(cells.end(), {worst(problem, run.errors, reference.errors),
                             worst(problem, run.gradient_errors, reference.gradient_errors),
                             fmt::format("{:.1f}", 1e3 * run.simulation_seconds),
                             fmt::format("{:.1f}", 1e3 * run.gradient_seconds),
                             std::to_string(run.steps), std::to_string(run.factorizations)});
  return cells;
}

std::string runs_text(const ProblemFile& problem, const AccuracyStudy& study) {
  Table table({{"step [ms]"},
               {"elements"},
               {"largest error", Table::Align::left},
               {"of a gradient", Table::Align::left},
               {"simulation [ms]"},
               {"gradient [ms]"},
               {"steps"},
               {"factorizations"},
               {"", Table::Align::left}},
              2);
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    std::vector<std::string> cells = row(problem, study.runs[i], study.reference);
    if (recommended_run(study) == &study.runs[i]) cells.push_back("← recommended");
    table.add_row(std::move(cells));
  }
  return table.text();
}

/// "1 %", "0.1 %"
std::string target_text(double target) {
  return fmt::format("{:g} %", 100.0 * target);
}

/// "For 1 % take a step of 0.2 ms and 4 elements a segment: 9.7 ms a simulation; for gradients …"
std::string recommendation_text(const AccuracyStudy& study, const Recommendation& one) {
  if (!one.values) {
    return fmt::format("For {} none of these settings will do. ", target_text(one.target));
  }
  const AccuracyRun& run = study.runs[*one.values];
  std::string text = fmt::format("For {} take {}: {:.2g} ms a simulation", target_text(one.target),
                                 setting_text(run.settings), 1e3 * run.simulation_seconds);
  if (run.gradient_errors.size() == 0) return text + ". ";
  if (!one.gradients) return text + "; gradients are not as exact with any of them. ";
  if (one.gradients == one.values) {
    return text + fmt::format(", {:.2g} ms with gradients as exact. ", 1e3 * run.seconds());
  }
  const AccuracyRun& other = study.runs[*one.gradients];
  return text + fmt::format("; for gradients as exact {}, {:.2g} ms with them. ",
                            setting_text(other.settings), 1e3 * other.seconds());
}

std::string recommendations_text(const AccuracyStudy& study) {
  if (study.is_interrupted) return "Nothing is recommended before all runs are done.\n";
  std::string text;
  for (const Recommendation& one : study.recommendations) {
    text += recommendation_text(study, one);
    if (!one.values) break;  // nor for less
  }
  return text + "\n";
}

std::string largest_of(const Eigen::VectorXd& errors) {
  return errors.size() == 0 ? "–" : magnitude(errors.maxCoeff());
}

std::string counted_text(const ProblemFile& problem, const AccuracyStudy& study) {
  if (study.counted.size() == problem.responses.size()) return "all responses";
  std::vector<std::string> names;
  for (const std::size_t i : study.counted) names.push_back(problem.responses[i].name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string study_text(const ProblemFile& problem, const AccuracyStudy& study) {
  const std::size_t all = accuracy_grid(problem).size();
  std::string text = study.is_interrupted ? interrupted_text(study.runs.size(), all, "runs") : "";
  text += wrapped(problem.name + ": " + recommendations_text(study)) + "\n" +
          runs_text(problem, study) + "\n";
  text += wrapped(fmt::format(
      "Errors are relative to a reference with {} ({}), whose own error is estimated at {}, of "
      "gradients {} (≤: below that). What is recommended counts {}. Times are processor times.",
      setting_text(study.reference.settings), duration(study.reference.seconds()),
      largest_of(study.reference.errors), largest_of(study.reference.gradient_errors),
      counted_text(problem, study)));
  return text + "\n" + warnings_text(warnings_of(study));
}

}  // namespace

Outcome run_accuracy(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const ProblemFile& problem = input.problem;
  RunRecord record(arguments, input, Json::object());
  show_warnings_before(problem);
  record.begin_phase("accuracy");
  std::optional<AccuracyCsv> csv;  // with the first result
  const AccuracyStudy study = accuracy_study(problem, input.design, [&](const AccuracyRun& run) {
    if (!csv) csv.emplace(record.result("accuracy.csv"), problem);
    csv->add(run);
    show(stderr, fmt::format("  {}: {}\n", setting_text(run.settings),
                             run.failure.empty() ? duration(run.seconds()) : "failed"));
  });
  Outcome outcome{study.is_interrupted ? ExitCode::not_verified : ExitCode::done,
                  make_document(input, study), study_text(problem, study)};
  outcome.text += fmt::format("\nWritten to {}: accuracy.csv, result.json, run_card.json\n",
                              record.folder().string());
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
