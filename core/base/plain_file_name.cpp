#include "core/base/plain_file_name.hpp"

namespace pleuel {

std::string plain_file_name(const std::string& text) {
  std::string name = text;
  for (char& c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '-' || c == '.' || (c & 0x80) != 0;
    if (!is_plain) c = '_';
  }
  return name;
}

}  // namespace pleuel
