#include "core/scene/response_quantity.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/scene/response_kind.hpp"

namespace pleuel {

namespace {

Quantity instant_quantity(const ResponseSettings& response) {
  const bool is_angle = response.coordinate == DrivenCoordinate::angle;
  switch (response.type) {
    case ResponseType::stress:
    case ResponseType::shear_stress:
      if (response.part == StressPart::utilization) return quantities::pure_number;
      break;
    case ResponseType::section_force:
      return is_force(response.section_part) ? quantities::force : quantities::torque;
    case ResponseType::joint_position:
      if (is_angle) return quantities::angle;
      break;
    case ResponseType::joint_velocity:
      if (is_angle) return quantities::angular_speed;
      break;
    case ResponseType::joint_acceleration:
      if (is_angle) return kind_of(ResponseType::angular_acceleration).quantity;
      break;
    default:
      break;
  }
  return kind_of(response.type).quantity;
}

/// Quantities hold views: the texts of integrals live as long as the program.
struct TimeIntegral {
  std::string base, name, unit;
};

const TimeIntegral* find_integral(const std::vector<TimeIntegral>& table, const Quantity& base) {
  const auto found = std::ranges::find(table, base.unit, &TimeIntegral::base);
  return found == table.end() ? nullptr : &*found;
}

/// One row a unit: that of the first quantity that has it.
void add_integral(const Quantity& base, std::vector<TimeIntegral>& table) {
  if (find_integral(table, base) != nullptr) return;
  table.push_back({std::string(base.unit), fmt::format("{} times a time", base.name),
                   fmt::format("{} s", base.unit)});
}

/// Of everything that responses measure.
const std::vector<TimeIntegral>& time_integrals() {
  static const std::vector<TimeIntegral> table = [] {
    std::vector<TimeIntegral> rows = {{"1", "a time", "s"}, {"W", "an energy", "J"}};
    add_integral(quantities::angular_speed, rows);  // not a frequency, which has its unit
    for (const ResponseKind& kind : response_kinds) add_integral(kind.quantity, rows);
    return rows;
  }();
  return table;
}

}  // namespace

Quantity times_time(const Quantity& quantity) {
  const TimeIntegral* integral = find_integral(time_integrals(), quantity);
  if (integral == nullptr) {
    throw std::logic_error(fmt::format("no response measures {}", quantity.name));
  }
  return {integral->name, integral->unit};
}

Quantity quantity_of(const ResponseSettings& response) {
  if (response.type == ResponseType::expression) {
    return {response.expression->quantity, response.expression->unit};
  }
  const Quantity quantity = instant_quantity(response);
  return response.over_time == OverTime::integral ? times_time(quantity) : quantity;
}

}  // namespace pleuel
