#include "core/scene/reading/unit_scanner.hpp"

#include <cctype>
#include <charconv>
#include <cmath>

namespace pleuel {

namespace {

std::size_t skip_blanks(std::string_view text, std::size_t at) {
  while (at < text.size() && text[at] == ' ') ++at;
  return at;
}

/// Letters, "%" and "°"; no digits, which are powers.
std::size_t word_end(std::string_view text, std::size_t at) {
  while (at < text.size() && (text[at] == '%' || is_name_character(text[at])) &&
         !is_digit_character(text[at])) {
    ++at;
  }
  return at;
}

std::size_t digits_end(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit_character(text[at])) ++at;
  return at;
}

/// Behind "^2", "^-1" or "2".
std::size_t power_end(std::string_view text, std::size_t at) {
  const std::size_t plain = digits_end(text, at);
  if (plain > at) return plain;
  std::size_t next = skip_blanks(text, at);
  if (next >= text.size() || text[next] != '^') return at;
  next = skip_blanks(text, next + 1);
  const bool is_signed = next < text.size() && (text[next] == '-' || text[next] == '+');
  const std::size_t digits = is_signed ? next + 1 : next, end = digits_end(text, digits);
  const bool goes_on =
      end < text.size() && (text[end] == '.' || text[end] == '^' || is_name_character(text[end]));
  return end == digits || goes_on ? at : end;
}

}  // namespace

bool is_name_character(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || c == '_' || std::isalnum(byte) != 0;
}

bool is_digit_character(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string trimmed(std::string_view text, std::string_view covers) {
  const std::size_t first = text.find_first_not_of(covers);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(covers) - first + 1));
}

std::optional<double> plain_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool has_word(const std::string& text, const std::string& word) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_name_character(text[at - 1]);
    if (begins && (end == text.size() || !is_name_character(text[end]))) return true;
  }
  return false;
}

std::size_t unit_length(std::string_view text,
                        const std::function<bool(const std::string&)>& is_unit) {
  std::size_t end = 0, at = skip_blanks(text, 0);
  while (true) {
    const std::size_t word = word_end(text, at);
    if (word == at) return end;
    end = power_end(text, word);
    const std::size_t next = skip_blanks(text, end);
    if (next < text.size() && text[next] == '/') {
      at = skip_blanks(text, next + 1);
      const std::string name(text.substr(at, word_end(text, at) - at));
      if (name.empty() || !is_unit(name)) return end;
    } else {
      at = next;
    }
  }
}

}  // namespace pleuel
