#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/key_reader.hpp"
#include "core/scene/reading/number_reader.hpp"
#include "core/scene/time_function.hpp"

/// A function of time, or of the state of a force element, before it is read.
namespace pleuel {

enum class LawPurpose { drive, load };

/// What a law may be a function of besides time, by the names that formulas and tables have for it.
/// The rate is called "speed".
struct StateNames {
  std::string_view coordinate;   ///< "angle"
  std::string_view coordinates;  ///< "angles", of a table
  Quantity coordinate_quantity, rate_quantity;
};

/// A function in the document and what it measures.
struct LawSource {
  JsonNode node;
  Quantity value;
  LawPurpose purpose = LawPurpose::load;
  std::optional<StateNames> state = {};
  std::vector<std::string_view> other_keys = {};  ///< that are not the function's

  /// Its keys may be "type", these, and the others.
  void allow_keys(std::vector<std::string_view> keys) const;

  /// Reads a function by its table of keys.
  template <class Function, class Measures>
  void read(NumberReader& numbers, Function& function, const Measures& measures) const {
    std::vector<std::string_view> others = other_keys;
    others.push_back("type");
    read_keys(
        node, numbers, [&](Keys& keys) { describe(keys, function, measures); }, others);
  }
};

}  // namespace pleuel
