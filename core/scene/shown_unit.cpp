#include "core/scene/shown_unit.hpp"

#include <array>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/response_quantity.hpp"
#include "core/scene/units.hpp"
#include "core/scene/variable_quantity.hpp"

namespace pleuel {

ShownUnit engineering_unit(std::string_view si) {
  struct Entry {
    std::string_view si, name;
    double factor;
  };
  static constexpr std::array<Entry, 4> entries = {
      {{"m", "mm", 1e-3}, {"Pa", "MPa", 1e6}, {"m s", "mm s", 1e-3}, {"Pa s", "MPa s", 1e6}}};
  for (const Entry& entry : entries) {
    if (entry.si == si) return {std::string(si), std::string(entry.name), entry.factor};
  }
  return {std::string(si), std::string(si), 1.0};
}

namespace {

ShownUnit unit_of(const DesignVariable& variable, const Quantity& quantity,
                  const UnitSystem& system) {
  const std::string& written = variable.unit;
  return written.empty()
             ? engineering_unit(quantity.unit)
             : ShownUnit{std::string(quantity.unit), written, system.scale(written, quantity)};
}

}  // namespace

std::vector<ShownUnit> variable_units(const ProblemFile& problem) {
  const UnitSystem system;
  std::vector<ShownUnit> units;
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const Quantity quantity = variable_quantity(problem, static_cast<int>(i));
    units.push_back(unit_of(problem.variables[i], quantity, system));
  }
  return units;
}

std::string bounds_text(const DesignVariable& variable, const Quantity& quantity) {
  const ShownUnit unit = unit_of(variable, quantity, UnitSystem());
  return fmt::format("{:g} to {:g}{}", unit.shown(variable.lower), unit.shown(variable.upper),
                     unit.suffix());
}

ShownUnit unit_of(const ResponseSettings& response) {
  const Quantity quantity = quantity_of(response);
  if (!response.unit.empty()) {
    return {std::string(quantity.unit), response.unit, response.unit_scale};
  }
  const bool is_frequency = quantity.name == quantities::angular_frequency.name &&
                            quantity.unit == quantities::angular_frequency.unit;
  if (is_frequency) return {"rad/s", "Hz", 2.0 * std::numbers::pi};
  return engineering_unit(quantity.unit);
}

ShownUnit unit_of(const ProblemFile& problem, const ConstraintSettings& constraint) {
  if (constraint.linear.empty()) return unit_of(find_response(problem, constraint.response));
  return variable_units(problem)[constraint.linear.front().first];
}

const ResponseSettings& find_response(const ProblemFile& problem, const std::string& name) {
  const ResponseSettings* found = find_named(problem.responses, name);
  if (!found) throw std::logic_error("no response " + name);
  return *found;
}

}  // namespace pleuel
