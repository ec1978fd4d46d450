#include "core/scene/reading/syntax_error.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace pleuel {

namespace {

struct Complaint {
  std::size_t place;  ///< byte of the text
  std::string cause;
};

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Reads a text as JSON and stops where it is none. It knows more of what people write in its place
/// than a parser does.
class SyntaxCheck {
 public:
  explicit SyntaxCheck(const std::string& text) : text_(text) {
    if (text.starts_with("\xEF\xBB\xBF")) at_ = 3;  // byte order mark
  }

  /// Nothing, if the text is JSON as far as this sees.
  std::optional<Complaint> find() {
    while (!complaint_) {
      skip_space();
      if (at_ >= text_.size()) {
        if (expected_ != Expected::end) complain(at_, end_text());
        break;
      }
      if (!finds_foreign()) step();
    }
    return complaint_;
  }

 private:
  enum class Expected { value, first_item, key, first_key, colon, comma, end };
  struct Open {
    char bracket;
    std::size_t place;
  };

  void complain(std::size_t place, std::string cause) { complaint_ = {place, std::move(cause)}; }

  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool begins(std::string_view word) const {
    return std::string_view(text_).substr(at_).starts_with(word);
  }
  void skip_space() {
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n").find(text_[at_]) != std::string::npos) {
      ++at_;
    }
  }
  std::size_t line_of(std::size_t place) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(place, text_.size()));
    return 1 + static_cast<std::size_t>(std::count(text_.begin(), end, '\n'));
  }

  std::string end_text() const {
    if (open_.empty()) return "the text ends before the value that was announced";
    const Open& last = open_.back();
    return fmt::format(
        "the text ends here, but the \"{}\" of line {} is not closed: \"{}\" is missing",
        last.bracket, line_of(last.place), closing(last.bracket));
  }
  static char closing(char bracket) { return bracket == '{' ? '}' : ']'; }

  /// What no JSON has anywhere outside of texts.
  bool finds_foreign() {
    if (begins("//") || begins("/*") || here() == '#') {
      complain(at_,
               "JSON has no comments; objects of a problem may have a text \"$comment\" instead");
    } else if (here() == '\'') {
      complain(at_, "names and texts stand in double quotes \"…\", not in single ones");
    } else if (begins("“") || begins("”") || begins("„") || begins("‘") || begins("’")) {
      complain(at_, "names and texts stand in straight quotes \"…\", not in typographic ones");
    }
    return complaint_.has_value();
  }

  void step() {
    switch (expected_) {
      case Expected::first_item:
        if (here() == ']') return close();
        return read_value();
      case Expected::value:
        return read_value();
      case Expected::first_key:
        if (here() == '}') return close();
        return read_key();
      case Expected::key:
        return read_key();
      case Expected::colon:
        return read_colon();
      case Expected::comma:
        return read_comma();
      case Expected::end:
        return complain(at_, here() == '}' || here() == ']'
                                 ? fmt::format("this \"{}\" closes nothing: one too many", here())
                                 : "the document has ended before; nothing may follow it");
    }
  }

  // ---- values

  void read_value() {
    const char c = here();
    value_begin_ = at_;
    if (c == '{' || c == '[') {
      open_.push_back({c, at_++});
      expected_ = c == '{' ? Expected::first_key : Expected::first_item;
    } else if (c == '"') {
      if (read_text()) finish_value();
    } else if (is_digit(c) || c == '-' || c == '+' || c == '.') {
      if (read_number()) finish_value();
    } else if (begins("true") || begins("null")) {
      at_ += 4, finish_value();
    } else if (begins("false")) {
      at_ += 5, finish_value();
    } else {
      complain_of_no_value();
    }
  }

  void finish_value() {
    value_end_ = at_;
    expected_ = open_.empty() ? Expected::end : Expected::comma;
  }

  void complain_of_no_value() {
    const char c = here();
    const bool closes = c == '}' || c == ']';
    if (closes && last_comma_) {
      complain(*last_comma_, fmt::format("the comma before this \"{}\" is too many", c));
    } else if (closes || c == ',') {
      complain(at_, fmt::format("a value is missing before this \"{}\"", c));
    } else if (is_letter(c)) {
      complain(at_,
               "this is no value: texts stand in double quotes \"…\"; true, false and null are "
               "written like that; numbers are finite");
    } else {
      complain(at_,
               "this is no value: a number, \"a text\", {…}, […], true, false or null is "
               "expected");
    }
  }

  bool read_number() {
    const std::size_t begin = at_;
    const auto digits = [&] {
      const std::size_t first = at_;
      while (is_digit(here())) ++at_;
      return at_ - first;
    };
    if (here() == '+') return complain(begin, "numbers have no plus sign"), false;
    if (here() == '-') ++at_;
    const bool has_zero = here() == '0';
    const std::size_t whole = digits();
    if (whole == 0) return complain(begin, "a number has a digit before the point: 0.5"), false;
    if (has_zero && whole > 1)
      return complain(begin, "numbers do not begin with zeros: 7, not 007"), false;
    if (here() == '.' && (++at_, digits() == 0)) {
      return complain(at_ - 1, "a number has a digit behind the point: 5.0 or 5"), false;
    }
    if (here() == 'e' || here() == 'E') {
      ++at_;
      if (here() == '+' || here() == '-') ++at_;
      if (digits() == 0) return complain(begin, "the exponent of this number has no digit"), false;
    }
    was_number_ = true;
    return true;
  }

  bool read_text() {
    const std::size_t begin = at_++;
    while (at_ < text_.size() && here() != '"') {
      if (here() == '\n') break;
      if (here() == '\\') {
        ++at_;
        if (std::string_view("\"\\/bfnrtu").find(here()) == std::string_view::npos) {
          return complain(at_ - 1, "\"\\\" has a meaning in texts; write \"\\\\\" for a backslash"),
                 false;
        }
      }
      ++at_;
    }
    if (here() != '"') {
      return complain(begin, "this text is not closed: a double quote \" is missing in its line"),
             false;
    }
    ++at_;
    was_number_ = false;
    return true;
  }

  // ---- what stands between values

  void read_key() {
    const char c = here();
    if (c == '"') {
      key_end_ = 0;
      if (!read_text()) return;
      key_end_ = at_;
      expected_ = Expected::colon;
    } else if (last_comma_ && (c == '}' || c == ']')) {
      complain(*last_comma_, fmt::format("the comma before this \"{}\" is too many", c));
    } else if (is_decimal_comma()) {
      complain(*last_comma_, "numbers have a decimal point, no comma: 0.5");
    } else if (c == ',') {
      complain(at_, "this comma is too many");
    } else if (c == ']') {
      complain(at_, fmt::format(
                        "this \"]\" stands where the \"{{\" of line {} has to be closed by \"}}\"",
                        line_of(open_.back().place)));
    } else if (is_letter(c)) {
      complain(at_, "names stand in double quotes: \"name\": value");
    } else {
      complain(at_, "a name in double quotes is expected: \"name\": value");
    }
  }

  /// 0,5: the comma stands between digits.
  bool is_decimal_comma() const {
    return last_comma_ && was_number_ && *last_comma_ > 0 && is_digit(here()) &&
           *last_comma_ + 1 == at_ && is_digit(text_[*last_comma_ - 1]);
  }

  void read_colon() {
    if (here() == ':') {
      ++at_;
      last_comma_.reset();
      expected_ = Expected::value;
    } else {
      complain(here() == '=' ? at_ : key_end_,
               "a colon is missing between name and value: \"name\": value");
    }
  }

  void read_comma() {
    const char c = here();
    if (c == ',') {
      last_comma_ = at_++;
      expected_ = open_.back().bracket == '{' ? Expected::key : Expected::value;
    } else if (c == '}' || c == ']') {
      close();
    } else if (was_number_ && value_end_ == at_ && (is_letter(c) || c == '.' || c == '%')) {
      complain(value_begin_,
               "this is no number; with a unit it stands in double quotes: \"10 mm\"");
    } else if (was_number_ && is_letter(c)) {
      complain(value_begin_, "a number with a unit stands in double quotes: \"10 mm\"");
    } else if (c == ':') {
      complain(at_, open_.back().bracket == '['
                        ? "a list [\xE2\x80\xA6] has values only; \"name\": value stands in an "
                          "object {\xE2\x80\xA6}"
                        : "this colon is too many");
    } else {
      complain(value_end_, "a comma is missing here");
    }
  }

  void close() {
    const char c = here();
    const Open last = open_.back();
    if (c != closing(last.bracket)) {
      return complain(at_,
                      fmt::format("this \"{}\" stands where the \"{}\" of line {} has to be "
                                  "closed by \"{}\"",
                                  c, last.bracket, line_of(last.place), closing(last.bracket)));
    }
    open_.pop_back();
    ++at_;
    was_number_ = false;
    finish_value();
  }

  const std::string& text_;
  std::size_t at_ = 0;
  Expected expected_ = Expected::value;
  std::vector<Open> open_;
  std::optional<std::size_t> last_comma_;  ///< right before what is read now
  std::size_t key_end_ = 0, value_begin_ = 0, value_end_ = 0;
  bool was_number_ = false;
  std::optional<Complaint> complaint_;
};

/// Bytes of the UTF-8 character that begins there; 0 if none does, or one that is not to be shown.
std::size_t shown_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint8_t>(i < text.size() ? text[i] : '\0');
  };
  if (byte(0) < 0x80) return byte(0) < 0x20 || byte(0) == 0x7F ? 0 : 1;
  const std::size_t size = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : byte(0) >= 0xC2 ? 2 : 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  if (byte(0) == 0xC2 && byte(1) < 0xA0) return 0;  // controls of C1
  if (byte(0) == 0xE2 && (byte(1) == 0x80 || byte(1) == 0x81)) {
    const bool is_shown = byte(1) == 0x80 ? byte(2) < 0xA8 || byte(2) > 0xAE : byte(2) < 0xA6;
    return is_shown ? size : 0;  // separators, direction
  }
  return byte(0) > 0xF4 ? 0 : size;
}

/// The characters of a line, each as it is shown.
std::vector<std::string> shown_characters(std::string_view line) {
  std::vector<std::string> characters;
  while (!line.empty()) {
    const std::size_t size = shown_character(line);
    const bool is_space = line.front() == '\t' || line.front() == '\r';
    characters.push_back(size > 0 ? std::string(line.substr(0, size)) : is_space ? " " : "?");
    line.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return characters;
}

/// The line with a caret below; of a long one what is around the place.
std::string pointed_line(std::string_view line, std::size_t place, const std::string& number) {
  constexpr std::size_t widest = 80, before = 50;
  const std::size_t column = shown_characters(line.substr(0, place)).size();
  const std::vector<std::string> all = shown_characters(line);
  const std::size_t begin = all.size() > widest && column > before ? column - before : 0;
  const std::size_t end = std::min(all.size(), begin + widest);
  std::string shown;
  for (std::size_t i = begin; i < end; ++i) shown += all[i];
  shown.erase(shown.find_last_not_of(' ') + 1);
  return fmt::format("\n  {} | {}\n  {} | {}^", number, shown, std::string(number.size(), ' '),
                     std::string(column - begin, ' '));
}

}  // namespace

std::string describe_syntax_error(const std::string& text, std::size_t position,
                                  const std::string& reason) {
  const auto found = SyntaxCheck(text).find();
  const bool is_known = found && found->place <= position;
  std::size_t place = is_known ? found->place : position > 0 ? position - 1 : 0;
  place = std::min(place, text.size());
  const std::size_t begin = place == 0 ? 0 : text.rfind('\n', place - 1) + 1;
  const std::size_t end = std::min(text.find('\n', place), text.size());
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
  return fmt::format("line {}, column {}: {}{}", line, place - begin + 1,
                     is_known ? found->cause : reason,
                     pointed_line(std::string_view(text).substr(begin, end - begin), place - begin,
                                  std::to_string(line)));
}

}  // namespace pleuel
