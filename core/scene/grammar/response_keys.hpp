#pragma once

#include <variant>

#include "core/scene/grammar/keys.hpp"
#include "core/scene/response_settings.hpp"

namespace pleuel {

/// What responses name, and the end of the simulation [s].
struct ResponseScope {
  const Scene& scene;
  double end_time = 0.0;
};

}  // namespace pleuel

/// Keys that several responses have, and the table of each kind of response.
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

/// The body that the key names; null where the table is not read, as there are no bodies then.
/// @param name  becomes its name
const Body* body(Keys& keys, const Key& key, std::string& name, const Scope& scope,
                 std::string_view sentence = "");
/// The same as the only one.
const Body* body(Keys& keys, const Key& key, std::vector<std::string>& names, const Scope& scope,
                 std::string_view sentence = "");

/// Null if it has another shape, or is null.
template <class Shape>
const Shape* shape_of(const Body* body) {
  return body == nullptr ? nullptr : std::get_if<Shape>(&body->shape);
}

/// The body has to be an elastic beam. @returns null if it is none
const BeamBody* elastic_beam(Keys& keys, const Body* body);

/// A component, or the component along a vector.
template <std::size_t count>
void component(Keys& keys, MotionComponent& one, const Choice<int> (&choices)[count],
               std::string_view sentence) {
  keys.choice_or_vector("direction", one.direction, choices, one.along, sentence);
  if (one.along) one.direction = magnitude_direction;
}

/// Of a rate, which has no magnitude: that of a vector is no linear function of what changes.
void component_of_jerk(Keys& keys, MotionComponent& one, const std::string& prefix,
                       std::string_view sentence);

/// A place along a beam, or one of an imported body by its name.
void place(Keys& keys, const Body* body, ResponsePoint& point, std::string_view sentence = "");

// response_table.cpp

void describe(Keys& keys, MassResponse& mass, R& r, const Scope& scope);
void describe(Keys& keys, ModeResponse& mode, R& r, const Scope& scope);
void describe(Keys& keys, EnergyResponse& energy, R& r, const Scope& scope);
void describe(Keys& keys, EnergyBalanceResponse& balance, R& r, const Scope& scope);
void describe(Keys& keys, DriftResponse& drift, R& r, const Scope& scope);
void describe(Keys& keys, ExpressionResponse& expression, R& r, const Scope& scope);

// stress_responses.cpp

void describe(Keys& keys, StressResponse& stress, R& r, const Scope& scope);
void describe(Keys& keys, ShearStressResponse& stress, R& r, const Scope& scope);
void describe(Keys& keys, FatigueResponse& fatigue, R& r, const Scope& scope);

// beam_responses.cpp

void describe(Keys& keys, SectionForceResponse& force, R& r, const Scope& scope);
void describe(Keys& keys, BucklingResponse& buckling, R& r, const Scope& scope);
void describe(Keys& keys, LateralBucklingResponse& buckling, R& r, const Scope& scope);
void describe(Keys& keys, DeflectionResponse& deflection, R& r, const Scope& scope);

// motion_responses.cpp

void describe(Keys& keys, PointMotionResponse& motion, R& r, const Scope& scope);
void describe(Keys& keys, TurningResponse& turning, R& r, const Scope& scope);
void describe(Keys& keys, TransmissionAngleResponse& angle, R& r, const Scope& scope);
void describe(Keys& keys, DriveResponse& drive, R& r, const Scope& scope);
void describe(Keys& keys, JointMotionResponse& motion, R& r, const Scope& scope);
void describe(Keys& keys, ReactionResponse& reaction, R& r, const Scope& scope);
void describe(Keys& keys, LoadResponse& load, R& r, const Scope& scope);

}  // namespace pleuel::response_tables
