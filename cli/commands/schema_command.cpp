#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/files/starters.hpp"

namespace pleuel {

Outcome run_schema(const Arguments& arguments) {
  if (arguments.file.empty()) {
    return {ExitCode::done, Json::parse(problem_schema()), problem_schema()};
  }
  write_given_file(arguments.file, problem_schema(), arguments);
  const std::string text =
      fmt::format("Written: {}\nA problem file beside it names it by  \"$schema\": \"{}\"\n",
                  arguments.file.string(), arguments.file.filename().string());
  return {ExitCode::done, {{"file", arguments.file.string()}}, text};
}

}  // namespace pleuel
