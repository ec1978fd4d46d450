#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/commands/older_picture.hpp"
#include "cli/files/older_run.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_folder.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"

/// Reports of earlier runs: what is shown of the mechanism is simulated again from the run card.
namespace pleuel {

namespace {

namespace fs = std::filesystem;

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
void check_whole(const Json& card, const Json& result, const fs::path& folder) {
  const auto damaged = [&](const char* file, const std::string& what) {
    return InputError(fmt::format("{}: is damaged: {}", (folder / file).string(), what));
  };
  if (!card.contains("command") || !card["command"].is_string()) {
    throw damaged(card_name, "it names no command");
  }
  const std::string command = card["command"].get<std::string>();
  for (const Needed& one : needed_in(command)) {
    if (!result.contains(one.key) || result[one.key].type() != one.type) {
      throw damaged("result.json",
                    fmt::format("a run of `pleuel {}` has \"{}\" there", command, one.key));
    }
  }
  const bool is_optimum = command == "optimize" && result["objective"].contains("value");
  if (!is_optimum) return;
  for (const auto& [name, variable] : result["variables"].items()) {
    if (!variable.is_object() || !variable.contains("value") || !variable["value"].is_number()) {
      throw damaged("result.json", fmt::format("the variable \"{}\" has no value", name));
    }
  }
}

/// @returns what the user is told
std::string make_report(const fs::path& page, const fs::path& folder, WriteFailures& failures) {
  const Json card = read_document(folder / card_name),
             result = read_document(folder / "result.json");
  check_whole(card, result, folder);
  Json picture;
  Notes notes;
  try {
    picture = picture_of_run(card, result, folder, notes);
  } catch (const std::exception& error) {
    notes.push_back(fmt::format("the mechanism is not shown: {}", error.what()));
  }
  if (!card.value("finished", true)) {
    notes.push_back("the run did not come to its end: what it had written is shown");
  }
  std::string text;
  if (write_file({folder / report_name, &failures},
                 report_page(page, report_data(card, result, picture, folder)))) {
    text = fmt::format("Report: {}\n", (folder / report_name).string());
  }
  for (const std::string& note : notes) text += wrapped("Note: " + note + "\n", "  ");
  return text;
}

}  // namespace

Outcome run_report(const Arguments& arguments) {
  const auto page = find_report_template();
  if (!page) {
    throw InputError(
        "the template of reports is not built, which takes nodejs and npm: see docs/report.md");
  }
  Outcome outcome;
  outcome.document = {{"reports", Json::array()}};
  WriteFailures failures;
  for (const fs::path& folder : arguments.files) {
    outcome.text += make_report(*page, folder, failures);
    const std::string report = (folder / report_name).string();
    const auto& failed = failures.files();
    if (std::find(failed.begin(), failed.end(), report) == failed.end()) {
      outcome.document["reports"].push_back(report);
    }
  }
  outcome.unwritten = failures.files();
  return outcome;
}

}  // namespace pleuel
