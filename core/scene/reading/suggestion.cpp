#include "core/scene/reading/suggestion.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/scene/reading/other_names.hpp"

namespace pleuel {
namespace {

/// Words longer than this are not compared: nobody misspells a paragraph.
constexpr std::size_t longest_word = 100;

/// Small letters, and "-" between words.
std::string plain(std::string_view word) {
  std::string result(word);
  for (char& letter : result) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    if (letter == '_' || letter == ' ' || letter == '\'') letter = '-';
  }
  return result;
}

bool is_called(std::string_view candidate, std::string_view name) {
  return candidate.starts_with(name) &&
         (candidate.size() == name.size() || candidate[name.size()] == '-');
}

/// The known word that others call so, or an empty string.
std::string by_other_name(std::string_view word, const std::vector<std::string>& known) {
  const std::string sought = plain(word);
  for (const std::string& candidate : known) {
    if (plain(candidate) == sought) return candidate;
  }
  for (const auto& [other, name] : other_names) {
    if (other != sought) continue;
    for (const std::string& candidate : known) {
      if (is_called(candidate, name)) return candidate;
    }
  }
  return "";
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), current(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, replaced});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) current[j] = std::min(current[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = current;
  }
  return last[b.size()];
}

std::string closest(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = longest_word;
  if (word.size() > longest_word) return best;
  for (const std::string& candidate : known) {
    const std::size_t length = std::max(word.size(), candidate.size());
    if (length > longest_word) continue;
    const std::size_t distance = edit_distance(word, candidate);
    const bool is_near = distance < length && 3 * distance <= std::max<std::size_t>(length, 3);
    if (is_near && distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string meant_by(std::string_view word, const std::vector<std::string>& known) {
  const std::string name = word.size() > longest_word ? "" : by_other_name(word, known);
  return name.empty() ? closest(word, known) : name;
}

std::string quoted_list(const std::vector<std::string>& words, std::string_view conjunction) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) list += i + 1 == words.size() ? fmt::format(" {} ", conjunction) : ", ";
    list += fmt::format("\"{}\"", words[i]);
  }
  return list;
}

std::string hint(std::string_view word, const std::vector<std::string>& known) {
  if (known.empty()) return "; there are none";
  const std::string meant = meant_by(word, known);
  if (!meant.empty()) return fmt::format("; did you mean \"{}\"?", meant);
  return fmt::format("; known {} {}", known.size() == 1 ? "is" : "are", quoted_list(known, "and"));
}

}  // namespace pleuel
