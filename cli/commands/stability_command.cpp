#include "cli/commands/commands.hpp"
#include "studies/stability.hpp"

namespace pleuel {

namespace {

std::string case_name(const Json& run) {
  return fs::path(text_at(run, "/file")).stem().string();
}

/// "pump, index-1": of an entry of "runs".
std::string run_name(const Json& run) {
  return case_name(run) + ", " + text_at(run, "/formulation");
}

Json stability_entry(const StabilityRun& run) {
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
  Json document = {{"status", study_status(is_whole)}};
  document["formulations"] = list_of(compared_formulations(), &ComparedFormulation::name);
  document["runs"] = list_of(runs, stability_entry);
  return document;
}

std::string runs_text(const Json& runs) {
  const auto result = [](const std::string&, const Json& run) {
    return run.contains("failure") ? "failed" : "ok";
  };
  const auto iterations = [](const std::string&, const Json& run) -> std::string {
    const auto steps = number_at(run, "/work/steps");
    return steps ? fmt::format("{:.2f}", *number_at(run, "/work/newton_iterations") / *steps) : "–";
  };
  return table_of(runs,
                  {{"case", [](const std::string&, const Json& run) { return case_name(run); },
                    Table::Align::left},
                   text_column("formulation", "/formulation"),
                   {"result", result, Table::Align::left},
                   number_column("position drift", "/position_drift", magnitude),
                   number_column("velocity drift", "/velocity_drift", magnitude),
                   number_column("energy error", "/energy_error", magnitude),
                   number_column("steps", "/work/steps", whole_number),
                   {"iterations a step", iterations},
                   number_column("factorizations", "/work/factorizations", whole_number),
                   number_column("condition", "/condition", magnitude)},
                  2)
      .text();
}

std::string failures_text(const Json& runs) {
  std::string text;
  for (const Json& run : runs) {
    if (!run.contains("failure")) continue;
    text += fmt::format("{}: {}\n", run_name(run), text_at(run, "/failure"));
  }
  return text.empty() ? text : "\n" + text;
}

std::string findings_text(const Json& runs) {
  SharedWarnings warnings;
  for (const Json& run : runs) {
    warnings.add(run.value("warnings", std::vector<std::string>()), run_name(run));
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
        progress.print(fmt::format("  {}: {}", run_name(stability_entry(run)),
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
  std::optional<DocumentCsv> csv;  // with the first result
  SharedWarnings before;
  for (const ProblemInput& input : inputs) {
    before.add(texts_of(check_before(input.problem)), input.problem.name);
  }
  show(stderr, warnings_text(before.sentences()));
  const std::size_t all = inputs.size() * compared_formulations().size();
  const std::vector<StabilityRun> runs = run_all(arguments, all, [&](const StabilityRun& run) {
    if (!csv)
      csv.emplace(record.result("stability.csv"),
                  columns_at({"/file", "/formulation", "/work/steps", "/work/newton_iterations",
                              "/work/factorizations", "/position_drift", "/velocity_drift",
                              "/energy_error", "/condition", "/seconds", "/failure"}));
    csv->add(stability_entry(run));
  });
  const bool is_whole = runs.size() == all;
  Outcome outcome{is_whole ? ExitCode::done : ExitCode::not_verified, make_document(runs, is_whole),
                  is_whole ? "" : interrupted_text(runs.size(), all, "runs")};
  const Json& entries = outcome.document["runs"];
  outcome.text += runs_text(entries) + failures_text(entries) + findings_text(entries) + "\n";
  record.finish(outcome);
  return outcome;
}

}  // namespace pleuel
