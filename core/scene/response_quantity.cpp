#include "core/scene/response_quantity.hpp"

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
    default:
      break;
  }
  return kind_of(response.type).quantity;
}

}  // namespace

Quantity quantity_of(const ResponseSettings& response) {
  if (response.type == ResponseType::expression) {
    return {response.expression->quantity, response.expression->unit};
  }
  const Quantity quantity = instant_quantity(response);
  return response.over_time == OverTime::integral ? times_time(quantity) : quantity;
}

}  // namespace pleuel
