#pragma once

#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/key_reader.hpp"
#include "core/scene/time_function.hpp"

/// Reads functions of time, and of the state of a force element. All throw InputError.
namespace pleuel {

// A function before it is read.

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
  void allow_keys(std::vector<std::string_view> keys) const {
    keys.insert(keys.begin(), "type");
    keys.insert(keys.end(), other_keys.begin(), other_keys.end());
    node.allow_keys(keys);
  }

  /// Reads by a table of keys.
  void read(NumberReader& numbers, const Keys::Table& table) const {
    std::vector<std::string_view> others = {"type"};
    others.insert(others.end(), other_keys.begin(), other_keys.end());
    read_keys(node, numbers, table, others);
  }
};

/// {"type": …, …}; the key "coordinate" may stand beside it.
/// @param value  what the drive prescribes: an angle or a length
TimeFunction read_drive_function(const JsonNode& node, const Quantity& value,
                                 NumberReader& numbers);

/// The motion that a motor follows: the same without other keys.
TimeFunction read_target(const JsonNode& node, const Quantity& value, NumberReader& numbers);

/// The same without the functions that are motions ("constant-speed", "ramp-to-speed"); a number, a
/// text with unit or a binding is a constant, a formula may have t and the state in it.
TimeFunction read_load_function(const LawSource& source, NumberReader& numbers);

/// What springs and dampers resist with: a function of the state, or "friction" or "clearance".
TimeFunction read_resistance(const LawSource& source, NumberReader& numbers);

/// A law through points, of time or of the motion, which the file lists or another file has
/// (table_law_reader.cpp).
TableFunction read_table_law(const LawSource& source, NumberReader& numbers);

}  // namespace pleuel
