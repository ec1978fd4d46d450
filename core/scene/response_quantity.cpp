#include "core/scene/response_quantity.hpp"

namespace pleuel {

namespace {

Quantity instant_quantity(const ResponseSettings& response) {
  const bool is_angle = response.coordinate == DrivenCoordinate::angle;
  switch (response.type) {
    case ResponseType::stress:
    case ResponseType::shear_stress:
      return response.part == StressPart::utilization ? quantities::pure_number
                                                      : quantities::stress;
    case ResponseType::deflection:
    case ResponseType::position:
      return quantities::length;
    case ResponseType::velocity:
      return quantities::speed;
    case ResponseType::acceleration:
      return quantities::acceleration;
    case ResponseType::drive_torque:
    case ResponseType::reaction_moment:
      return quantities::torque;
    case ResponseType::drive_power:
      return quantities::power;
    case ResponseType::drive_force:
    case ResponseType::reaction_force:
      return quantities::force;
    case ResponseType::frequency:
      return quantities::angular_frequency;
    case ResponseType::buckling:
    case ResponseType::lateral_buckling:
    case ResponseType::fatigue:
    case ResponseType::fatigue_damage:
    case ResponseType::constraint_drift:
      return quantities::pure_number;
    case ResponseType::section_force:
      return is_force(response.section_part) ? quantities::force : quantities::torque;
    case ResponseType::angular_velocity:
      return quantities::angular_speed;
    case ResponseType::joint_position:
      return is_angle ? quantities::angle : quantities::length;
    case ResponseType::joint_velocity:
      return is_angle ? quantities::angular_speed : quantities::speed;
    case ResponseType::spring_length:
      return quantities::length;
    case ResponseType::spring_force:
      return quantities::force;
    case ResponseType::angle:
      return quantities::angle;
    case ResponseType::angular_acceleration:
      return per_time(quantities::angular_speed);
    case ResponseType::damper_power:
    case ResponseType::motor_power:
      return quantities::power;
    case ResponseType::kinetic_energy:
    case ResponseType::elastic_energy:
    case ResponseType::energy_balance:
      return quantities::energy;
    case ResponseType::mass:
    case ResponseType::expression:
      break;
  }
  return quantities::mass;
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
