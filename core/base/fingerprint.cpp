#include "core/base/fingerprint.hpp"

#include <fmt/format.h>

namespace pleuel {

void Fingerprint::add(const std::string& text) {
  for (const char c : text) add_byte(static_cast<unsigned char>(c));
  add_byte(0);  // so that {"a", "b"} differs from {"ab"}
}

std::string Fingerprint::text() const {
  return fmt::format("fnv1a64:{:016x}", state_);
}

void Fingerprint::add_byte(unsigned char byte) {
  state_ = (state_ ^ byte) * 0x100000001b3u;
}

}  // namespace pleuel
