#include "core/scene/response_quantity.hpp"

namespace pleuel {

Quantity quantity_of(const ResponseSettings& response) {
  const bool is_integral = response.over_time == OverTime::integral;
  switch (response.type) {
    case ResponseType::mass:
      break;
    case ResponseType::stress:
      return is_integral ? quantities::stress_time : quantities::stress;
    case ResponseType::deflection:
    case ResponseType::position:
      return is_integral ? quantities::length_time : quantities::length;
    case ResponseType::drive_torque:
      return is_integral ? quantities::torque_time : quantities::torque;
  }
  return quantities::mass;
}

}  // namespace pleuel
