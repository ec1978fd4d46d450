#pragma once

#include <string>
#include <vector>

#include "core/scene/number_keys.hpp"
#include "core/scene/reading/number_reader.hpp"

/// Reads the numbers of a struct by its table of keys (number_keys.hpp).
namespace pleuel {

template <class Struct, std::size_t count>
std::vector<std::string_view> words_of(const std::array<NumberKey<Struct>, count>& keys,
                                       std::vector<std::string_view> others = {}) {
  for (const NumberKey<Struct>& key : keys) others.push_back(key.word);
  return others;
}

/// What is not given stays as it is. @throws InputError
template <class Struct, std::size_t count>
void read_numbers(const JsonNode& node, const std::array<NumberKey<Struct>, count>& keys,
                  NumberReader& numbers, Struct& into) {
  for (const NumberKey<Struct>& key : keys) {
    const std::string word(key.word);
    const auto value = key.presence == Presence::required ? node.at(word) : node.find(word);
    if (!value) continue;
    const Number number = numbers.designable(*value, key.quantity, key.range);
    std::visit([&](auto member) { into.*member = number; }, key.member);
  }
}

}  // namespace pleuel
