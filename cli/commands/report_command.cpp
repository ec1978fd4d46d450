#include "cli/commands/commands.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_folder.hpp"

/// Reports of earlier runs: what is shown of the mechanism is simulated again from the run card.
namespace pleuel {

namespace {

/// @returns what the user is told
std::string make_report(const fs::path& folder, WriteFailures& failures) {
  const OlderRun run = read_older_run(folder);
  if (const std::string damage = damage_of(run); !damage.empty()) throw InputError(damage);
  Json picture;
  Notes notes;
  try {
    picture = picture_of_run(run, notes);
  } catch (const std::exception& error) {
    notes.push_back(fmt::format("the mechanism is not shown: {}", error.what()));
  }
  if (!run.card.value("finished", true)) {
    notes.push_back("the run did not come to its end: what it had written is shown");
  }
  std::string text;
  if (write_page({folder / report_name, &failures},
                 report_data(run.card, run.result, picture, folder))) {
    text = fmt::format("Report: {}\n", (folder / report_name).string());
  }
  for (const std::string& note : notes) text += wrapped("Note: " + note + "\n", "  ");
  return text;
}

}  // namespace

Outcome run_report(const Arguments& arguments) {
  if (!find_report_template()) throw InputError(no_template);
  Outcome outcome;
  outcome.document = {{"reports", Json::array()}};
  WriteFailures failures;
  for (const fs::path& folder : arguments.files) {
    outcome.text += make_report(folder, failures);
    const std::string report = (folder / report_name).string();
    const auto& failed = failures.files();
    if (std::ranges::find(failed, report) == failed.end()) {
      outcome.document["reports"].push_back(report);
    }
  }
  outcome.unwritten = failures.files();
  return outcome;
}

}  // namespace pleuel
