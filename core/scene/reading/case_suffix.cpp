#include "core/scene/reading/case_suffix.hpp"

#include "core/scene/load_cases.hpp"
#include "core/scene/reading/unit_scanner.hpp"

namespace pleuel {

std::optional<CaseSuffix> case_suffix(std::string_view text, std::size_t at) {
  const std::size_t open = text.find_first_not_of(' ', at);
  if (open == std::string_view::npos || text[open] != '[') return std::nullopt;
  const std::size_t close = text.find(']', open);
  if (close == std::string_view::npos) return std::nullopt;
  return CaseSuffix{trimmed(text.substr(open + 1, close - open - 1)), close + 1};
}

std::optional<NameInCase> split_case(const std::string& name) {
  const std::size_t open = name.rfind('[');
  if (open == std::string::npos || open == 0 || name.back() != ']') return std::nullopt;
  return NameInCase{trimmed(std::string_view(name).substr(0, open)),
                    trimmed(std::string_view(name).substr(open + 1, name.size() - open - 2))};
}

std::string spaced_case(const std::string& name) {
  const auto split = split_case(name);
  return split ? name_in_case(split->name, split->load_case) : name;
}

}  // namespace pleuel
