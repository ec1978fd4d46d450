#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "core/scene/problem_file.hpp"

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

}  // namespace pleuel::test
