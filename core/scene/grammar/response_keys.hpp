#pragma once

#include <variant>

#include "core/scene/grammar/keys.hpp"
#include "core/scene/response_kind.hpp"

namespace pleuel {

/// What responses name, and the end of the simulation [s].
struct ResponseScope {
  const Scene& scene;
  double end_time = 0.0;
};

}  // namespace pleuel

/// Keys that several responses have, and a table for each kind of response (response_table.cpp says
/// which types are of a kind).
namespace pleuel::response_tables {

using R = ResponseSettings;
using Scope = ResponseScope;

inline constexpr Choice<int> axes[] = {{"x", 0}, {"y", 1}, {"z", 2}};
inline constexpr Choice<int> axes_or_magnitude[] = {
    {"x", 0}, {"y", 1}, {"z", 2}, {"magnitude", magnitude_direction}};

/// The times "from" and "to".
void window(Keys& keys, R& r, const Scope& scope);
/// "over_time", and these.
void history(Keys& keys, R& r, const Scope& scope);

/// The body that the key names, as the one body of the response; null where the table is not read, as
/// there are no bodies then.
const Body* body(Keys& keys, const Key& key, R& r, const Scope& scope,
                 std::string_view sentence = "");

/// Null if it has another shape, or is null.
template <class Shape>
const Shape* shape_of(const Body* body) {
  return body == nullptr ? nullptr : std::get_if<Shape>(&body->shape);
}

/// The body has to be an elastic beam. @returns null if it is none
const BeamBody* elastic_beam(Keys& keys, const Body* body);
const BeamBody* elastic_beam(Keys& keys, const Key& key, R& r, const Scope& scope);

/// A component, or the component along a vector.
template <std::size_t count>
void component(Keys& keys, R& r, const Choice<int> (&choices)[count], std::string_view sentence) {
  keys.choice_or_vector("direction", r.direction, choices, r.along, sentence);
  if (r.along) r.direction = magnitude_direction;
}

/// Of a rate, which has no magnitude: that of a vector is no linear function of what changes.
void component_of_rate(Keys& keys, R& r, std::string_view sentence);

/// A place along a beam, or one of an imported body by its name.
void place(Keys& keys, const Body* body, R& r, std::string_view sentence = "");

// stress_responses.cpp

void stress(Keys& keys, R& r, const Scope& scope);
void shear_stress(Keys& keys, R& r, const Scope& scope);
void fatigue(Keys& keys, R& r, const Scope& scope);

// beam_responses.cpp

void section_force(Keys& keys, R& r, const Scope& scope);
void buckling(Keys& keys, R& r, const Scope& scope);
void deflection(Keys& keys, R& r, const Scope& scope);

// motion_responses.cpp

void motion(Keys& keys, R& r, const Scope& scope);
void turning(Keys& keys, R& r, const Scope& scope);
void transmission_angle(Keys& keys, R& r, const Scope& scope);
void drive_effort(Keys& keys, R& r, const Scope& scope);
void joint_motion(Keys& keys, R& r, const Scope& scope);
void reaction(Keys& keys, R& r, const Scope& scope);
void spring_state(Keys& keys, R& r, const Scope& scope);
void motor_power(Keys& keys, R& r, const Scope& scope);
void damper_power(Keys& keys, R& r, const Scope& scope);

}  // namespace pleuel::response_tables
