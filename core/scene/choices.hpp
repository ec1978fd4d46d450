#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pleuel {

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

}  // namespace pleuel
