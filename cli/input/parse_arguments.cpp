#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/input/command_table.hpp"
#include "cli/input/fingerprint.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/scene/reading/suggestion.hpp"

namespace pleuel {

namespace {

/// Where the library begins what it says of an option.
constexpr std::size_t help_column = 30;

constexpr const char* footer = R"(
Every command that takes a problem also takes --set (repeatable) and --json.
Exit codes: 0 done, 2 bad input, 3 simulation failed, 4 ended without a verified optimum,
interrupted, or a design of simulate --design breaks a limit, 1 a result that could not be
written, or a fault of the program.)";

/// What a command does and an example of it: the end of its --help.
std::string help_text(const CommandKind& command) {
  return wrapped(fmt::format("\n{}\n\nExample:\n  pleuel {}", command.does, command.example));
}

/// Declares options of one command.
class OptionAdder {
 public:
  OptionAdder(CLI::App& command, Arguments& arguments) : command_(command), arguments_(arguments) {}

  void add(const OptionKind& kind) {
    kind_ = &kind;
    CLI::Option* option = std::visit(*this, kind.target);
    if (*kind.type != '\0') option->type_name(kind.type);
    if (kind.limit != nullptr) kind.limit(*option);
  }

  CLI::Option* operator()(bool Arguments::*flag) const {
    return command_.add_flag(kind_->flags, arguments_.*flag, kind_->description);
  }
  CLI::Option* operator()(Scrutiny scrutiny) const {
    return command_.add_flag_callback(
        kind_->flags, [&all = arguments_, scrutiny] { all.scrutiny = scrutiny; },
        kind_->description);
  }
  template <class Value>
  CLI::Option* operator()(Value Arguments::*value) const {
    return command_.add_option(kind_->flags, arguments_.*value, kind_->description);
  }

 private:
  CLI::App& command_;
  Arguments& arguments_;
  const OptionKind* kind_ = nullptr;
};

void add_commands(CLI::App& app, Arguments& arguments) {
  for (const CommandKind& kind : command_kinds()) {
    CLI::App* command = app.add_subcommand(kind.name, kind.description);
    command->footer(help_text(kind));
    OptionAdder adder(*command, arguments);
    for (const OptionKind& option : kind.options) adder.add(option);
  }
}

/// A misspelt command deserves better than "not expected".
void check_command_name(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty() || words.front().starts_with("-")) return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (std::ranges::find(known, words.front()) != known.end()) return;
  throw InputError(
      fmt::format("there is no command \"{}\"{}", words.front(), hint(words.front(), known)));
}

/// "; did you mean --accuracy?" of the first option that the command does not have.
std::string option_hint(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = nullptr;
  for (const CLI::App* one : app.get_subcommands({})) {
    if (!words.empty() && one->get_name() == words.front()) command = one;
  }
  if (command == nullptr) return "";
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || command->get_option_no_throw(name) != nullptr) continue;
    const std::string meant = closest(name, known);
    return meant.empty() ? "" : fmt::format("; did you mean {}?", meant);
  }
  return "";
}

/// What the environment says in place of --jobs.
void take_jobs_of_environment(Arguments& arguments) {
  const char* text = std::getenv("PLEUEL_JOBS");
  if (text == nullptr || *text == '\0') return;
  const char* end = text + std::strlen(text);
  const auto [rest, error] = std::from_chars(text, end, arguments.jobs);
  if (error != std::errc() || rest != end || arguments.jobs < 1 || arguments.jobs > 1024) {
    throw InputError(fmt::format(
        "the environment variable PLEUEL_JOBS must be a whole number from 1 to 1024, got \"{}\"",
        text));
  }
  arguments.gives_jobs = true;
}

/// Who writes "--accuracy 0.1" may mean 10 % or 0.1 %: such numbers need their "%".
void check_accuracy(const std::string& text) {
  constexpr double ambiguous = 0.02;
  double ratio = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, ratio);
  if (error != std::errc() || rest != end || ratio < ambiguous) return;
  throw InputError(
      ratio < 1.0
          ? fmt::format(
                "--accuracy {0} is a ratio, {1:g} %: write --accuracy {0}% for {0} percent, "
                "or --accuracy {1:g}% if that is what you mean",
                text, 100.0 * ratio)
          : fmt::format(
                "--accuracy {0} is a ratio and has to be below 1; write --accuracy {0}% for "
                "{0} percent",
                text));
}

}  // namespace

std::optional<Arguments> parse_arguments(int argc, const char* const* argv) {
  Arguments arguments;
  take_jobs_of_environment(arguments);
  arguments.program = argc > 0 ? argv[0] : "pleuel";
  arguments.words.assign(argv + std::min(argc, 1), argv + argc);
  std::vector<std::string> words = arguments.words;
  if (!words.empty() && words.front() == "help") {  // help COMMAND
    words.erase(words.begin());
    words.push_back("--help");
  }
  CLI::App app("Pleuel: gradient-based design optimization of flexible mechanisms",
               arguments.program);
  app.footer(footer);
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  add_commands(app, arguments);
  check_command_name(app, words);
  try {
    std::ranges::reverse(words);  // as the library wants them
    app.parse(words);
  } catch (const CLI::Success& success) {
    std::ostringstream text;
    app.exit(success, text);
    write_all(stdout, wrapped(text.str(), std::string(help_column, ' ')));
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    const bool has_command = !arguments.words.empty() && !arguments.words.front().starts_with("-");
    const bool is_unknown = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    const std::string meant = is_unknown ? option_hint(app, arguments.words) : "";
    throw InputError(fmt::format("{}{}; see {}{} --help", error.what(), meant, arguments.program,
                                 has_command ? " " + arguments.words.front() : ""));
  }
  const double step = arguments.difference_step.value_or(0.5);
  if (!(step > 0.0 && step < 1.0)) {
    throw InputError(fmt::format("--step must be greater than 0 and less than 1, got {:g}", step));
  }
  const CLI::App* command = app.get_subcommands().front();
  arguments.command = command->get_name();
  const CLI::Option* jobs = command->get_option_no_throw("--jobs");
  if (jobs != nullptr && jobs->count() > 0) arguments.gives_jobs = true;
  if (arguments.accuracy) {
    check_accuracy(*arguments.accuracy);
    arguments.overrides.push_back("/accuracy/target=" + *arguments.accuracy);
  }
  if (arguments.gap) arguments.overrides.push_back("/pareto/gap=" + *arguments.gap);
  return arguments;
}

}  // namespace pleuel
