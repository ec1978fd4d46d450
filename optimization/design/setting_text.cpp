#include "optimization/design/setting_text.hpp"

#include <variant>

#include <fmt/format.h>

#include "core/scene/body_source.hpp"

namespace pleuel {

namespace {

std::string beam_text(const std::string& name, const BeamBody& beam) {
  std::string text = fmt::format("; {}:", name);
  for (const Segment& segment : beam.segments) {
    text += fmt::format(" {}", segment.elements);
    if (segment.fraction) text += fmt::format(" of {}", *segment.fraction);
  }
  if (beam.reduction) text += fmt::format(" +{} modes", beam.reduction->more_modes);
  return text;
}

std::string effects_text(const EffectSettings& effects) {
  std::string text = fmt::format("; effects {}", effects.tolerance);
  for (const auto& [body, estimates] : effects.decisions.estimates) {
    const auto& [elasticity, axial, torsional, stiffening, rotary] = estimates;
    text +=
        fmt::format(" {} {} {} {} {} {}", body, elasticity, axial, torsional, stiffening, rotary);
  }
  for (const auto& [name, effect] : effects.decisions.measured) {
    if (!effect.is_needed) text += fmt::format(" -{}/{}", name.first, name.second);
  }
  return text;
}

/// What is minimized and what is limited: the searches for the ends of a front differ in both.
std::string goals_text(const ProblemFile& file) {
  std::string text;
  if (file.objective) {
    const bool is_maximized = file.objective->aim == Aim::maximize;
    text +=
        fmt::format("; {} {}", is_maximized ? "maximize" : "minimize", file.objective->response);
  }
  text += "; limited";
  for (const ConstraintSettings& one : file.constraints) {
    text += fmt::format(" {}", one.response.empty() ? one.name : one.response);
  }
  return text;
}

}  // namespace

std::string setting_text(const ProblemFile& file) {
  const SimulationSettings& simulation = file.simulation;
  std::string text =
      fmt::format("step {} s, local error {}, smallest step {} s, newton {}", simulation.step,
                  simulation.local_error, simulation.smallest_step, simulation.newton_tolerance);
  for (const Body& body : file.scene.bodies) {
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) text += beam_text(body.name, *beam);
    const auto* imported = std::get_if<ImportedBody>(&body.shape);
    if (imported && imported->maker) {
      text += fmt::format("; {} made by {}", body.name, imported->maker->identity());
    }
  }
  text +=
      effects_text(file.effects) + "; gradients " + to_string(file.sensitivity.method) + "; start";
  for (const DesignVariable& variable : file.variables) text += fmt::format(" {}", variable.start);
  text += goals_text(file);
  if (!file.load_case.empty()) text += fmt::format("; case {}", file.load_case);
  return text;
}

}  // namespace pleuel
