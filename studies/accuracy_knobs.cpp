#include "studies/accuracy_knobs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/model/effect_decisions.hpp"
#include "core/scene/grammar/tables.hpp"
#include "core/scene/reading/json_text.hpp"

namespace pleuel {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Steps that follow the local error begin with so many times the step of the problem.
constexpr double longer = 4.0;

/// Puts a value into the member that a key of a table fills.
class MemberSetter : public Keys {
 public:
  MemberSetter(std::string word, const Override& one) : word_(std::move(word)), one_(one) {}

  using Keys::fixed;
  void fixed(const Key& key, KeyMember<double> member, const Measure&, std::string_view) override {
    set(key, member);
  }
  void plain(const Key& key, double& member, Range, std::string_view) override {
    set<double>(key, member);
  }
  void whole(const Key& key, KeyMember<int> member, const WholeRange&, std::string_view) override {
    set(key, member);
  }
  void flag(const Key& key, bool& member, std::string_view) override { set<bool>(key, member); }
  void chosen(const Key& key, std::size_t& index, const std::vector<std::string_view>& words,
              std::string_view) override {
    if (key.word != word_) return;
    index = std::ranges::find(words, std::get<std::string>(one_.value)) - words.begin();
  }

 private:
  template <class Value>
  void set(const Key& key, KeyMember<Value> member) const {
    if (key.word == word_) member.get() = std::get<Value>(one_.value);
  }

  std::string word_;
  const Override& one_;
};

std::string reduction_of(const Body& body) {
  return child_pointer("/scene/bodies", body.name) + "/reduction";
}

void set(const Override& one, ProblemFile& problem) {
  const std::size_t end = one.pointer.rfind('/');
  const std::string object = one.pointer.substr(0, end), word = one.pointer.substr(end + 1);
  MemberSetter setter(word, one);
  if (word == "formulation") problem.simulation.formulation = {};
  if (object == "/simulation") describe(setter, problem.simulation);
  if (object == "/effects") describe(setter, problem.effects);
  if (object == "/scene/gravity")
    problem.scene.gravity[std::stoi(word)] = std::get<double>(one.value);
  for (Body& body : problem.scene.bodies) {
    auto* beam = std::get_if<BeamBody>(&body.shape);
    const bool is_reduced = beam != nullptr && beam->reduction;
    if (is_reduced && object == reduction_of(body)) describe(setter, *beam->reduction);
  }
}

Variation make_formulation(const char* name, const char* key, bool is_projected = false) {
  return {
      "formulation",
      name,
      {{"/simulation/formulation", std::string(key)}, {"/simulation/projection", is_projected}}};
}
const Variation index_3 = make_formulation("index-3", "index-3");
const Variation stabilized = make_formulation("stabilized-index-2", "stabilized-index-2");
const Variation plain = make_formulation("index-1", "index-1");
const Variation projected = make_formulation("index-1 with projection", "index-1", true);

void add_formulations(const ProblemFile& problem, std::vector<Variation>& all) {
  const SimulationSettings& settings = problem.simulation;
  if (settings.formulation.baumgarte > 0.0) return;
  for (const Variation& one : {index_3, stabilized, plain, projected}) {
    const Formulation other = one.of(problem).simulation.formulation;
    const bool fits = settings.local_error == 0.0 || other.constraints != ConstraintForm::index_3;
    const bool is_same = other.constraints == settings.formulation.constraints &&
                         other.is_projected == settings.formulation.is_projected;
    if (fits && !is_same) all.push_back(one);
  }
}

/// Another value of a number in /simulation.
Variation make_number_change(const std::string& key, double value) {
  return {key, fmt::format("{:g}", value), {{"/simulation/" + key, value}}};
}

void add_schemes(const ProblemFile& problem, std::vector<Variation>& all) {
  const SimulationSettings& settings = problem.simulation;
  const double own = settings.spectral_radius;
  // Newmark's is of second order for this radius only, and unstable with it in index 3.
  const bool is_index_3 = settings.formulation.constraints == ConstraintForm::index_3;
  const auto add = [&](const char* name, SchemeType type, double radius) {
    if (settings.scheme == type || settings.local_error > 0.0) return;
    all.push_back(
        {"scheme",
         name,
         {{"/simulation/scheme", std::string(name)}, {"/simulation/spectral_radius", radius}}});
  };
  add("generalized-alpha", SchemeType::generalized_alpha, 0.8);
  add("newmark", SchemeType::newmark, is_index_3 ? own : 1.0);
  add("implicit-euler", SchemeType::implicit_euler, own);
  if (settings.scheme != SchemeType::generalized_alpha) return;
  for (const double radius : {0.0, 0.5, 0.8, 0.9}) {
    if (std::abs(radius - own) < 0.05) continue;
    all.push_back(make_number_change("spectral_radius", radius));
  }
}

void add_newton_tolerances(const ProblemFile& problem, std::vector<Variation>& all) {
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    const double ratio = tolerance / problem.simulation.newton_tolerance;
    if (ratio > 0.2 && ratio < 5.0) continue;
    all.push_back(make_number_change("newton_tolerance", tolerance));
  }
}

/// Steps that follow the local error, in a formulation that allows it.
Variation make_step_control(const ProblemFile& problem, double error) {
  const SimulationSettings& settings = problem.simulation;
  Variation control = make_number_change("local_error", error);
  const auto prepend = [&](const std::vector<Override>& before) {
    control.overrides.insert(control.overrides.begin(), before.begin(), before.end());
  };
  if (settings.local_error == 0.0) prepend({{"/simulation/step", longer * settings.step}});
  if (settings.formulation.constraints == ConstraintForm::index_3) prepend(stabilized.overrides);
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
  Variation scaled{"modes", fmt::format("×{:g}", factor), {}};
  for (const Body& body : problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || !beam->reduction) continue;
    if (beam->reduction->modes) {
      const int modes = static_cast<int>(std::floor(factor * *beam->reduction->modes));
      if (modes != *beam->reduction->modes) {
        scaled.overrides.push_back({reduction_of(body) + "/modes", modes});
      }
    } else if (beam->reduction->frequency) {
      const double hertz = factor * *beam->reduction->frequency / (2.0 * pi);
      scaled.overrides.push_back({reduction_of(body) + "/frequency", hertz});
    }
  }
  return scaled.overrides.empty() ? std::nullopt : std::optional(scaled);
}

/// What is nothing, or nothing but noise, in a rigid mechanism.
bool is_of_elasticity(const ResponseSettings& response) {
  return stress_places(response) || response.is(EnergyKind::elastic) ||
         response.is<DeflectionResponse, ModeResponse, BucklingResponse, LateralBucklingResponse>();
}

bool needs_elasticity(const ProblemFile& problem) {
  return std::ranges::any_of(problem.responses, is_of_elasticity);
}

Override make_choice(const std::string& effect, const char* choice) {
  return {"/effects/" + effect, std::string(choice)};
}

Variation make_effect(const BeamEffect& effect, const char* choice) {
  return {effect.name, choice, {make_choice(effect.name, choice)}};
}

/// What cannot be without the effect is left out with it.
Variation deactivate(const BeamEffect& effect, const ProblemFile& problem, bool is_stiffened) {
  Variation without = make_effect(effect, "off");
  const EffectSettings& settings = problem.effects;
  if (effect.choice == &EffectSettings::axial_elasticity && is_stiffened) {
    without.knob = "axial_elasticity and geometric_stiffening";
    without.overrides.push_back(make_choice("geometric_stiffening", "off"));
  }
  if (effect.choice != &EffectSettings::elasticity) return without;
  for (const BeamEffect& part : beam_effects) {
    const bool is_elastic = part.choice != &EffectSettings::elasticity &&
                            part.choice != &EffectSettings::rotary_inertia;
    if (is_elastic && settings.*part.choice == EffectChoice::on) {
      without.overrides.push_back(make_choice(part.name, "off"));
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

/// Whether a body is built with the effect, or without it where it would do something.
bool has_record(const char* effect, bool is_built, const Model& model) {
  return std::ranges::any_of(model.effects, [&](const EffectRecord& record) {
    return record.name == effect && record.is_built == is_built &&
           (is_built || record.kind != EffectRecord::Kind::exact);
  });
}

void add_gravity(const ProblemFile& problem, std::vector<Variation>& all) {
  const auto is_zero = [](const Number& number) { return number.constant == 0.0; };
  const auto& gravity = problem.scene.gravity;
  if (std::ranges::all_of(gravity, is_zero)) return;
  Variation without{"gravity", "off", {}};
  for (int i = 0; i < 3; ++i) {
    without.overrides.push_back({fmt::format("/scene/gravity/{}", i), 0.0});
  }
  all.push_back(std::move(without));
}

}  // namespace

ProblemFile Variation::of(ProblemFile problem) const {
  for (const Override& one : overrides) set(one, problem);
  return problem;
}

Variation other_formulation(const ProblemFile& problem) {
  const Formulation& formulation = problem.simulation.formulation;
  if (formulation.constraints != ConstraintForm::stabilized_index_2) return stabilized;
  // Steps that follow the local error are not for index 3.
  return problem.simulation.local_error == 0.0 ? index_3 : projected;
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
  const bool is_stiffened = has_record("geometric_stiffening", true, model);
  for (const BeamEffect& effect : beam_effects) {
    if (effect.choice == &EffectSettings::elasticity && needs_elasticity(problem)) continue;
    if (has_record(effect.name, true, model)) {
      all.push_back(deactivate(effect, problem, is_stiffened));
    } else if (has_record(effect.name, false, model) && is_possible(effect, problem.effects)) {
      all.push_back(make_effect(effect, "on"));
    }
  }
  add_gravity(problem, all);
  return all;
}

}  // namespace pleuel
