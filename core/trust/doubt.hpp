#pragma once

#include <string>
#include <vector>

namespace pleuel {

/// Something that speaks against numbers that came out of a simulation without complaint.
struct Doubt {
  std::string text;  ///< a sentence: what, where, how far, and what to do about it
  /// The numbers are not to be trusted (more than 1 % off, or of another mechanism than meant): no
  /// design that rests on them is `verified`.
  bool is_serious = false;
  /// Names of the responses that it concerns; empty: all.
  std::vector<std::string> responses{};
  /// Names of bodies that stand in it for not being held or driven as a mechanism's are: drawn red.
  std::vector<std::string> bodies{};
};

}  // namespace pleuel
