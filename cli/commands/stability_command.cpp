#include <optional>

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/commands/progress_line.hpp"
#include "cli/files/csv_file.hpp"
#include "cli/files/run_record.hpp"
#include "cli/reports/warnings.hpp"
#include "cli/text/console.hpp"
#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/trust/doubts.hpp"
#include "studies/stability.hpp"

namespace pleuel {

namespace {

std::string case_name(const StabilityRun& run) {
  return run.file.stem().string();
}

Json run_document(const StabilityRun& run) {
  Json document = {
      {"file", run.file.string()}, {"problem", run.problem}, {"formulation", run.formulation}};
  if (!run.is_ok()) {
    document["failure"] = run.failure;
    return document;
  }
  document["position_drift"] = run.position_drift;
  document["velocity_drift"] = run.velocity_drift;
  document["energy_error"] = run.energy_error;
  document["condition"] = run.condition;
  document["seconds"] = run.seconds;
  document["warnings"] = run.warnings;
  document["work"] = {{"steps", run.steps},
                      {"newton_iterations", run.newton_iterations},
                      {"factorizations", run.factorizations}};
  return document;
}

Json make_document(const std::vector<StabilityRun>& runs, bool is_whole) {
  Json document = {
      {"status", study_status(is_whole)}, {"formulations", Json::array()}, {"runs", Json::array()}};
  for (const auto* compared : {&compared_formulations(), &compared_schemes()}) {
    for (const ComparedFormulation& formulation : *compared) {
      document["formulations"].push_back(formulation.name);
    }
  }
  for (const StabilityRun& run : runs) document["runs"].push_back(run_document(run));
  return document;
}

/// stability.csv: a line for each run as it is done [SI].
class StabilityCsv {
 public:
  explicit StabilityCsv(const ResultFile& file)
      : csv_(file, {"file", "formulation", "steps", "newton_iterations", "factorizations",
                    "position_drift", "velocity_drift", "energy_error", "condition", "seconds",
                    "failure"}) {}

  void add(const StabilityRun& run) {
    csv_.add(run.file.string()).add(run.formulation);
    if (run.is_ok()) {
      csv_.add(run.steps).add(run.newton_iterations).add(run.factorizations);
      csv_.add(run.position_drift)
          .add(run.velocity_drift)
          .add(run.energy_error)
          .add(run.condition)
          .add(run.seconds);
    } else {
      for (int i = 0; i < 8; ++i) csv_.add(std::string());
    }
    csv_.add(run.failure);
    csv_.end_row();
  }

 private:
  CsvFile csv_;
};

std::vector<std::string> row(const StabilityRun& run) {
  std::vector<std::string> cells = {case_name(run), run.formulation};
  if (!run.is_ok()) {
    cells.push_back("failed");
    return cells;
  }
  cells.insert(cells.end(), {"ok", magnitude(run.position_drift), magnitude(run.velocity_drift),
                             magnitude(run.energy_error), std::to_string(run.steps),
                             fmt::format("{:.2f}", run.iterations_per_step()),
                             magnitude(run.condition), duration(run.seconds)});
  return cells;
}

std::string runs_text(const std::vector<StabilityRun>& runs) {
  Table table({{"case", Table::Align::left},
               {"formulation", Table::Align::left},
               {"result", Table::Align::left},
               {"position drift"},
               {"velocity drift"},
               {"energy error"},
               {"steps"},
               {"iterations a step"},
               {"condition"},
               {"time"}},
              2);
  for (const StabilityRun& run : runs) table.add_row(row(run));
  return table.text();
}

std::string failures_text(const std::vector<StabilityRun>& runs) {
  std::string text;
  for (const StabilityRun& run : runs) {
    if (run.is_ok()) continue;
    text += fmt::format("{}, {}: {}\n", case_name(run), run.formulation, run.failure);
  }
  return text.empty() ? text : "\n" + text;
}

std::string doubts_text(const std::vector<StabilityRun>& runs) {
  SharedWarnings warnings;
  for (const StabilityRun& run : runs) {
    warnings.add(run.warnings, case_name(run) + ", " + run.formulation);
  }
  const std::string text = warnings_text(warnings.sentences());
  return text.empty() ? "" : "\n" + text;
}

/// @param all   runs
/// @param keep  what shall become of each
std::vector<StabilityRun> run_all(const Arguments& arguments, std::size_t all,
                                  const StabilityObserver& keep) {
  ProgressLine progress(arguments, fmt::format("0 of {} runs", all));
  std::size_t done = 0;
  return stability_study(
      arguments.files, arguments.overrides,
      [&](const StabilityRun& run) {
        keep(run);
        ++done;
        progress.print(fmt::format("  {}, {}: {}", case_name(run), run.formulation,
                                   run.is_ok() ? duration(run.seconds) : "failed"));
        progress.show_share(fmt::format("{} of {} runs", done, all), double(done) / double(all));
      },
      arguments.load_case);
}

}  // namespace

Outcome run_stability(const Arguments& arguments) {
  const std::vector<ProblemInput> inputs = read_inputs(arguments);
  RunRecord record(arguments, inputs, Json::object());
  record.begin_phase("stability");
  std::optional<StabilityCsv> csv;  // with the first result
  SharedWarnings before;
  for (const ProblemInput& input : inputs) {
    before.add(texts_of(find_doubts_before(input.problem)), input.problem.name);
  }
  show(stderr, warnings_text(before.sentences()));
  const std::size_t all =
      inputs.size() * (compared_formulations().size() + compared_schemes().size());
  const std::vector<StabilityRun> runs = run_all(arguments, all, [&](const StabilityRun& run) {
    if (!csv) csv.emplace(record.result("stability.csv"));
    csv->add(run);
  });
  const bool is_whole = runs.size() == all;
  Outcome outcome{is_whole ? ExitCode::done : ExitCode::not_verified, make_document(runs, is_whole),
                  (is_whole ? "" : interrupted_text(runs.size(), all, "runs")) + runs_text(runs) +
                      failures_text(runs) + doubts_text(runs)};
  outcome.text += fmt::format("\nWritten to {}: stability.csv, result.json, run_card.json\n",
                              record.folder().string());
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
