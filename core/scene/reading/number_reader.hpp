#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/number.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// What a number must be beyond its physical quantity.
enum class Range {
  any,
  positive,
  not_negative,
  poisson,
  fraction,  ///< from 0 to 1
  below_one  ///< from 0 to less than 1
};

/// Whether the value is finite and keeps to the range.
bool is_within(Range range, double value);

/// The rule as a part of a sentence: "must be positive [m]".
std::string rule_of(Range range, const Quantity& quantity);

/// A place where a design variable is used: as a number of the scene, or in a linear constraint.
struct VariableUse {
  Number number;
  Quantity quantity;
  Range range = Range::any;
  JsonNode node;
};

/// A fixed number where a design variable could stand.
struct FixedNumber {
  JsonNode node;
  double value = 0.0;  ///< [SI]
  Quantity quantity;
};

/// Reads numbers with units and bindings to design variables. The quantity of a variable is that of
/// the places it is used in, which must agree. Everything throws InputError.
class NumberReader {
 public:
  /// @param variables  names in the order of the design.
  NumberReader(const UnitSystem& units, std::vector<std::string> variables);

  /// A number in SI or a text with unit, not designable.
  double fixed(const JsonNode& node, const Quantity& quantity, Range range = Range::any) const;

  /// A number in SI, a text with unit, or {"variable": name, "factor": number}.
  /// The range of a bound number is checked later, when the bounds are known.
  Number designable(const JsonNode& node, const Quantity& quantity, Range range = Range::any);

  /// Three designable numbers of the same quantity.
  std::array<Number, 3> triple(const JsonNode& node, const Quantity& quantity);

  /// Three plain numbers, not all zero.
  std::array<double, 3> direction(const JsonNode& node) const;

  /// The same, made a unit vector.
  std::array<double, 3> unit_vector(const JsonNode& node) const;

  /// Index of the variable with this name, which the document has at `node`.
  int variable(const JsonNode& node, const std::string& name) const;

  /// Index of the variable with this name, if there is one.
  std::optional<int> find_variable(const std::string& name) const;

  /// Says that a variable means this quantity here. Checks that it means the same everywhere.
  void add_use(VariableUse use);

  const std::vector<VariableUse>& uses() const { return uses_; }

  /// All that designable() found to be fixed, in the order of reading.
  const std::vector<FixedNumber>& fixed_numbers() const { return fixed_; }

  /// The quantity of a variable; nothing if it is not used.
  std::optional<Quantity> quantity_of(int variable) const;

  /// The SI value of one unit.
  double scale(const std::string& unit, const Quantity& quantity) const {
    return units_->scale(unit, quantity);
  }

 private:
  const VariableUse* first_use(int variable) const;
  Number binding(const JsonNode& node, const Quantity& quantity, Range range);

  const UnitSystem* units_;
  std::vector<std::string> variables_;
  std::vector<VariableUse> uses_;
  std::vector<FixedNumber> fixed_;
};

}  // namespace pleuel
