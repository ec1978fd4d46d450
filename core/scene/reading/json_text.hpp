#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// From a text to a JSON document, stricter than the library: nothing is lost silently.
namespace pleuel {

using Json = nlohmann::ordered_json;

/// Objects and lists inside each other; more is not a problem file.
inline constexpr std::size_t deepest_nesting = 64;

/// @param file  how messages name the text.
/// @throws InputError with line and column for bad syntax, invalid UTF-8 and numbers out of range;
///         with the JSON pointer for a key that is there twice and for too deep nesting.
Json parse_json(const std::string& text, const std::string& file);

/// Names of the members of an object; none of another value.
std::vector<std::string> keys_of(const Json& object);

/// The same of a member that may be missing.
std::vector<std::string> keys_of(const Json& parent, const char* key);

/// `parent` extended by a key, escaped as RFC 6901 wants it.
std::string child_pointer(const std::string& parent, const std::string& key);

}  // namespace pleuel
