#include "studies/accuracy_knobs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/model/effect_decisions.hpp"
#include "core/scene/reading/json_text.hpp"

namespace pleuel {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Steps that follow the local error begin with so many times the step of the problem.
constexpr double longer = 4.0;

Variation make_formulation(const char* name, const char* key, Formulation formulation) {
  return {"formulation",
          name,
          {{"/simulation/formulation", std::string(key)},
           {"/simulation/projection", formulation.is_projected}},
          [=](ProblemFile& problem) { problem.simulation.formulation = formulation; }};
}

Variation make_stabilized() {
  return make_formulation("stabilized-index-2", "stabilized-index-2",
                          {ConstraintForm::stabilized_index_2});
}

bool is_same(const Formulation& one, const Formulation& other) {
  return one.constraints == other.constraints && one.is_projected == other.is_projected;
}

void add_formulations(const ProblemFile& problem, std::vector<Variation>& all) {
  const SimulationSettings& settings = problem.simulation;
  if (settings.formulation.baumgarte > 0.0) return;
  const std::array<Variation, 4> known = {
      make_formulation("index-3", "index-3", {ConstraintForm::index_3}), make_stabilized(),
      make_formulation("index-1", "index-1", {ConstraintForm::index_1}),
      make_formulation("index-1 with projection", "index-1", {ConstraintForm::index_1, 0.0, true})};
  for (const Variation& one : known) {
    const Formulation other = one.of(problem).simulation.formulation;
    const bool fits = settings.local_error == 0.0 || other.constraints != ConstraintForm::index_3;
    if (fits && !is_same(other, settings.formulation)) all.push_back(one);
  }
}

Variation make_scheme_change(const char* name, SchemeType type, double radius) {
  return {"scheme",
          name,
          {{"/simulation/scheme", std::string(name)}, {"/simulation/spectral_radius", radius}},
          [=](ProblemFile& problem) {
            problem.simulation.scheme = type;
            problem.simulation.spectral_radius = radius;
          }};
}

void add_schemes(const ProblemFile& problem, std::vector<Variation>& all) {
  const SimulationSettings& settings = problem.simulation;
  const bool is_alpha = settings.scheme == SchemeType::generalized_alpha;
  if (settings.local_error == 0.0) {
    // Of second order for this radius only, and unstable with it in index 3.
    const bool is_index_3 = settings.formulation.constraints == ConstraintForm::index_3;
    const double radius = is_index_3 ? settings.spectral_radius : 1.0;
    if (!is_alpha) {
      all.push_back(make_scheme_change("generalized-alpha", SchemeType::generalized_alpha, 0.8));
    }
    if (settings.scheme != SchemeType::newmark) {
      all.push_back(make_scheme_change("newmark", SchemeType::newmark, radius));
    }
    if (settings.scheme != SchemeType::implicit_euler) {
      all.push_back(make_scheme_change("implicit-euler", SchemeType::implicit_euler,
                                       settings.spectral_radius));
    }
  }
  if (!is_alpha) return;
  for (const double radius : {0.0, 0.5, 0.8, 0.9}) {
    if (std::abs(radius - settings.spectral_radius) < 0.05) continue;
    all.push_back(
        {"spectral_radius",
         fmt::format("{:g}", radius),
         {{"/simulation/spectral_radius", radius}},
         [radius](ProblemFile& changed) { changed.simulation.spectral_radius = radius; }});
  }
}

void add_newton_tolerances(const ProblemFile& problem, std::vector<Variation>& all) {
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    const double ratio = tolerance / problem.simulation.newton_tolerance;
    if (ratio > 0.2 && ratio < 5.0) continue;
    all.push_back(
        {"newton_tolerance",
         fmt::format("{:g}", tolerance),
         {{"/simulation/newton_tolerance", tolerance}},
         [tolerance](ProblemFile& changed) { changed.simulation.newton_tolerance = tolerance; }});
  }
}

/// Steps that follow the local error, in a formulation that allows it.
Variation make_step_control(const ProblemFile& problem, double error) {
  const bool is_new = problem.simulation.local_error == 0.0;
  const double step = problem.simulation.step * (is_new ? longer : 1.0);
  Variation control = make_stabilized();
  control.knob = "local_error";
  control.value = fmt::format("{:g}", error);
  const bool changes_formulation =
      problem.simulation.formulation.constraints == ConstraintForm::index_3;
  if (!changes_formulation) control.overrides.clear();
  if (is_new) control.overrides.push_back({"/simulation/step", step});
  control.overrides.push_back({"/simulation/local_error", error});
  control.change = [=](ProblemFile& changed) {
    SimulationSettings& settings = changed.simulation;
    if (changes_formulation) settings.formulation = {ConstraintForm::stabilized_index_2};
    settings.step = step;
    settings.local_error = error;
  };
  return control;
}

void add_step_control(const ProblemFile& problem, std::vector<Variation>& all) {
  const SimulationSettings& settings = problem.simulation;
  if (settings.scheme != SchemeType::generalized_alpha) return;
  if (settings.local_error > 0.0) {
    for (const double factor : {10.0, 0.1}) {
      const double error = factor * settings.local_error;
      if (error < 1.0) all.push_back(make_step_control(problem, error));
    }
  } else if (longer * settings.step <= 0.25 * settings.end_time) {
    for (const double error : {1e-3, 1e-4, 1e-5}) {
      all.push_back(make_step_control(problem, error));
    }
  }
}

/// Of all reduced beams, so many times as many modes, or up to so many times the frequency.
std::optional<Variation> scaled_modes(const ProblemFile& problem, double factor) {
  Variation scaled{"modes", fmt::format("×{:g}", factor), {}, {}};
  for (const Body& body : problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || !beam->reduction) continue;
    const std::string pointer = child_pointer("/scene/bodies", body.name) + "/reduction";
    if (beam->reduction->modes) {
      const int modes = static_cast<int>(std::floor(factor * *beam->reduction->modes));
      if (modes != *beam->reduction->modes) scaled.overrides.push_back({pointer + "/modes", modes});
    } else if (beam->reduction->frequency) {
      const double hertz = factor * *beam->reduction->frequency / (2.0 * pi);
      scaled.overrides.push_back({pointer + "/frequency", hertz});
    }
  }
  if (scaled.overrides.empty()) return std::nullopt;
  scaled.change = [factor](ProblemFile& changed) {
    for (Body& body : changed.scene.bodies) {
      auto* beam = std::get_if<BeamBody>(&body.shape);
      if (beam == nullptr || !beam->reduction) continue;
      CraigBampton& reduction = *beam->reduction;
      if (reduction.modes)
        *reduction.modes = static_cast<int>(std::floor(factor * *reduction.modes));
      if (reduction.frequency) *reduction.frequency *= factor;
    }
  };
  return scaled;
}

/// Whether a response is nothing, or nothing but noise, in a rigid mechanism.
bool needs_elasticity(const ProblemFile& problem) {
  return std::any_of(problem.responses.begin(), problem.responses.end(),
                     [](const ResponseSettings& response) {
                       switch (response.type) {
                         case ResponseType::stress:
                         case ResponseType::fatigue:
                         case ResponseType::fatigue_damage:
                         case ResponseType::shear_stress:
                         case ResponseType::deflection:
                         case ResponseType::frequency:
                         case ResponseType::damping_ratio:
                         case ResponseType::growth_rate:
                         case ResponseType::buckling:
                         case ResponseType::lateral_buckling:
                         case ResponseType::elastic_energy:
                           return true;
                         default:
                           return false;
                       }
                     });
}

Variation make_effect(const BeamEffect& effect, EffectChoice choice) {
  const std::string value = choice == EffectChoice::on ? "on" : "off";
  return {
      effect.name,
      value,
      {{fmt::format("/effects/{}", effect.name), value}},
      [member = effect.choice, choice](ProblemFile& problem) { problem.effects.*member = choice; }};
}

/// What cannot be without the effect is left out with it.
void leave_out_with(const char* name, EffectChoice EffectSettings::*member, Variation& variation) {
  variation.overrides.push_back({fmt::format("/effects/{}", name), std::string("off")});
  variation.change = [member, change = variation.change](ProblemFile& problem) {
    change(problem);
    problem.effects.*member = EffectChoice::off;
  };
}

Variation deactivate(const BeamEffect& effect, const ProblemFile& problem, bool is_stiffened) {
  Variation without = make_effect(effect, EffectChoice::off);
  const EffectSettings& settings = problem.effects;
  if (effect.choice == &EffectSettings::axial_elasticity && is_stiffened) {
    without.knob = "axial_elasticity and geometric_stiffening";
    leave_out_with("geometric_stiffening", &EffectSettings::geometric_stiffening, without);
  }
  if (effect.choice != &EffectSettings::elasticity) return without;
  for (const BeamEffect& part : beam_effects) {
    const bool is_elastic = part.choice != &EffectSettings::elasticity &&
                            part.choice != &EffectSettings::rotary_inertia;
    if (is_elastic && settings.*part.choice == EffectChoice::on) {
      leave_out_with(part.name, part.choice, without);
    }
  }
  return without;
}

/// Whether something in the file forbids what the effect needs.
bool is_possible(const BeamEffect& effect, const EffectSettings& settings) {
  if (effect.choice == &EffectSettings::rotary_inertia) return true;
  if (effect.choice == &EffectSettings::elasticity) return true;
  if (settings.elasticity == EffectChoice::off) return false;
  return effect.choice != &EffectSettings::geometric_stiffening ||
         settings.axial_elasticity != EffectChoice::off;
}

bool is_there(const char* effect, const Model& model) {
  return std::any_of(model.effects.begin(), model.effects.end(), [&](const EffectRecord& record) {
    return record.name == effect && record.is_built;
  });
}

/// Whether the effect is left out of a body where it would do something.
bool is_left_out(const char* effect, const Model& model) {
  return std::any_of(model.effects.begin(), model.effects.end(), [&](const EffectRecord& record) {
    return record.name == effect && !record.is_built && record.kind != EffectRecord::Kind::exact;
  });
}

void add_gravity(const ProblemFile& problem, std::vector<Variation>& all) {
  const auto is_zero = [](const Number& number) { return number.constant == 0.0; };
  const auto& gravity = problem.scene.gravity;
  if (std::all_of(gravity.begin(), gravity.end(), is_zero)) return;
  Variation without{"gravity", "off", {}, [](ProblemFile& changed) {
                      changed.scene.gravity = {0.0, 0.0, 0.0};
                    }};
  for (int i = 0; i < 3; ++i) {
    without.overrides.push_back({fmt::format("/scene/gravity/{}", i), 0.0});
  }
  all.push_back(std::move(without));
}

}  // namespace

Variation other_formulation(const ProblemFile& problem) {
  const Formulation& formulation = problem.simulation.formulation;
  if (formulation.constraints != ConstraintForm::stabilized_index_2) return make_stabilized();
  // Steps that follow the local error are not for index 3.
  if (problem.simulation.local_error == 0.0) {
    return make_formulation("index-3", "index-3", {ConstraintForm::index_3});
  }
  return make_formulation("index-1 with projection", "index-1",
                          {ConstraintForm::index_1, 0.0, true});
}

std::vector<Variation> numerical_variations(const ProblemFile& problem) {
  std::vector<Variation> all;
  for (const double factor : {0.5, 2.0}) {
    if (auto modes = scaled_modes(problem, factor)) all.push_back(std::move(*modes));
  }
  add_formulations(problem, all);
  add_schemes(problem, all);
  add_newton_tolerances(problem, all);
  add_step_control(problem, all);
  return all;
}

std::vector<Variation> effect_variations(const ProblemFile& problem, const Model& model) {
  std::vector<Variation> all;
  const bool is_stiffened = is_there("geometric_stiffening", model);
  for (const BeamEffect& effect : beam_effects) {
    if (effect.choice == &EffectSettings::elasticity && needs_elasticity(problem)) continue;
    if (is_there(effect.name, model)) {
      all.push_back(deactivate(effect, problem, is_stiffened));
    } else if (is_left_out(effect.name, model) && is_possible(effect, problem.effects)) {
      all.push_back(make_effect(effect, EffectChoice::on));
    }
  }
  add_gravity(problem, all);
  return all;
}

}  // namespace pleuel
