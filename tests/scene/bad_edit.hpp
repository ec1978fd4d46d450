#pragma once

#include <iosfwd>

#include "tests/support/test.hpp"

namespace pleuel::test {

/// An edit of a good document and what the reader must say of it, after the name of the file: of several
/// mistakes that follow from the edit, the first.
struct BadEdit {
  std::string pointer;
  std::string value;  ///< JSON, or "remove"
  std::string message;
  int mistakes = 1;
};

void PrintTo(const BadEdit& bad, std::ostream* stream);

/// Edits, a line each: pointer | value | message, and the number of mistakes where there are several. In a message
/// a "~" in front stands for the pointer, a "^" for the one above it.
std::vector<BadEdit> bad_edits(const std::string& table);

/// Of good_json(): every kind of mistake.
class BadProblemFile : public testing::TestWithParam<BadEdit> {};

/// Of good_mechanism(): what else bodies, joints, loads and responses can get wrong.
class BadMechanismFile : public testing::TestWithParam<BadEdit> {};

}  // namespace pleuel::test
