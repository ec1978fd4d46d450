#include <map>

#include "cli/commands/commands.hpp"
#include "cli/commands/older_picture.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_folder.hpp"

/// Reports of earlier runs: what is shown of the mechanism is simulated again from the run card.
namespace pleuel {

namespace {

Json read_document(const fs::path& path) {
  if (!fs::is_regular_file(path)) {
    throw InputError(
        fmt::format("{}: there is no such file: not the folder of a finished run", path.string()));
  }
  Json document = document_in(path);
  if (document.is_null()) throw InputError(path.string() + ": is not a JSON document");
  return document;
}

/// What a result has that is whole.
struct Needed {
  const char* key;
  Json::value_t type;
};

std::vector<Needed> needed_in(const std::string& command) {
  using Type = Json::value_t;
  static const std::map<std::string, std::vector<Needed>> needed = {
      {"accuracy", {{"runs", Type::array}}},
      {"check", {{"responses", Type::object}}},
      {"gradient", {{"responses", Type::object}}},
      {"optimize",
       {{"status", Type::string},
        {"objective", Type::object},
        {"variables", Type::object},
        {"constraints", Type::object}}},
      {"pareto", {{"points", Type::array}}},
      {"prices", {{"prices", Type::object}}},
      {"simulate", {{"responses", Type::object}}},
      {"stability", {{"runs", Type::array}}},
      {"uncertainty", {{"responses", Type::object}}},
  };
  const auto found = needed.find(command);
  return found == needed.end() ? std::vector<Needed>() : found->second;
}

/// @throws InputError if something is missing that the run has written
void check_whole(const OlderRun& run) {
  const auto damaged = [&](const char* file, const std::string& what) {
    return InputError(fmt::format("{}: is damaged: {}", (run.folder / file).string(), what));
  };
  const std::string command = text_at(run.card, "/command");
  if (command.empty()) throw damaged(card_name, "it names no command");
  for (const Needed& one : needed_in(command)) {
    if (run.result.value(one.key, Json()).type() != one.type) {
      throw damaged("result.json",
                    fmt::format("a run of `pleuel {}` has \"{}\" there", command, one.key));
    }
  }
  if (command != "optimize" || !run.objective()) return;
  for (const auto& [name, variable] : run.result["variables"].items()) {
    if (!number_at(variable, "/value")) {
      throw damaged("result.json", fmt::format("the variable \"{}\" has no value", name));
    }
  }
}

/// @returns what the user is told
std::string make_report(const fs::path& folder, WriteFailures& failures) {
  const OlderRun run{folder, read_document(folder / card_name),
                     read_document(folder / "result.json")};
  check_whole(run);
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
