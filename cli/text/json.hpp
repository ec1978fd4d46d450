#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace pleuel {

/// Keys in the order in which they are written.
using Json = nlohmann::ordered_json;

/// {NAME: number} of named things; no members where there are no numbers.
template <class Named, class Numbers>
Json by_name(const std::vector<Named>& things, const Numbers& numbers) {
  Json document = Json::object();
  for (Eigen::Index i = 0; i < numbers.size(); ++i) document[things[i].name] = numbers(i);
  return document;
}

/// An indented document that ends with a newline; numbers read back exactly.
std::string to_text(const Json& document);

/// A document that a command prints or keeps, with the version of its keys before them.
Json versioned(const Json& document);

/// Of documents that are equal but for the order of keys: the first object whose keys stand in
/// another order, as a JSON pointer. None if the order is the same.
std::optional<std::string> first_reordered(const Json& one, const Json& other);

}  // namespace pleuel
