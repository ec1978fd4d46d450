#include "cli/text/console.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace pleuel {

void prepare_streams() {
  // open() takes the lowest number that is free.
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF) ::open("/dev/null", O_RDWR);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

namespace {

/// Words that are seen first, and their colours (ECMA-48, SGR).
constexpr std::array<std::pair<std::string_view, const char*>, 7> word_colours = {{
    {"VERIFIED", "32"},
    {"NOT VERIFIED", "33"},
    {"INTERRUPTED", "33"},
    {"FAILED", "31"},
    {"BROKEN", "31"},
    {"Warning:", "33"},
    {"error:", "31"},
}};

bool takes_colours(std::FILE* out) {
  const char* refused = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool is_dumb = terminal != nullptr && std::string_view(terminal) == "dumb";
  return ::isatty(::fileno(out)) == 1 && !is_dumb && (refused == nullptr || *refused == '\0');
}

}  // namespace

std::string coloured(const std::string& text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    const auto word = std::ranges::find_if(word_colours, [&](const auto& one) {
      return text.compare(i, one.first.size(), one.first) == 0;
    });
    if (word == word_colours.end()) {
      shown += text[i++];
      continue;
    }
    shown += std::string("\033[1;") + word->second + "m" + std::string(word->first) + "\033[0m";
    i += word->first.size();
  }
  return shown;
}

std::string coloured_for(std::FILE* out, const std::string& text) {
  return takes_colours(out) ? coloured(text) : text;
}

void show(std::FILE* out, const std::string& text) {
  std::fputs(coloured_for(out, text).c_str(), out);
  std::fflush(out);
}

std::string write_all(std::FILE* out, const std::string& text) {
  errno = 0;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
  const bool is_flushed = std::fflush(out) == 0;
  if ((is_written && is_flushed) || errno == EPIPE) return "";
  return std::strerror(errno);
}

}  // namespace pleuel
