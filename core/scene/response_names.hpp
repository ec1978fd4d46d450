#pragma once

#include "core/scene/choices.hpp"
#include "core/scene/problem_file.hpp"

/// The words of problem files for kinds of responses.
namespace pleuel {

inline constexpr Choice<ResponseType> response_types[] = {
    {"mass", ResponseType::mass},
    {"stress", ResponseType::stress},
    {"deflection", ResponseType::deflection},
    {"position", ResponseType::position},
    {"velocity", ResponseType::velocity},
    {"acceleration", ResponseType::acceleration},
    {"drive-torque", ResponseType::drive_torque},
    {"drive-force", ResponseType::drive_force},
    {"drive-power", ResponseType::drive_power},
    {"reaction-force", ResponseType::reaction_force},
    {"reaction-moment", ResponseType::reaction_moment},
    {"frequency", ResponseType::frequency},
    {"buckling", ResponseType::buckling},
    {"kinetic-energy", ResponseType::kinetic_energy},
    {"elastic-energy", ResponseType::elastic_energy},
    {"energy-balance", ResponseType::energy_balance},
    {"constraint-drift", ResponseType::constraint_drift},
    {"expression", ResponseType::expression},
    {"section-force", ResponseType::section_force},
    {"angular-velocity", ResponseType::angular_velocity},
    {"joint-position", ResponseType::joint_position},
    {"joint-velocity", ResponseType::joint_velocity},
    {"spring-length", ResponseType::spring_length},
    {"spring-force", ResponseType::spring_force},
    {"motor-power", ResponseType::motor_power},
    {"damper-power", ResponseType::damper_power},
    {"angle", ResponseType::angle},
    {"angular-acceleration", ResponseType::angular_acceleration},
    {"fatigue", ResponseType::fatigue},
    {"shear-stress", ResponseType::shear_stress},
    {"fatigue-damage", ResponseType::fatigue_damage},
    {"lateral-buckling", ResponseType::lateral_buckling},
};

inline constexpr Choice<FatigueCriterion> fatigue_criteria[] = {
    {"goodman", FatigueCriterion::goodman},
    {"gerber", FatigueCriterion::gerber},
    {"soderberg", FatigueCriterion::soderberg},
};

inline constexpr Choice<OverTime> over_time_kinds[] = {
    {"max", OverTime::max},     {"min", OverTime::min},   {"max-abs", OverTime::max_abs},
    {"rms", OverTime::rms},     {"mean", OverTime::mean}, {"integral", OverTime::integral},
    {"final", OverTime::final},
};

}  // namespace pleuel
