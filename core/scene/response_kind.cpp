#include "core/scene/response_kind.hpp"

#include <algorithm>

namespace pleuel {

namespace {

/// Tells apart the words of one struct.
int number_of_word(const AnyResponse& response) {
  const auto number = [](const auto& one) {
    if constexpr (requires { one.derivative; }) return static_cast<int>(one.derivative);
    if constexpr (requires { one.kind; }) return static_cast<int>(one.kind);
    if constexpr (requires { one.mode; }) return static_cast<int>(one.mode.of);
    return 0;
  };
  return std::visit(number, response);
}

}  // namespace

const std::vector<ResponseKind>& response_kinds() {
  namespace q = quantities;
  using Rate = TimeDerivative;
  static const std::vector<ResponseKind> kinds = {
      {"mass", q::mass, MassResponse()},
      {"stress", q::stress, StressResponse()},
      {"deflection", q::length, DeflectionResponse()},
      {"position", q::length, PointMotionResponse{.derivative = Rate::none}},
      {"velocity", q::speed, PointMotionResponse{.derivative = Rate::first}},
      {"acceleration", q::acceleration, PointMotionResponse{.derivative = Rate::second}},
      {"drive-torque", q::torque, DriveResponse{.kind = DriveNumber::torque}},
      {"drive-force", q::force, DriveResponse{.kind = DriveNumber::force}},
      {"drive-power", q::power, DriveResponse{.kind = DriveNumber::power}},
      {"reaction-force", q::force, ReactionResponse{.kind = ReactionKind::force}},
      {"reaction-moment", q::torque, ReactionResponse{.kind = ReactionKind::moment}},
      {"frequency", q::angular_frequency, ModeResponse{.mode = {.of = ModeNumber::frequency}}},
      {"buckling", q::pure_number, BucklingResponse()},
      {"kinetic-energy", q::energy, EnergyResponse{.kind = EnergyKind::kinetic}},
      {"elastic-energy", q::energy, EnergyResponse{.kind = EnergyKind::elastic}},
      {"energy-balance", q::energy, EnergyBalanceResponse()},
      {"constraint-drift", q::pure_number, DriftResponse()},
      {"expression", q::pure_number, ExpressionResponse()},
      {"section-force", q::force, SectionForceResponse()},
      {"angular-velocity", q::angular_speed, TurningResponse{.derivative = Rate::first}},
      {"joint-position", q::length, JointMotionResponse{.derivative = Rate::none}},
      {"joint-velocity", q::speed, JointMotionResponse{.derivative = Rate::first}},
      {"spring-length", q::length, LoadResponse{.kind = LoadNumber::spring_length}},
      {"spring-force", q::force, LoadResponse{.kind = LoadNumber::spring_force}},
      {"motor-power", q::power, LoadResponse{.kind = LoadNumber::motor_power}},
      {"damper-power", q::power, LoadResponse{.kind = LoadNumber::damper_power}},
      {"angle", q::angle, TurningResponse{.derivative = Rate::none}},
      {"angular-acceleration",
       {"an angular acceleration", "rad/s^2"},
       TurningResponse{.derivative = Rate::second}},
      {"fatigue", q::pure_number, FatigueResponse{.kind = FatigueNumber::utilization}},
      {"shear-stress", q::stress, ShearStressResponse()},
      {"fatigue-damage", q::pure_number, FatigueResponse{.kind = FatigueNumber::damage}},
      {"lateral-buckling", q::pure_number, LateralBucklingResponse()},
      {"jerk", {"a jerk", "m/s^3"}, PointMotionResponse{.derivative = Rate::third}},
      {"angular-jerk", {"an angular jerk", "rad/s^3"}, TurningResponse{.derivative = Rate::third}},
      {"joint-acceleration", q::acceleration, JointMotionResponse{.derivative = Rate::second}},
      {"damping-ratio", q::pure_number, ModeResponse{.mode = {.of = ModeNumber::damping_ratio}}},
      {"growth-rate", q::rate, ModeResponse{.mode = {.of = ModeNumber::growth_rate}}},
      {"transmission-angle", q::angle, TransmissionAngleResponse()},
  };
  return kinds;
}

const ResponseKind& kind_of(const AnyResponse& response) {
  return *std::ranges::find_if(response_kinds(), [&](const ResponseKind& kind) {
    return kind.made.index() == response.index() &&
           number_of_word(kind.made) == number_of_word(response);
  });
}

}  // namespace pleuel
