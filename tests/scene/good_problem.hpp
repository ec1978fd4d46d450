#pragma once

#include <iosfwd>
#include <string>

#include <nlohmann/json.hpp>

#include "core/scene/problem_file.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

using Json = nlohmann::ordered_json;

/// A problem with every kind of body, section, joint, drive, response and constraint, that reads
/// without complaint.
std::string good_text();
Json good_json();

/// A mechanism with every other kind of joint, function of time, load, response and effect.
Json good_mechanism();

/// Reads a document under the name "bad.json".
ProblemFile read(const Json& document);

/// What the reading of a document complains about; empty if it does not.
std::string complaint(const Json& document);
std::string complaint_about_text(const std::string& text);

/// The good document with the value at the pointer replaced or added; a value "remove" removes it.
Json edited(const std::string& pointer, const std::string& value);
Json edited(Json document, const std::string& pointer, const std::string& value);

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
