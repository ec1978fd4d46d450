#include <sstream>

#include "cli/commands/commands.hpp"
#include "cli/files/command_text.hpp"
#include "cli/files/starters.hpp"
#include "cli/input/command_table.hpp"
#include "optimization/backends.hpp"
#include "sensitivity/gradients.hpp"

/// Completion for shells, from the table of commands and options.
namespace pleuel {

namespace {

/// A word with what it means.
using ShownWord = std::string (*)(const std::string& word, const std::string& meaning);

struct Shell {
  ShownWord shown;
  /// With room for the commands, the cases with what stands behind each, backends and methods.
  const char* script;
};

const Shell bash{[](const std::string& word, const std::string&) { return " " + word; },
                 R"(# In ~/.bashrc:  source <(…/pleuel completion bash)
_pleuel() {{
  local commands options first words word=${{COMP_WORDS[COMP_CWORD]}}
  commands=({} )
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $COMP_CWORD:${{COMP_WORDS[COMP_CWORD-1]}}:$word in
    1:*) words=("${{commands[@]}}") ;;
    *:--backend:*) words=({}) ;;
    *:--method:*) words=({}) ;;
    *:*:-*) words=("${{options[@]}}") ;;
    2:*) words=("${{first[@]}}") ;;
  esac
  COMPREPLY=($(compgen -W "${{words[*]}}" -- "$word"))
}}
complete -o default -F _pleuel pleuel
)"};

const Shell zsh{[](const std::string& word, const std::string& meaning) {
                  return " " + shell_word(word + ":" + meaning);
                },
                R"(#compdef pleuel
# In ~/.zshrc, behind compinit:  source <(…/pleuel completion zsh)
_pleuel() {{
  local -a commands options first
  commands=({} )
  case $words[2] in
{}  esac
  case $CURRENT:$words[CURRENT-1]:$words[CURRENT] in
    2:*) _describe command commands ;;
    *:--backend:*) compadd {} ;;
    *:--method:*) compadd {} ;;
    *:*:-*) _describe option options ;;
    *) if (( CURRENT == 3 && $#first )); then compadd $first; else _files; fi ;;
  esac
}}
compdef _pleuel pleuel
)"};

/// What an option or a positional argument takes, where that is one of a few words.
std::vector<std::string> choices_of(const std::string& option) {
  std::vector<std::string> words;
  if (option == "--backend") words = optimizer_names();
  if (option == "SHELL") words = {"bash", "zsh"};
  if (option == "--method") {
    for (const auto& [word, method] : gradient_methods) words.emplace_back(word);
  }
  if (option == "KIND") {
    for (const Starter& starter : starters()) words.push_back(starter.kind);
  }
  return words;
}

/// The options of a command, and what may stand where it has its first positional argument.
std::string case_of(const CommandKind& command, ShownWord shown) {
  std::string options = shown("--help", "what the command does"), first;
  for (const OptionKind& option : command.options) {
    std::istringstream names(option.flags);
    for (std::string name; std::getline(names, name, ',');) {
      if (name.starts_with("-")) options += shown(name, option.description);
    }
    for (const std::string& word : choices_of(option.flags)) first += " " + word;
  }
  return fmt::format("    {}) options=({} ); first=({} ) ;;\n", command.name, options, first);
}

std::string script_of(const Shell& shell) {
  std::string commands, cases;
  for (const CommandKind& command : command_kinds()) {
    commands += shell.shown(command.name, command.description);
    cases += case_of(command, shell.shown);
  }
  return fmt::format(fmt::runtime(shell.script), commands, cases,
                     fmt::join(choices_of("--backend"), " "),
                     fmt::join(choices_of("--method"), " "));
}

}  // namespace

Outcome run_completion(const Arguments& arguments) {
  static const std::map<std::string, Shell> shells = {{"bash", bash}, {"zsh", zsh}};
  const auto shell = shells.find(*arguments.kind);
  if (shell == shells.end()) {
    throw InputError(
        fmt::format("there is no completion for \"{}\"; known are bash, zsh", *arguments.kind));
  }
  const std::string script = script_of(shell->second);
  return {ExitCode::done, {{"script", script}}, script};
}

}  // namespace pleuel
