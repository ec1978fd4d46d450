#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pleuel {

/// Whether each row of a table of kinds stands where the value of its `type` says.
template <class Kind, std::size_t count>
constexpr bool are_in_order(const Kind (&kinds)[count]) {
  for (std::size_t i = 0; i < count; ++i) {
    if (static_cast<std::size_t>(kinds[i].type) != i) return false;
  }
  return true;
}

/// A word a user can choose, and what it means here. One table of them serves who reads and who
/// prints.
template <class Meaning>
struct Choice {
  std::string_view word;
  Meaning meaning;
};

/// The word for a meaning; empty if there is none.
template <class Meaning, std::size_t count>
std::string word_of(const Choice<Meaning> (&choices)[count], Meaning meaning) {
  for (const Choice<Meaning>& choice : choices) {
    if (choice.meaning == meaning) return std::string(choice.word);
  }
  return "";
}

/// Names of materials, bodies, joints, … in their order.
template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& things) {
  std::vector<std::string> names;
  for (const Named& thing : things) names.push_back(thing.name);
  return names;
}

}  // namespace pleuel
