#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "cli/text/json.hpp"

namespace pleuel {

/// Fowler, Noll & Vo, 64 bits: tells inputs apart, protects against nothing.
class Fingerprint {
 public:
  void add(const std::string& text);
  std::string text() const;  ///< "fnv1a64:…"

 private:
  void add_byte(unsigned char byte);

  std::uint64_t state_ = 0xcbf29ce484222325u;
};

/// The bytes of a file; empty if it cannot be read.
std::string whole_text(const std::filesystem::path& path);

/// {NAME: fingerprint} of the files that a problem or one of its load cases names: catalogues, tables
/// and those of bodies.
/// @param problem  with all overrides
/// @param file     that it was read from: names are relative to its folder
Json fingerprints_of_files(const Json& problem, const std::filesystem::path& file);

}  // namespace pleuel
