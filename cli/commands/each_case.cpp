#include "cli/commands/each_case.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/input/fingerprint.hpp"
#include "cli/reports/case_report.hpp"
#include "cli/text/console.hpp"
#include "core/base/error.hpp"
#include "core/scene/reading/document_reader.hpp"
#include "core/scene/reading/text_file.hpp"

namespace pleuel {

namespace {

constexpr std::array commands = {"simulate", "check", "gradient", "show"};

std::vector<std::string> case_names(const Arguments& arguments) {
  const Json document = overridden_document(
      {read_text_file(arguments.file), arguments.file.string(), arguments.overrides});
  std::vector<std::string> names;
  for (const CaseChanges& one : cases_of(document, arguments.file.string())) {
    names.push_back(one.name);
  }
  return names;
}

}  // namespace

bool asks_for_each_case(const Arguments& arguments) {
  const bool is_such =
      std::find(commands.begin(), commands.end(), arguments.command) != commands.end();
  return is_such && !arguments.load_case && !case_names(arguments).empty();
}

Outcome run_each_case(const Arguments& arguments, Outcome (*command)(const Arguments&)) {
  Outcome all;
  all.document = {{"cases", Json::object()}};
  const std::vector<std::string> names = case_names(arguments);
  for (const std::string& name : names) {
    Arguments one = arguments;
    one.load_case = name;
    if (arguments.output) one.output = *arguments.output / plain_file_name(name);
    const Outcome outcome = command(one);
    all.document["cases"][name] = outcome.document;
    all.text +=
        fmt::format("{}Case \"{}\"\n\n{}", all.text.empty() ? "" : "\n", name, outcome.text);
    all.exit_code = std::max(all.exit_code, outcome.exit_code);
    all.unwritten.insert(all.unwritten.end(), outcome.unwritten.begin(), outcome.unwritten.end());
  }
  return all;
}

}  // namespace pleuel
