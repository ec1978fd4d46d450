#include "cli/text/json.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace pleuel {

namespace {

/// RFC 4648.
std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char letters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * ((bytes.size() + 2) / 3));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = (group << 8) | (k < given ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= given ? letters[(group >> (18 - 6 * k)) & 63u] : '=';
    }
  }
  return text;
}

}  // namespace

std::string to_text(const Json& document) {
  // A file name need not be UTF-8; a result must be written nevertheless.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json packed_numbers(const Eigen::MatrixXd& numbers) {
  std::vector<unsigned char> bytes;
  bytes.reserve(4 * static_cast<std::size_t>(numbers.size()));
  for (const double number : numbers.reshaped()) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<unsigned char>(bits >> (8 * k)));
  }
  return {{"rows", numbers.rows()}, {"f32", base64(bytes)}};
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
