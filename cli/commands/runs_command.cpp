#include "cli/commands/commands.hpp"

/// A table of the runs in a folder.
namespace pleuel {

namespace {

/// The folder itself, or those in it, by their names.
std::vector<OlderRun> runs_in(const fs::path& folder) {
  if (auto run = find_older_run(folder)) return {std::move(*run)};
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  std::vector<OlderRun> runs;
  for (const fs::path& one : folders) {
    if (auto run = find_older_run(one)) runs.push_back(std::move(*run));
  }
  return runs;
}

std::string table_text(const std::vector<OlderRun>& runs) {
  Table table({left_aligned("run"), left_aligned("command"), left_aligned("status"), "objective",
               left_aligned(""), "time", "date", left_aligned("problem")});
  for (const OlderRun& run : runs) {
    const auto objective = run.objective(), seconds = run.seconds();
    table.add_row({run.folder.filename().string(), run.command(), run.status(),
                   objective ? significant(*objective) : "", run.objective_unit(),
                   seconds ? duration(*seconds) : "", run.date(), run.problem()});
  }
  return table.text();
}

Json listed_run(const OlderRun& run) {
  Json document = summary_of(run);
  document["date"] = run.date();
  if (run.objective()) {
    document["objective"] = {{"name", run.result["objective"].value("name", "")},
                             {"value", *run.objective()},
                             {"unit", run.objective_unit()}};
  }
  if (run.seconds()) document["seconds"] = *run.seconds();
  return document;
}

}  // namespace

Outcome run_runs(const Arguments& arguments) {
  const fs::path folder = arguments.file.empty() ? fs::path("runs") : arguments.file;
  Outcome outcome;
  if (!fs::is_directory(folder)) {
    if (!arguments.file.empty()) {
      throw InputError(fmt::format("{}: there is no such folder", folder.string()));
    }
    outcome.document = {{"runs", Json::array()}};
    outcome.text =
        "No runs yet: commands such as optimize and simulate make them, in the folder runs.\n";
    return outcome;
  }
  std::vector<OlderRun> runs = runs_in(folder);
  if (arguments.order == "time") {
    std::ranges::stable_sort(runs, [](const OlderRun& one, const OlderRun& other) {
      return one.written() < other.written();
    });
  }
  outcome.document = {{"runs", list_of(runs, listed_run)}};
  outcome.text = runs.empty() ? fmt::format("{}: no runs\n", folder.string()) : table_text(runs);
  return outcome;
}

}  // namespace pleuel
