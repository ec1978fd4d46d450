#include "core/scene/reading/control_characters.hpp"

#include <algorithm>
#include <cstdint>

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

}  // namespace pleuel
