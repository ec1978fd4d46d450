#pragma once

#include <random>

#include "core/response/lateral_buckling_signal.hpp"
#include "core/response/make_responses.hpp"
#include "core/scene/response_kind.hpp"
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

inline void add(ResponseSettings settings, const std::string& name,
                std::vector<ResponseSettings>& all) {
  settings.name = name;
  all.push_back(settings);
}

inline void add_beam_responses(const BodyModel& body, std::vector<ResponseSettings>& all) {
  ResponseSettings settings;
  settings.type = ResponseType::stress;
  settings.bodies = {body.name};
  for (StressPart part : {StressPart::von_mises, StressPart::normal, StressPart::axial,
                          StressPart::bending, StressPart::shear, StressPart::utilization}) {
    settings.part = part;
    add(settings, body.name + " stress " + number(part), all);
  }
  settings.part = StressPart::von_mises;
  for (ResponseType type :
       {ResponseType::shear_stress, ResponseType::fatigue, ResponseType::fatigue_damage}) {
    settings.type = type;
    settings.name = body.name + " of stress " + number(type);
    const bool is_general = body.beam.elements.front().section.shear_points.empty();
    if (type != ResponseType::shear_stress || !is_general) all.push_back(settings);
  }
  settings.type = ResponseType::stress;
  settings.part = StressPart::normal;
  settings.station = 0.37;
  add(settings, body.name + " stress at 0.37", all);
  settings.station = {};
  settings.type = ResponseType::buckling;
  add(settings, body.name + " buckling", all);
  settings.type = ResponseType::deflection;
  settings.at = 0.6;
  for (int direction : {1, 2, 0, magnitude_direction}) {
    settings.direction = direction;
    add(settings, body.name + " deflection " + std::to_string(direction), all);
  }
  settings.type = ResponseType::section_force;
  settings.station = 0.37;
  for (SectionForcePart part :
       {SectionForcePart::axial, SectionForcePart::moment_y, SectionForcePart::moment_z,
        SectionForcePart::torque, SectionForcePart::shear_y, SectionForcePart::shear_z}) {
    settings.section_part = part;
    add(settings, body.name + " section force " + number(part), all);
  }
}

inline void add_lateral_buckling(const BodyModel& body, const Model& model,
                                 std::vector<ResponseSettings>& all) {
  if (!make_lateral_buckling_signal(body.name, model)) return;  // nothing holds it
  ResponseSettings settings;
  settings.type = ResponseType::lateral_buckling;
  settings.bodies = {body.name};
  add(settings, body.name + " lateral buckling", all);
}

inline void add_spin_responses(const BodyModel& body, std::vector<ResponseSettings>& all) {
  ResponseSettings settings;
  settings.bodies = {body.name};
  for (ResponseType type : {ResponseType::angular_velocity, ResponseType::angular_acceleration}) {
    settings.type = type;
    for (int direction : {0, 1, 2, magnitude_direction}) {
      settings.direction = direction;
      add(settings, body.name + " turning " + number(type) + " " + std::to_string(direction), all);
    }
  }
  settings.type = ResponseType::angle;
  settings.direction = 2;
  add(settings, body.name + " angle", all);
}

inline void add_joint_motion(const JointModel& joint, std::vector<ResponseSettings>& all) {
  ResponseSettings settings;
  settings.joint = joint.name;
  for (ResponseType type : {ResponseType::joint_position, ResponseType::joint_velocity}) {
    settings.type = type;
    settings.name = joint.name + " motion " + number(type);
    settings.coordinate = DrivenCoordinate::angle;
    if (joint.angle) all.push_back(settings);
    settings.coordinate = DrivenCoordinate::displacement;
    settings.name += " along";
    if (joint.displacement) all.push_back(settings);
  }
}

inline void add_load_responses(const LoadModel& load, std::vector<ResponseSettings>& all) {
  ResponseSettings settings;
  settings.load = load.name;
  for (ResponseType type : {ResponseType::spring_length, ResponseType::spring_force,
                            ResponseType::motor_power, ResponseType::damper_power}) {
    settings.type = type;
    settings.name = load.name + " reading " + number(type);
    if (load.gauge) all.push_back(settings);
  }
}

inline void add_motion_responses(const BodyModel& body, std::vector<ResponseSettings>& all) {
  ResponseSettings settings;
  settings.bodies = {body.name};
  settings.at = 0.7;
  for (ResponseType type :
       {ResponseType::position, ResponseType::velocity, ResponseType::acceleration}) {
    settings.type = type;
    for (int direction : {0, 1, 2, magnitude_direction}) {
      settings.direction = direction;
      add(settings, body.name + " motion " + number(type) + " " + std::to_string(direction), all);
    }
    settings.along = {{0.48, 0.6, -0.64}};
    add(settings, body.name + " motion " + number(type) + " along", all);
    settings.along = std::nullopt;
  }
}

inline void add_joint_responses(const JointModel& joint, std::vector<ResponseSettings>& all) {
  ResponseSettings settings;
  settings.joint = joint.name;
  for (ResponseType type : {ResponseType::reaction_force, ResponseType::reaction_moment}) {
    settings.type = type;
    for (int direction : {0, 1, 2, magnitude_direction}) {
      settings.direction = direction;
      add(settings, joint.name + " reaction " + number(type) + " " + std::to_string(direction),
          all);
    }
  }
  if (joint.drive_row < 0) return;
  for (ResponseType type : {ResponseType::drive_torque, ResponseType::drive_power}) {
    settings.type = type;
    add(settings, joint.name + " drive " + number(type), all);
  }
}

inline void add_energy(ResponseType type, const std::vector<std::string>& bodies,
                       std::vector<ResponseSettings>& all) {
  ResponseSettings settings;
  settings.type = type;
  settings.bodies = bodies;
  add(settings, (bodies.empty() ? "all" : bodies.front()) + " energy " + number(type), all);
}

inline void add_monitor_responses(const Model& model, std::vector<ResponseSettings>& all) {
  for (ResponseType type : {ResponseType::kinetic_energy, ResponseType::elastic_energy}) {
    add_energy(type, {}, all);
    for (const BodyModel& body : model.bodies) add_energy(type, {body.name}, all);
  }
  add_energy(ResponseType::energy_balance, {}, all);
  if (model.mechanism.system->multipliers() == 0) return;
  ResponseSettings settings;
  settings.type = ResponseType::constraint_drift;
  for (DriftLevel level : {DriftLevel::position, DriftLevel::velocity}) {
    settings.level = level;
    add(settings, "drift " + number(level), all);
  }
}

/// All responses with a history.
inline std::vector<ResponseSettings> all_histories(const Model& model) {
  std::vector<ResponseSettings> all;
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

inline double observed(const Model& model, const ResponseSettings& settings, const State& state) {
  const std::vector<Response> responses = make_responses({settings}, model);
  return observed(*responses.front().history()->signal, state)(0);
}

/// The three components of a reaction.
inline Eigen::Vector3d reaction(const Model& model, const std::string& joint, ResponseType type,
                                const State& state) {
  Eigen::Vector3d components;
  for (int direction : {0, 1, 2}) {
    ResponseSettings settings;
    settings.type = type;
    settings.direction = direction;
    settings.joint = joint;
    components(direction) = observed(model, settings, state);
  }
  return components;
}

}  // namespace response_samples
