#pragma once

/// What is to be known of a type of response without looking at its settings.

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/scene/kind_table.hpp"
#include "core/scene/problem_file.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// In place of the number of a component of a vector (0 … 2): its magnitude is asked for.
inline constexpr int magnitude_direction = -1;

struct ResponseKind {
  ResponseType type;
  std::string_view word;  ///< in a problem file
  /// At an instant. What a part, a coordinate or a formula decides, quantity_of() knows.
  Quantity quantity;
  bool is_of_point = false;  ///< of a body, at the place `at`
  /// What it is the derivative of with respect to time: it has the keys and the signal of that.
  std::optional<ResponseType> rate_of = {};
};

/// In the order of ResponseType.
inline constexpr ResponseKind response_kinds[] = {
    {ResponseType::mass, "mass", quantities::mass},
    {ResponseType::stress, "stress", quantities::stress},
    {ResponseType::deflection, "deflection", quantities::length, true},
    {ResponseType::position, "position", quantities::length, true},
    {ResponseType::velocity, "velocity", quantities::speed, true},
    {ResponseType::acceleration, "acceleration", quantities::acceleration, true},
    {ResponseType::drive_torque, "drive-torque", quantities::torque},
    {ResponseType::drive_force, "drive-force", quantities::force},
    {ResponseType::drive_power, "drive-power", quantities::power},
    {ResponseType::reaction_force, "reaction-force", quantities::force},
    {ResponseType::reaction_moment, "reaction-moment", quantities::torque},
    {ResponseType::frequency, "frequency", quantities::angular_frequency},
    {ResponseType::buckling, "buckling", quantities::pure_number},
    {ResponseType::kinetic_energy, "kinetic-energy", quantities::energy},
    {ResponseType::elastic_energy, "elastic-energy", quantities::energy},
    {ResponseType::energy_balance, "energy-balance", quantities::energy},
    {ResponseType::constraint_drift, "constraint-drift", quantities::pure_number},
    {ResponseType::expression, "expression", quantities::pure_number},
    {ResponseType::section_force, "section-force", quantities::force},
    {ResponseType::angular_velocity, "angular-velocity", quantities::angular_speed},
    {ResponseType::joint_position, "joint-position", quantities::length},
    {ResponseType::joint_velocity, "joint-velocity", quantities::speed},
    {ResponseType::spring_length, "spring-length", quantities::length},
    {ResponseType::spring_force, "spring-force", quantities::force},
    {ResponseType::motor_power, "motor-power", quantities::power},
    {ResponseType::damper_power, "damper-power", quantities::power},
    {ResponseType::angle, "angle", quantities::angle},
    {ResponseType::angular_acceleration,
     "angular-acceleration",
     {"an angular acceleration", "rad/s^2"}},
    {ResponseType::fatigue, "fatigue", quantities::pure_number},
    {ResponseType::shear_stress, "shear-stress", quantities::stress},
    {ResponseType::fatigue_damage, "fatigue-damage", quantities::pure_number},
    {ResponseType::lateral_buckling, "lateral-buckling", quantities::pure_number},
    {ResponseType::jerk, "jerk", {"a jerk", "m/s^3"}, true, ResponseType::acceleration},
    {ResponseType::angular_jerk,
     "angular-jerk",
     {"an angular jerk", "rad/s^3"},
     false,
     ResponseType::angular_acceleration},
    {ResponseType::joint_acceleration, "joint-acceleration", quantities::acceleration, false,
     ResponseType::joint_velocity},
    {ResponseType::damping_ratio, "damping-ratio", quantities::pure_number},
    {ResponseType::growth_rate, "growth-rate", quantities::rate},
    {ResponseType::transmission_angle, "transmission-angle", quantities::angle},
};
static_assert(are_in_order(response_kinds));

constexpr const ResponseKind& kind_of(ResponseType type) {
  return response_kinds[static_cast<std::size_t>(type)];
}

/// Whether a response is a number of a mode of small vibrations.
constexpr bool is_of_modes(ResponseType type) {
  return type == ResponseType::frequency || type == ResponseType::damping_ratio ||
         type == ResponseType::growth_rate;
}

/// The type whose signal a response observes: of a rate, what changes; else its own.
constexpr ResponseType observed_type(ResponseType type) {
  return kind_of(type).rate_of.value_or(type);
}

}  // namespace pleuel
