#pragma once

#include <cmath>
#include <functional>
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

/// [entry of each thing]
/// @param entry_of  a function of a thing, or a member of it
template <class Things, class EntryOf>
Json list_of(const Things& things, const EntryOf& entry_of) {
  Json list = Json::array();
  for (const auto& thing : things) list.push_back(std::invoke(entry_of, thing));
  return list;
}

/// {NAME: entry of each thing}
template <class Things, class EntryOf>
Json named_entries(const Things& things, const EntryOf& entry_of) {
  Json entries = Json::object();
  for (const auto& thing : things) entries[thing.name] = std::invoke(entry_of, thing);
  return entries;
}

/// Null where there is none, or none that is finite.
inline Json number_or_null(const std::optional<double>& number) {
  return number && std::isfinite(*number) ? Json(*number) : Json(nullptr);
}

/// An indented document that ends with a newline; numbers read back exactly.
std::string to_text(const Json& document);

/// Many numbers in little room: {"rows": R, "f32": base64 of little-endian 32-bit floats, column by
/// column}. Seven digits: for what is drawn, not for what is computed with.
Json packed_numbers(const Eigen::MatrixXd& numbers);

/// A document that a command prints or keeps, with the version of its keys before them.
Json versioned(const Json& document);

/// Of documents that are equal but for the order of keys: the first object whose keys stand in
/// another order, as a JSON pointer. None if the order is the same.
std::optional<std::string> first_reordered(const Json& one, const Json& other);

}  // namespace pleuel
