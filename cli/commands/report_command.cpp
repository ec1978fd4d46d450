#include "cli/commands/commands.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_folder.hpp"

/// Reports of earlier runs: what is shown of the mechanism is simulated again from the run card.
namespace pleuel {

namespace {

void make_report(const fs::path& folder, Outcome& outcome) {
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
  const std::string page = (folder / report_name).string();
  if (write_page({page, &outcome.unwritten}, report_data(run.card, run.result, picture, folder))) {
    outcome.text += fmt::format("Report: {}\n", page);
    outcome.document["reports"].push_back(page);
  }
  for (const std::string& note : notes) outcome.text += wrapped("Note: " + note + "\n", "  ");
}

}  // namespace

Outcome run_report(const Arguments& arguments) {
  if (!find_report_template()) throw InputError(no_template);
  Outcome outcome;
  outcome.document = {{"reports", Json::array()}};
  for (const fs::path& folder : arguments.files) make_report(folder, outcome);
  return outcome;
}

}  // namespace pleuel
