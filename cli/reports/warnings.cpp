#include "cli/reports/warnings.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/trust/checks.hpp"

namespace pleuel {

std::string warnings_text(const std::vector<std::string>& warnings, int consequences) {
  std::string text;
  for (std::size_t i = 0; i + consequences < warnings.size(); ++i) {
    text += wrapped("Warning: " + warnings[i], "  ") + "\n";
  }
  if (consequences == 0) return text;
  return text + fmt::format("  and {} that may follow from this (--all-warnings)\n",
                            consequences == 1 ? "one more" : fmt::format("{} more", consequences));
}

void show_warnings_before(const ProblemFile& problem) {
  show(stderr, warnings_text(texts_of(check_before(problem))));
}

void SharedWarnings::add(const std::vector<std::string>& warnings, const std::string& whose) {
  for (const std::string& warning : warnings) {
    const auto known = std::find_if(warnings_.begin(), warnings_.end(),
                                    [&](const auto& entry) { return entry.first == warning; });
    if (known == warnings_.end()) {
      warnings_.emplace_back(warning, whose);
    } else {
      known->second += ", " + whose;
    }
  }
}

std::vector<std::string> SharedWarnings::sentences() const {
  std::vector<std::string> sentences;
  for (const auto& [warning, whose] : warnings_) {
    sentences.push_back(fmt::format("{} ({})", warning, whose));
  }
  return sentences;
}

void add_new(std::vector<std::string>& warnings, const std::vector<std::string>& more) {
  for (const std::string& warning : more) {
    const bool is_known = std::find(warnings.begin(), warnings.end(), warning) != warnings.end();
    if (!is_known) warnings.push_back(warning);
  }
}

}  // namespace pleuel
