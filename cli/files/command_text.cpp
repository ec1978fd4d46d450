#include "cli/files/command_text.hpp"

namespace pleuel {

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

}  // namespace pleuel
