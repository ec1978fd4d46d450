#include <optional>

#include <fmt/format.h>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/csv_file.hpp"
#include "cli/run_record.hpp"
#include "cli/table.hpp"
#include "cli/warnings.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/trust/doubts.hpp"
#include "studies/accuracy.hpp"

namespace pleuel {

namespace {

/// Of the reference, and of the setting that is recommended.
std::vector<std::string> warnings_of(const AccuracyStudy& study) {
  std::vector<std::string> warnings = texts_of(study.reference.doubts);
  if (study.recommended) add_new(warnings, texts_of(study.runs[*study.recommended].doubts));
  return warnings;
}

Json settings_document(const AccuracyRun& run) {
  return {{"step", run.settings.step}, {"elements", run.settings.elements}};
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

Json make_document(const ProblemFile& problem, const AccuracyStudy& study) {
  Json document = {{"status", study_status(!study.is_interrupted)},
                   {"error", problem.accuracy->error},
                   {"runs", Json::array()}};
  for (const AccuracyRun& run : study.runs) {
    document["runs"].push_back(run_document(problem, run));
  }
  document["recommended"] =
      study.recommended ? settings_document(study.runs[*study.recommended]) : Json(nullptr);
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
    csv_.add(run.settings.step).add(run.settings.elements);
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
                                    std::to_string(run.settings.elements)};
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
    if (study.recommended == i) cells.push_back("← recommended");
    table.add_row(std::move(cells));
  }
  return table.text();
}

std::string recommendation_text(const ProblemFile& problem, const AccuracyStudy& study) {
  if (study.is_interrupted) return "Nothing is recommended before all runs are done.\n";
  if (!study.recommended) {
    return fmt::format(
        "No setting keeps all errors below {:g}: add smaller steps or more elements to "
        "/accuracy.\n",
        problem.accuracy->error);
  }
  const AccuracyRun& run = study.runs[*study.recommended];
  return fmt::format(
      "Recommended: step {:.4g} ms, {} elements a segment: the fastest with all errors below "
      "{:g}\n",
      1e3 * run.settings.step, run.settings.elements, problem.accuracy->error);
}

std::string largest_of(const Eigen::VectorXd& errors) {
  return errors.size() == 0 ? "–" : magnitude(errors.maxCoeff());
}

std::string study_text(const ProblemFile& problem, const AccuracyStudy& study) {
  const std::size_t all = problem.accuracy->steps.size() * problem.accuracy->elements.size();
  return fmt::format(
      "{}{}: errors relative to a reference with step {:.4g} ms and {} elements a segment ({})\n"
      "Its own error is estimated at {}, of gradients {}; ≤: below the reference's own error\n\n"
      "{}\n{}{}",
      study.is_interrupted ? interrupted_text(study.runs.size(), all, "runs") : "", problem.name,
      1e3 * study.reference.settings.step, study.reference.settings.elements,
      duration(study.reference.seconds()), largest_of(study.reference.errors),
      largest_of(study.reference.gradient_errors), runs_text(problem, study),
      recommendation_text(problem, study), warnings_text(warnings_of(study)));
}

}  // namespace

Outcome run_accuracy(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const ProblemFile& problem = input.problem;
  if (!problem.accuracy) throw InputError("/accuracy is missing: it says which steps to try");
  RunRecord record(arguments, input, Json::object());
  show_warnings_before(problem);
  record.begin_phase("accuracy");
  std::optional<AccuracyCsv> csv;  // with the first result
  const AccuracyStudy study = accuracy_study(problem, [&](const AccuracyRun& run) {
    if (!csv) csv.emplace(record.result("accuracy.csv"), problem);
    csv->add(run);
    show(stderr, fmt::format("  step {:.4g} ms, {} elements: {}\n", 1e3 * run.settings.step,
                             run.settings.elements,
                             run.failure.empty() ? duration(run.seconds()) : "failed"));
  });
  Outcome outcome{study.is_interrupted ? ExitCode::not_verified : ExitCode::done,
                  make_document(problem, study), study_text(problem, study)};
  outcome.text += fmt::format("\nWritten to {}: accuracy.csv, result.json, run_card.json\n",
                              record.folder().string());
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
