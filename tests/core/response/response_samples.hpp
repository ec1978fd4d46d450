#pragma once

#include <random>

#include "core/response/lateral_buckling_signal.hpp"
#include "core/response/make_responses.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"

/// Every kind of response, asked of every body and joint of a sample.

namespace response_samples {

using namespace pleuel;

/// In the plane as far as the scene allows, or in space.
inline EffectSettings in_motion(EffectChoice spatial) {
  EffectSettings effects{.spatial_motion = spatial};
  return effects;
}

/// A sample whose material has strengths that depend on the design: a hundredth of E.
inline SampleScene sample_with_strength(int index) {
  SampleScene sample = all_samples()[index];
  for (Material& material : sample.scene.materials) {
    Number strength = material.young;
    strength.factor *= 0.01;
    strength.constant *= 0.01;
    material.strength = strength;
    material.ultimate_strength = strength;
    material.endurance_limit = strength;
    material.fatigue_strength = strength;
    material.fatigue_exponent = 4.0;
  }
  return sample;
}

/// Of an enumerator, for names.
template <class Enum>
std::string number(Enum value) {
  return std::to_string(static_cast<int>(value));
}

using All = std::vector<ResponseSettings>;

inline void add_beam_responses(const BodyModel& body, All& all) {
  const std::string& name = body.name;
  for (StressPart part : {StressPart::von_mises, StressPart::normal, StressPart::axial,
                          StressPart::bending, StressPart::shear, StressPart::utilization}) {
    all.push_back({name + " stress " + number(part), StressResponse{{{name}}, part}});
  }
  const bool is_general = body.beam.elements.front().section.shear_points.empty();
  if (!is_general) all.push_back({name + " shear stress", ShearStressResponse{{{name}}}});
  for (FatigueNumber kind : {FatigueNumber::utilization, FatigueNumber::damage}) {
    all.push_back({name + " fatigue " + number(kind), FatigueResponse{{{name}}, kind}});
  }
  const StressPlaces place{.bodies = {name}, .station = 0.37};
  all.push_back({name + " stress at 0.37", StressResponse{place, StressPart::normal}});
  all.push_back({name + " buckling", BucklingResponse{name}});
  for (int direction : {1, 2, 0, magnitude_direction}) {
    all.push_back({name + " deflection " + std::to_string(direction),
                   DeflectionResponse{.point = {name, 0.6}, .direction = direction}});
  }
  for (SectionForcePart part :
       {SectionForcePart::axial, SectionForcePart::moment_y, SectionForcePart::moment_z,
        SectionForcePart::torque, SectionForcePart::shear_y, SectionForcePart::shear_z}) {
    all.push_back(
        {name + " section force " + number(part), SectionForceResponse{name, 0.37, part}});
  }
}

inline void add_lateral_buckling(const BodyModel& body, const Model& model, All& all) {
  if (!make_lateral_buckling_signal(body.name, model)) return;  // nothing holds it
  all.push_back({body.name + " lateral buckling", LateralBucklingResponse{body.name}});
}

inline void add_spin_responses(const BodyModel& body, All& all) {
  for (TimeDerivative derivative : {TimeDerivative::first, TimeDerivative::second}) {
    for (int direction : {0, 1, 2, magnitude_direction}) {
      all.push_back({body.name + " turning " + number(derivative) + " " + std::to_string(direction),
                     TurningResponse{body.name, {direction}, derivative}});
    }
  }
  all.push_back({body.name + " angle", TurningResponse{body.name, {2}}});
}

inline void add_joint_motion(const JointModel& joint, All& all) {
  for (TimeDerivative derivative : {TimeDerivative::none, TimeDerivative::first}) {
    const std::string name = joint.name + " motion " + number(derivative);
    JointMotionResponse motion{joint.name, DrivenCoordinate::angle, derivative};
    if (joint.angle) all.push_back({name, motion});
    motion.coordinate = DrivenCoordinate::displacement;
    if (joint.displacement) all.push_back({name + " along", motion});
  }
}

inline void add_load_responses(const LoadModel& load, All& all) {
  if (!load.gauge) return;
  for (LoadNumber kind : {LoadNumber::spring_length, LoadNumber::spring_force,
                          LoadNumber::motor_power, LoadNumber::damper_power}) {
    all.push_back({load.name + " reading " + number(kind), LoadResponse{load.name, kind}});
  }
}

inline void add_motion_responses(const BodyModel& body, All& all) {
  const ResponsePoint point{body.name, 0.7};
  for (TimeDerivative derivative :
       {TimeDerivative::none, TimeDerivative::first, TimeDerivative::second}) {
    const std::string name = body.name + " motion " + number(derivative);
    for (int direction : {0, 1, 2, magnitude_direction}) {
      all.push_back({name + " " + std::to_string(direction),
                     PointMotionResponse{point, {direction}, derivative}});
    }
    const MotionComponent along{.along = {{0.48, 0.6, -0.64}}};
    all.push_back({name + " along", PointMotionResponse{point, along, derivative}});
  }
}

inline void add_joint_responses(const JointModel& joint, All& all) {
  for (ReactionKind kind : {ReactionKind::force, ReactionKind::moment}) {
    for (int direction : {0, 1, 2, magnitude_direction}) {
      all.push_back({joint.name + " reaction " + number(kind) + " " + std::to_string(direction),
                     ReactionResponse{joint.name, kind, direction}});
    }
  }
  if (joint.drive_row < 0) return;
  for (DriveNumber kind : {DriveNumber::torque, DriveNumber::power}) {
    all.push_back({joint.name + " drive " + number(kind), DriveResponse{joint.name, kind}});
  }
}

inline void add_monitor_responses(const Model& model, All& all) {
  for (EnergyKind kind : {EnergyKind::kinetic, EnergyKind::elastic}) {
    const std::string name = " energy " + number(kind);
    all.push_back({"all" + name, EnergyResponse{"", kind}});
    for (const BodyModel& body : model.bodies) {
      all.push_back({body.name + name, EnergyResponse{body.name, kind}});
    }
  }
  all.push_back({"energy balance", EnergyBalanceResponse{}});
  if (model.mechanism.system->multipliers() == 0) return;
  for (DriftLevel level : {DriftLevel::position, DriftLevel::velocity}) {
    all.push_back({"drift " + number(level), DriftResponse{level}});
  }
}

/// All responses with a history.
inline All all_histories(const Model& model) {
  All all;
  for (const BodyModel& body : model.bodies) {
    if (body.is_beam() && body.is_elastic) {
      add_beam_responses(body, all);
      add_lateral_buckling(body, model, all);
    }
    add_motion_responses(body, all);
    if (body.frame.rotations() > 0) add_spin_responses(body, all);
  }
  for (const JointModel& joint : model.joints) {
    add_joint_responses(joint, all);
    add_joint_motion(joint, all);
  }
  for (const LoadModel& load : model.loads) add_load_responses(load, all);
  add_monitor_responses(model, all);
  return all;
}

inline Eigen::VectorXd random_vector(Eigen::Index size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd vector(size);
  for (double& entry : vector) entry = uniform(random);
  return vector;
}

inline Eigen::VectorXd observed(Signal& signal, const State& state) {
  Eigen::VectorXd values(signal.channels());
  signal.observe(state, values);
  return values;
}

inline double observed(const Model& model, const AnyResponse& response, const State& state) {
  const std::vector<Response> responses = make_responses({{"observed", response}}, model);
  return observed(*responses.front().history()->signal, state)(0);
}

/// The three components of a reaction.
inline Eigen::Vector3d reaction(const Model& model, const std::string& joint, ReactionKind kind,
                                const State& state) {
  Eigen::Vector3d components;
  for (int direction : {0, 1, 2}) {
    const ReactionResponse response{joint, kind, direction};
    components(direction) = observed(model, response, state);
  }
  return components;
}

}  // namespace response_samples
