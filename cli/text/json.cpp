#include "cli/text/json.hpp"

#include <algorithm>

namespace pleuel {

std::string to_text(const Json& document) {
  // A file name need not be UTF-8; a result must be written nevertheless.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json versioned(const Json& document) {
  Json whole = {{"version", 1}};
  whole.update(document);
  return whole;
}

std::optional<std::string> first_reordered(const Json& one, const Json& other) {
  if (one == other || one.type() != other.type() || one.size() != other.size()) return std::nullopt;
  if (one.is_object()) {
    const auto has_same_key = [](const auto& a, const auto& b) { return a.first == b.first; };
    const auto &first = one.get_ref<const Json::object_t&>(),
               &second = other.get_ref<const Json::object_t&>();
    if (!std::equal(first.begin(), first.end(), second.begin(), has_same_key)) return "";
  }
  for (const auto& [key, value] : one.items()) {
    const Json::json_pointer place = Json::json_pointer() / key;
    const Json& there = one.is_array() ? other.at(std::stoul(key)) : other.at(key);
    if (const auto found = first_reordered(value, there)) return place.to_string() + *found;
  }
  return std::nullopt;
}

}  // namespace pleuel
