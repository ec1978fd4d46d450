#include "core/scene/shown_unit.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/dimension.hpp"
#include "core/scene/response_kind.hpp"

namespace pleuel {

Quantity instant_quantity(const ResponseSettings& response) {
  if (const auto* stress = response.as<StressResponse>()) {
    if (stress->part == StressPart::utilization) return quantities::pure_number;
  }
  if (const auto* force = response.as<SectionForceResponse>()) {
    return is_force(force->part) ? quantities::force : quantities::torque;
  }
  if (const auto* motion = response.as<JointMotionResponse>()) {
    const bool is_angle = motion->coordinate == DrivenCoordinate::angle;
    if (is_angle) return kind_of(TurningResponse{.derivative = motion->derivative}).quantity;
  }
  return kind_of(response.what).quantity;
}

Quantity times_time(const Quantity& quantity) {
  if (quantity == quantities::pure_number) return quantities::time;
  if (quantity == quantities::power) return quantities::energy;
  // Of a unit the first quantity that has it; rad/s is not called a frequency.
  const auto kind = std::ranges::find(response_kinds(), quantity, &ResponseKind::quantity);
  if (kind == response_kinds().end()) {
    throw std::logic_error(fmt::format("no response measures {}", quantity.name));
  }
  const Quantity& base =
      quantity == quantities::angular_speed ? quantities::angular_speed : kind->quantity;
  return {kept_text(fmt::format("{} times a time", base.name)),
          kept_text(fmt::format("{} s", base.unit))};
}

Quantity quantity_of(const ResponseSettings& response) {
  if (const Expression* formula = formula_of(response)) return {formula->quantity, formula->unit};
  const Quantity quantity = instant_quantity(response);
  return response.over_time == OverTime::integral ? times_time(quantity) : quantity;
}

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

ShownUnit unit_of(const DesignVariable& variable) {
  const auto& [name, unit] = variable.quantity;
  return variable.unit.empty() ? engineering_unit(unit)
                               : ShownUnit{std::string(unit), variable.unit,
                                           unit_scale(variable.unit, variable.quantity)};
}

}  // namespace

std::vector<ShownUnit> variable_units(const ProblemFile& problem) {
  std::vector<ShownUnit> units;
  for (const DesignVariable& variable : problem.variables) units.push_back(unit_of(variable));
  return units;
}

std::string bounds_text(const DesignVariable& variable) {
  const ShownUnit unit = unit_of(variable);
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
