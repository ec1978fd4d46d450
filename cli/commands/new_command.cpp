#include "cli/commands/commands.hpp"
#include "cli/files/command_text.hpp"
#include "cli/files/starters.hpp"
#include "core/scene/reading/suggestion.hpp"

namespace pleuel {

namespace {

Outcome list_starters(const Arguments& arguments) {
  Outcome outcome;
  outcome.document = {{"kinds", Json::object()}};
  Table table({left_aligned("kind"), left_aligned("")});
  for (const Starter& starter : starters()) {
    outcome.document["kinds"][starter.kind] = starter.description;
    table.add_row({starter.kind, starter.description});
  }
  outcome.text = table.text() + fmt::format("\nTo begin with one:  {} new {} FILE.json\n",
                                            arguments.program, starters().front().kind);
  return outcome;
}

Starter find_starter(const std::string& kind) {
  const std::vector<Starter> all = starters();
  const auto found = std::ranges::find(all, kind, &Starter::kind);
  if (found != all.end()) return *found;
  throw InputError(fmt::format("there is no kind of problem \"{}\"{}", kind,
                               hint(kind, list_of(all, &Starter::kind))));
}

/// An older schema, or another file of that name, is the user's.
bool write_schema(const fs::path& path, const Arguments& arguments) {
  std::error_code error;
  if (fs::exists(path, error) && !arguments.overwrites) return false;
  write_given_file(path, problem_schema(), arguments);
  return true;
}

}  // namespace

Outcome run_new(const Arguments& arguments) {
  if (!arguments.kind) return list_starters(arguments);
  const Starter starter = find_starter(*arguments.kind);
  const fs::path file = arguments.file.empty() ? fs::path(starter.kind + ".json") : arguments.file;
  write_given_file(file, starter.text, arguments);
  const fs::path schema = file.parent_path() / schema_name;
  std::string text = fmt::format("Written: {}\n", file.string());
  if (write_schema(schema, arguments)) {
    text += fmt::format("         {}, by which editors complete and check as you type\n",
                        schema.string());
  }
  const auto width = command_on("optimize", arguments, file).size();
  const auto line = [&](const char* command, const char* what) {
    return fmt::format("  {:<{}}  {}\n", command_on(command, arguments, file), width, what);
  };
  text += "\nNext:\n" + line("show", "draws the mechanism") +
          line("check", "describes and examines it") +
          line("optimize", "finds the lightest design");
  return {ExitCode::done, {{"file", file.string()}, {"schema", schema.string()}}, text};
}

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
