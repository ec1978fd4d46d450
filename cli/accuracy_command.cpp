#include <optional>

#include <fmt/format.h>

#include "cli/accuracy_csv.hpp"
#include "cli/accuracy_document.hpp"
#include "cli/accuracy_report.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/run_record.hpp"
#include "cli/warnings.hpp"
#include "core/base/number_text.hpp"
#include "studies/accuracy.hpp"

namespace pleuel {

namespace {

void show_progress(const std::string& setting, const AccuracyRun& run) {
  show(stderr,
       fmt::format("  {}: {}\n", setting, run.has_failed() ? "failed" : duration(run.seconds())));
}

/// Runs the study, and writes accuracy.csv from its first result on.
AccuracyStudy study_of(const ProblemFile& problem, const PricedDesign& design, RunRecord& record) {
  std::optional<AccuracyCsv> csv;
  AccuracyObserver observer;
  observer.run = [&](const AccuracyRun& run) {
    if (!csv) csv.emplace(record.result("accuracy.csv"), problem);
    csv->add(run);
    show_progress(setting_text(run.settings), run);
  };
  observer.variation = [](const VariedRun& one) {
    show_progress(variation_text(one.variation), one.run);
  };
  AccuracyStudy study = accuracy_study(problem, design, observer);
  vary_settings(problem, design, study, observer);
  return study;
}

}  // namespace

Outcome run_accuracy(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const ProblemFile& problem = input.problem;
  RunRecord record(arguments, input, Json::object());
  show_warnings_before(problem);
  record.begin_phase("accuracy");
  const AccuracyStudy study = study_of(problem, PricedDesign(problem, input.design), record);
  Outcome outcome{study.is_interrupted ? ExitCode::not_verified : ExitCode::done,
                  accuracy_document(input, study), accuracy_text(problem, study)};
  outcome.text += fmt::format("\nWritten to {}: accuracy.csv, result.json, run_card.json\n",
                              record.folder().string());
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
