#include <functional>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/files/starters.hpp"
#include "cli/input/parse_arguments.hpp"
#include "core/base/error.hpp"
#include "core/scene/sensitivity_settings.hpp"
#include "optimization/backends.hpp"

/// Completion for shells, from the commands and options as they are declared.
namespace pleuel {

namespace {

/// What an option or a positional argument takes, where that is one of a few words.
std::vector<std::string> choices_of(const std::string& option) {
  if (option == "--backend") return optimizer_names();
  if (option == "SHELL") return {"bash", "zsh"};
  std::vector<std::string> words;
  if (option == "--method") {
    for (const auto& [word, method] : gradient_methods) words.emplace_back(word);
  }
  if (option == "KIND") {
    for (const Starter& starter : starters()) words.push_back(starter.kind);
  }
  return words;
}

std::vector<std::string> option_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

/// The words that may stand where a command has its first positional argument.
std::vector<std::string> first_words(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) return choices_of(option->get_name());
  }
  return {};
}

/// For a shell within single quotes.
std::string within_quotes(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) {
    text.replace(at, 1, "'\\''");
  }
  return text;
}

std::string bash_case(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option_names(*option)) words += " " + name;
  }
  return fmt::format("    {}) options='{}'; first='{}' ;;\n", command.get_name(), words.substr(1),
                     fmt::join(first_words(command), " "));
}

std::string bash_script(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    names += (names.empty() ? "" : " ") + command->get_name();
    cases += bash_case(*command);
  }
  return fmt::format(R"(# In ~/.bashrc:  source <(…/pleuel completion bash)
_pleuel() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} options='--help --version' first=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '{}' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[COMP_CWORD-1]}} in
    --backend) COMPREPLY=($(compgen -W '{}' -- "$word")); return ;;
    --method) COMPREPLY=($(compgen -W '{}' -- "$word")); return ;;
  esac
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [ "$COMP_CWORD" -eq 2 ] && [ -n "$first" ]; then
    COMPREPLY=($(compgen -W "$first" -- "$word"))
  fi
}}
complete -o default -F _pleuel pleuel
)",
                     names, fmt::join(choices_of("--backend"), " "),
                     fmt::join(choices_of("--method"), " "), cases);
}

/// One word of zsh's _describe: name and what it means.
std::string described(const std::string& name, const std::string& description) {
  return fmt::format(" '{}:{}'", name, within_quotes(description));
}

std::string zsh_case(const CLI::App& command) {
  std::string options, first;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option_names(*option)) {
      options += described(name, option->get_description());
    }
  }
  for (const std::string& word : first_words(command)) first += " " + word;
  return fmt::format("    {}) options=({} ); first=({} ) ;;\n", command.get_name(), options, first);
}

std::string zsh_script(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    names += described(command->get_name(), command->get_description());
    cases += zsh_case(*command);
  }
  return fmt::format(R"(#compdef pleuel
# In ~/.zshrc, behind compinit:  source <(…/pleuel completion zsh)
_pleuel() {{
  local -a commands options first
  commands=({} )
  if (( CURRENT == 2 )); then _describe command commands; return; fi
  case $words[CURRENT-1] in
    --backend) compadd {}; return ;;
    --method) compadd {}; return ;;
  esac
  case $words[2] in
{}  esac
  if [[ $words[CURRENT] == -* ]]; then _describe option options; return; fi
  if (( CURRENT == 3 && $#first )); then compadd $first; return; fi
  _files
}}
compdef _pleuel pleuel
)",
                     names, fmt::join(choices_of("--backend"), " "),
                     fmt::join(choices_of("--method"), " "), cases);
}

}  // namespace

Outcome run_completion(const Arguments& arguments) {
  const std::map<std::string, std::function<std::string(const CLI::App&)>> shells = {
      {"bash", bash_script}, {"zsh", zsh_script}};
  const auto shell = shells.find(*arguments.kind);
  if (shell == shells.end()) {
    throw InputError(
        fmt::format("there is no completion for \"{}\"; known are bash, zsh", *arguments.kind));
  }
  CLI::App app;
  Arguments declared;
  add_commands(app, declared);
  const std::string script = shell->second(app);
  return {ExitCode::done, {{"script", script}}, script};
}

}  // namespace pleuel
