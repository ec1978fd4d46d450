#pragma once

#include <cstdint>
#include <string>

namespace pleuel {

/// Fowler, Noll & Vo, 64 bits: tells inputs apart and finds damage, protects against nobody.
class Fingerprint {
 public:
  void add(const std::string& text);
  std::uint64_t number() const { return state_; }
  std::string text() const;  ///< "fnv1a64:…"

 private:
  void add_byte(unsigned char byte);

  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace pleuel
