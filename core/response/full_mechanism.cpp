#include "core/response/full_mechanism.hpp"

#include <algorithm>

namespace pleuel {

namespace {

void allow(EffectChoice& choice) {
  choice = EffectChoice::automatic;
}

/// As a plate that is normal to the one axis about which it has inertia.
void complete_inertia(RigidBody& body) {
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i < body.inertia.size(); ++i) {
    if (!body.inertia[i].is_bound() && body.inertia[i].constant == 0.0) without.push_back(i);
  }
  const bool is_about_one_axis = without.size() == 5 && without[2] == 3;
  if (!is_about_one_axis) return;
  const std::size_t axis = 3 - without[0] - without[1];
  Number half = body.inertia[axis];
  half.constant *= 0.5;
  half.factor *= 0.5;
  body.inertia[without[0]] = half;
  body.inertia[without[1]] = half;
}

bool asks_for_damping(const ProblemFile& problem) {
  return std::ranges::any_of(problem.responses, [](const ResponseSettings& response) {
    const auto* one = response.as<ModeResponse>();
    return one != nullptr && one->mode.counts_damping();
  });
}

bool has_modal_damping(const BeamBody& beam) {
  return beam.damping.modal.is_bound() || beam.damping.modal.constant != 0.0;
}

bool is_reduced(const Body& body) {
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  return beam != nullptr && beam->reduction.has_value();
}

}  // namespace

bool asks_for_mechanism_modes(const ProblemFile& problem) {
  return std::ranges::any_of(problem.responses, [](const ResponseSettings& response) {
    const auto* one = response.as<ModeResponse>();
    return one != nullptr && one->body.empty();
  });
}

bool has_all_modes(const ProblemFile& problem, const Model& model) {
  const EffectSettings& effects = problem.effects;
  const bool is_spatial = std::ranges::none_of(model.effects, [](const auto& effect) {
    return effect.name == "spatial_motion" && !effect.is_built;
  });
  return is_spatial && effects.tolerance == 0.0 && effects.axial_elasticity != EffectChoice::off &&
         effects.torsional_elasticity != EffectChoice::off &&
         std::ranges::none_of(problem.scene.bodies, is_reduced);
}

ProblemFile with_all_modes(const ProblemFile& problem) {
  ProblemFile full = problem;
  full.effects.spatial_motion = EffectChoice::on;
  allow(full.effects.axial_elasticity);
  allow(full.effects.torsional_elasticity);
  full.effects.tolerance = 0.0;
  full.effects.decisions = {};
  for (Body& body : full.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      if (asks_for_damping(problem) && has_modal_damping(*beam)) continue;
      beam->reduction.reset();
      beam->damping.modal = {};
    } else if (auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      complete_inertia(*rigid);
    }
  }
  return full;
}

std::unique_ptr<FullMechanism> make_full_mechanism(const ProblemFile& problem,
                                                   const Design<double>& start,
                                                   const Design<double>& design,
                                                   const Differentiation& differentiation) {
  const ProblemFile all = with_all_modes(problem);
  auto full = std::make_unique<FullMechanism>();
  full->model = build_model(all.scene, all.effects, start, design, differentiation);
  if (!asks_for_mechanism_modes(problem)) return full;
  full->vibrating = vibration_state(full->model.mechanism);
  return full;
}

}  // namespace pleuel
