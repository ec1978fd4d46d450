#include "cli/files/command_text.hpp"

#include "cli/files/run_folder.hpp"
#include "core/scene/reading/override.hpp"

namespace pleuel {

namespace {

/// By its pointer: the value of a variable that is called by its name would take the place of that
/// in a file of --design.
std::string with_pointer(const std::string& assignment) {
  return assigned_pointer(assignment) + assignment.substr(assignment.find('='));
}

}  // namespace

std::string shell_word(const std::string& word) {
  constexpr const char* harmless =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./=:,@%";
  if (!word.empty() && word.find_first_not_of(harmless) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string typed_command(const Arguments& arguments) {
  std::string text = shell_word(arguments.program);
  for (const std::string& word : arguments.words) {
    if (word != "--overwrite") text += " " + shell_word(word);
  }
  return text;
}

std::string command_on(const std::string& command, const Arguments& arguments,
                       const fs::path& file) {
  return shell_word(arguments.program) + " " + command + " " + shell_word(file.string());
}

std::string command_at(const std::string& command, const Arguments& arguments,
                       const fs::path& design) {
  std::string text = command_on(command, arguments, arguments.file);
  for (const std::string& assignment : arguments.overrides) {
    text += " --set " + shell_word(with_pointer(assignment));
  }
  if (arguments.allows_programs) text += " --allow-programs";
  if (command != "simulate") {
    for (const std::string& method : arguments.methods) text += " --method " + method;
  }
  if (command == "optimize" && arguments.backend) text += " --backend " + *arguments.backend;
  if (command == "optimize" && arguments.output) {
    text += " -o " + shell_word(free_folder(*arguments.output).string());
  }
  return text + " --design " + shell_word(design.string());
}

}  // namespace pleuel
