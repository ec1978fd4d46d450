#include "core/scene/reading/syntax_error.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/scene/reading/unit_scanner.hpp"

namespace pleuel {

std::size_t shown_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint8_t>(i < text.size() ? text[i] : '\0');
  };
  if (byte(0) < 0x80) return byte(0) < 0x20 || byte(0) == 0x7F ? 0 : 1;
  const std::size_t size = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : byte(0) >= 0xC2 ? 2 : 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  const bool is_c1 = byte(0) == 0xC2 && byte(1) < 0xA0;
  const bool separates = byte(0) == 0xE2 && byte(1) == 0x80 && byte(2) >= 0xA8 && byte(2) <= 0xAE;
  const bool turns = byte(0) == 0xE2 && byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xAF;
  return is_c1 || separates || turns || byte(0) > 0xF4 ? 0 : size;
}

bool has_control_character(std::string_view text, std::string_view allowed) {
  while (!text.empty()) {
    const std::size_t size = shown_character(text);
    if (size == 0 && allowed.find(text.front()) == std::string_view::npos) return true;
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return false;
}

namespace {

struct Complaint {
  std::size_t place;  ///< byte of the text
  std::string cause;
};

bool is_letter(char c) {
  return is_name_character(c) && !is_digit_character(c);
}
bool is_of_number(char c) {
  return is_digit_character(c) || c == '.' || c == '-' || c == '+';
}

/// Brackets that are open at the end of a text, and where its last string begins.
struct Outline {
  std::vector<std::size_t> open = {};
  std::size_t last_string = 0;

  explicit Outline(std::string_view text) {
    bool is_in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (c == '"') is_in_string = !is_in_string;
      if (is_in_string) {
        if (c == '"') last_string = i;
        if (c == '\\') ++i;
      } else if (c == '{' || c == '[') {
        open.push_back(i);
      } else if ((c == '}' || c == ']') && !open.empty()) {
        open.pop_back();
      }
    }
  }
};

/// What the parser could not take, what stands before it, and what the author most likely meant.
class Slip {
 public:
  Slip(std::string_view text, std::size_t position, std::string_view said)
      : text_(text), said_(said), end_(std::min(position, text.size())) {
    begin_ = is_said("unexpected end of input") ? text.size() : token_begin();
    behind_ = text.find_last_not_of(" \t\r\n", begin_ - 1) + 1;
    if (begin_ == 0) behind_ = 0;
  }

  Complaint found() const {
    if (const auto error = foreign()) return *error;
    if (const auto error = inside_token()) return *error;
    if (is_said("unexpected end of input")) return {begin_, end_cause()};
    if (is_said("expected end of input")) return at_end();
    if (const auto error = around_comma()) return *error;
    if (is_said("object separator")) {
      return {here() == '=' ? begin_ : behind_,
              "a colon is missing between name and value: \"name\": value"};
    }
    if (is_said("object key")) return {begin_, key_cause()};
    return is_said("parsing value") ? Complaint{begin_, value_cause()} : between_values();
  }

 private:
  using Found = std::optional<Complaint>;

  bool is_said(std::string_view words) const { return said_.find(words) != std::string::npos; }
  char at(std::size_t place) const { return place < text_.size() ? text_[place] : '\0'; }
  char here() const { return at(begin_); }
  char before() const { return behind_ > 0 ? text_[behind_ - 1] : '\0'; }
  bool closes() const { return here() == '}' || here() == ']'; }
  bool begins(std::string_view word) const { return text_.substr(begin_).starts_with(word); }
  auto line_of(std::size_t place) const {
    return 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(place), '\n');
  }

  template <class Is>
  std::size_t run_begin(std::size_t end, const Is& is_part) const {
    while (end > 0 && is_part(text_[end - 1])) --end;
    return end;
  }
  /// The parser has read the token up to what is wrong with it.
  std::size_t token_begin() const {
    if (is_said("invalid string") || is_said("unexpected string")) {
      return Outline(text_.substr(0, end_)).last_string;
    }
    const std::size_t last = end_ > 0 ? end_ - 1 : 0;
    const bool is_cut_word = last > 0 && is_letter(text_[last - 1]) && !is_name_character(at(last));
    return is_name_character(at(last)) || is_cut_word ? run_begin(last, is_name_character) : last;
  }

  /// What no JSON has anywhere outside of strings.
  Found foreign() const {
    if (begins("//") || begins("/*") || here() == '#') {
      return {{begin_,
               "JSON has no comments; objects of a problem may have a text \"$comment\" instead"}};
    }
    if (here() == '\'') {
      return {{begin_, "names and texts stand in double quotes \"…\", not in single ones"}};
    }
    for (const char* quote : {"“", "”", "„", "‘", "’"}) {
      if (begins(quote)) {
        return {
            {begin_, "names and texts stand in straight quotes \"…\", not in typographic ones"}};
      }
    }
    return std::nullopt;
  }

  Found inside_token() const {
    if (is_said("UTF-8")) {
      return {{end_ - 1, "a byte that is no UTF-8; save the file with that encoding"}};
    }
    if (is_said("number overflow")) {
      const std::size_t number = said_.find("parsing ") + 8;
      return {{end_ - 1, fmt::format("{} is a larger number than there is", said_.substr(number))}};
    }
    if (is_said("after backslash")) {
      return {{end_ - 2, "\"\\\" has a meaning in texts; write \"\\\\\" for a backslash"}};
    }
    if (is_said("closing quote") || is_said("control character")) {
      return {{begin_, "this text is not closed: a double quote \" is missing in its line"}};
    }
    if (is_said("invalid string")) {
      return {{end_ - 1, "\"\\u\" stands before the four digits, 0-9 or a-f, of a character"}};
    }
    if (!is_said("invalid number")) return std::nullopt;
    const std::size_t point = text_.rfind('.', end_ - 1);
    if (is_said("after '.'")) return {{point, "a number has a digit behind the point: 5.0 or 5"}};
    if (is_said("after '-'")) {
      return {{text_.rfind('-', end_ - 1), "a number has a digit before the point: 0.5"}};
    }
    return {{begin_, "the exponent of this number has no digit"}};
  }

  std::string end_cause() const {
    const Outline outline(text_);
    if (outline.open.empty()) return "the text ends before the value that was announced";
    const std::size_t last = outline.open.back();
    return fmt::format(
        "the text ends here, but the \"{}\" of line {} is not closed: \"{}\" is missing",
        text_[last], line_of(last), closing(last));
  }
  char closing(std::size_t bracket) const { return text_[bracket] == '{' ? '}' : ']'; }

  Complaint at_end() const {
    return {begin_, closes() ? fmt::format("this \"{}\" closes nothing: one too many", here())
                             : "the document has ended before; nothing may follow it"};
  }

  Found around_comma() const {
    const bool is_behind_comma = before() == ',';
    if (is_behind_comma && closes()) {
      return {{behind_ - 1, fmt::format("the comma before this \"{}\" is too many", here())}};
    }
    const bool is_decimal = is_behind_comma && is_said("object key") && behind_ == begin_ &&
                            is_digit_character(here()) && is_digit_character(at(behind_ - 2));
    if (is_decimal) return {{behind_ - 1, "numbers have a decimal point, no comma: 0.5"}};
    if (here() == ',' && !is_said("parsing value")) return {{begin_, "this comma is too many"}};
    return std::nullopt;
  }

  std::string closing_cause() const {
    const std::size_t open = Outline(text_.substr(0, begin_)).open.back();
    return fmt::format("this \"{}\" stands where the \"{}\" of line {} has to be closed by \"{}\"",
                       here(), text_[open], line_of(open), closing(open));
  }

  std::string key_cause() const {
    if (closes()) return closing_cause();
    return is_letter(here()) ? "names stand in double quotes: \"name\": value"
                             : "a name in double quotes is expected: \"name\": value";
  }

  std::string value_cause() const {
    if (closes() || here() == ',') {
      return fmt::format("a value is missing before this \"{}\"", here());
    }
    if (here() == '+') return "numbers have no plus sign";
    if (here() == '.') return "a number has a digit before the point: 0.5";
    return is_letter(here())
               ? "this is no value: texts stand in double quotes \"…\"; true, false and null are "
                 "written like that; numbers are finite"
               : "this is no value: a number, \"a text\", {…}, […], true, false or null is "
                 "expected";
  }

  Complaint between_values() const {
    if (closes()) return {begin_, closing_cause()};
    if (here() == '0' && begin_ + 1 < end_) {
      return {begin_, "numbers do not begin with zeros: 7, not 007"};
    }
    const bool is_unit = is_letter(here()) || here() == '.' || here() == '%';
    if (is_said("invalid literal") &&
        (is_digit_character(here()) || (is_digit_character(before()) && is_unit))) {
      return {is_digit_character(here()) ? begin_ : run_begin(behind_, is_of_number),
              "a number with a unit stands in double quotes: \"10 mm\""};
    }
    if (here() != ':') return {behind_, "a comma is missing here"};
    const bool is_in_list = text_[Outline(text_.substr(0, begin_)).open.back()] == '[';
    return {begin_, is_in_list ? "a list […] has values only; \"name\": value stands in an "
                                 "object {…}"
                               : "this colon is too many"};
  }

  std::string_view text_, said_;
  std::size_t end_, begin_ = 0;
  std::size_t behind_ = 0;  ///< the last character before the token that is no blank
};

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
                                  const std::string& said) {
  const auto [place, cause] = Slip(text, position, said).found();
  const std::size_t begin = place == 0 ? 0 : text.rfind('\n', place - 1) + 1;
  const std::size_t end = std::min(text.find('\n', place), text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(begin), '\n');
  return fmt::format("line {}, column {}: {}{}", line, place - begin + 1, cause,
                     pointed_line(std::string_view(text).substr(begin, end - begin), place - begin,
                                  std::to_string(line)));
}

namespace {

/// Far more than a mechanism needs: /dev/zero has no end.
constexpr std::size_t most_bytes = std::size_t{32} << 20U;

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(fmt::format("{}: there is no such file", path.string()));
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("{}: is a directory, not a problem file", path.string()));
  }
  // A pipe has no second reader, and one without a writer would wait for ever.
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(fmt::format("{}: is no ordinary file", path.string()));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::string text;
  std::array<char, 65536> part;
  do {
    stream.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > most_bytes) {
      throw InputError(fmt::format("{}: is larger than {} MiB, which no problem file is",
                                   path.string(), most_bytes >> 20U));
    }
  } while (stream);
  if (stream.bad()) throw InputError(fmt::format("{}: cannot be read", path.string()));
  if (text.find('\0') != std::string::npos) {
    throw InputError(fmt::format(
        "{}: is no text in UTF-8, as it has bytes of zero: save it as UTF-8", path.string()));
  }
  return text;
}

}  // namespace pleuel
