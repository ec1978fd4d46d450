#pragma once

#include "core/scene/body_source.hpp"
#include "core/scene/grammar/keys.hpp"
#include "core/scene/point.hpp"
#include "core/scene/problem_file.hpp"

/// The tables of keys (keys.hpp), one a struct.
namespace pleuel {

// mechanism_keys.cpp

const std::vector<ObjectKind<Section>>& section_kinds();
void describe(Keys& keys, Section& section);
void describe(Keys& keys, RectangleSection& section);
void describe(Keys& keys, CircleSection& section);
void describe(Keys& keys, TubeSection& section);
void describe(Keys& keys, EllipseSection& section);
void describe(Keys& keys, BoxSection& section);
void describe(Keys& keys, ISection& section);
void describe(Keys& keys, GeneralSection& section);
void describe(Keys& keys, GeneralStressPoint& point);

// body_keys.cpp

void describe(Keys& keys, Material& material);
void describe(Keys& keys, Damping& damping);
/// @param materials  that there are
void describe(Keys& keys, BeamBody& body, const std::vector<std::string>& materials);
void describe(Keys& keys, RigidBody& body);
void describe(Keys& keys, PointMass& body);
void describe(Keys& keys, ImportedBody& body);
void describe(Keys& keys, BodyGenerator& generator);
void describe(Keys& keys, InitialDeflection& deflection);

void describe(Keys& keys, CraigBampton& reduction);
void describe(Keys& keys, Segment& segment);

// mechanism_keys.cpp: those of its type

void describe(Keys& keys, Joint& joint);

// mechanism_keys.cpp: what acts along a coordinate measures what that says.

void describe(Keys& keys, PointLoad& load);
void describe(Keys& keys, SpringDamper& spring);
void describe(Keys& keys, JointForce& force, const AlongCoordinate& along);
void describe(Keys& keys, MotorControl& control, const AlongCoordinate& along);
void describe(Keys& keys, FrictionLaw& law, const AlongCoordinate& along);
void describe(Keys& keys, ClearanceLaw& law, const AlongCoordinate& along);

// mechanism_keys.cpp: `value` is what the function itself measures.

void describe(Keys& keys, ConstantFunction& function, const Quantity& value);
void describe(Keys& keys, ConstantSpeedDrive& function, const Quantity& value);
void describe(Keys& keys, RampToSpeedDrive& function, const Quantity& value);
void describe(Keys& keys, HarmonicFunction& function, const Quantity& value);
void describe(Keys& keys, RampFunction& function, const Quantity& value);
void describe(Keys& keys, HalfSineFunction& function, const Quantity& value);
/// The key "period" of what lasts for a time [s].
void describe_period(Keys& keys, double& period, double least);

// settings_keys.cpp

void describe(Keys& keys, SimulationSettings& settings);
void describe(Keys& keys, SensitivitySettings& settings);
void describe(Keys& keys, EffectSettings& settings);
void describe(Keys& keys, OptimizerSettings& settings);

}  // namespace pleuel
