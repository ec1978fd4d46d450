#pragma once

#include <string_view>

#include "core/scene/grammar/tables.hpp"
#include "core/scene/reading/number_reader.hpp"

/// Reads objects by their tables of keys (grammar/keys.hpp). Everything throws InputError.
namespace pleuel {

/// The node has keys of the table, and these besides, only.
void read_keys(const JsonNode& node, NumberReader& numbers, const Keys::Table& table,
               const std::vector<std::string_view>& others = {});

/// What is not given stays as it is.
template <class Struct, class... Measures>
void read_keys(const JsonNode& node, NumberReader& numbers, Struct& into,
               const Measures&... measures) {
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, into, measures...); });
}

}  // namespace pleuel
