#pragma once

#include <cctype>
#include <functional>
#include <sstream>
#include <type_traits>

#include "tests/support/test.hpp"

/// Words for the parameter of a test: letters and digits of a text, the rest as underscores.
inline std::string as_name(const std::string& text) {
  constexpr std::size_t longest = 60;
  std::string name;
  for (const char c : text) {
    if (name.size() == longest) break;
    if (std::isalnum(static_cast<unsigned char>(c))) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

/// Names tests by a part of their parameters (a member, or a function of them) that can be written
/// to a stream, and their number, since parts may be equal: for INSTANTIATE_TEST_SUITE_P.
template <class Part>
auto named_by(Part part) {
  return [part](const auto& test) {
    std::ostringstream text;
    text << std::invoke(part, test.param);
    const std::string name = as_name(text.str()), number = std::to_string(test.index + 1);
    return name.empty() ? number : name + "_" + number;
  };
}

/// Names tests by what gtest prints of their parameters, and their number.
inline auto named_as_printed() {
  return named_by([](const auto& param) { return testing::PrintToString(param); });
}

/// Names tests by their parameters: numbers and texts.
inline auto named_by_value() {
  return named_by([](const auto& param) { return param; });
}
