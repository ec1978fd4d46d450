#pragma once

#include <string>

namespace pleuel {

/// The text, or its beginning: a message is a line, not a listing.
inline std::string excerpt(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // UTF-8
  return text.substr(0, end) + "…";
}

}  // namespace pleuel
