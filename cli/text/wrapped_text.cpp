#include "cli/text/wrapped_text.hpp"

#include <algorithm>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

namespace pleuel {

namespace {

/// 0 where nobody says.
std::size_t known_width() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* columns = std::getenv("COLUMNS");
  return columns == nullptr ? 0 : std::strtoul(columns, nullptr, 10);
}

std::string wrapped_line(const std::string& line, const std::string& indent, std::size_t width) {
  std::string text;
  std::string current = line.substr(0, std::min(line.find_first_not_of(' '), line.size()));
  bool has_word = false;
  for (std::size_t begin = current.size(); begin < line.size();) {
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    const std::string word = line.substr(begin, end - begin);
    const bool is_too_long = characters(current) + 1 + characters(word) > width;
    if (has_word && is_too_long) {
      text += current + "\n";
      current = indent;
    } else if (has_word) {
      current += ' ';
    }
    current += word;
    has_word = true;
    begin = end + 1;
  }
  return text + current;
}

}  // namespace

std::size_t characters(const std::string& text) {
  // Bytes 10xxxxxx continue a character.
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string words_of(std::string key) {
  std::ranges::replace(key, '_', ' ');
  return key;
}

std::string shortened(std::string text, std::size_t most) {
  if (characters(text) <= most) return text;
  while (characters(text) >= most) text.pop_back();
  return text + "…";
}

std::size_t line_width() {
  static const std::size_t width = [] {
    const std::size_t known = known_width();
    return known == 0 ? 100 : std::clamp<std::size_t>(known, 80, 160);
  }();
  return width;
}

std::string wrapped(const std::string& text, const std::string& indent, std::size_t width) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    const std::size_t length = end == std::string::npos ? std::string::npos : end - begin;
    result += wrapped_line(text.substr(begin, length), indent, width);
    if (end == std::string::npos) break;
    result += '\n';
    begin = end + 1;
  }
  return result;
}

}  // namespace pleuel
