#include "core/scene/reading/simulation_reader.hpp"

#include <fmt/format.h>

#include "core/scene/reading/initial_state_reader.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/tolerance.hpp"

namespace pleuel {
namespace {

constexpr double most_steps = 1e9;
constexpr double most_parts = 1e6;

void read_times(const JsonNode& node, const NumberReader& numbers, SimulationSettings& settings) {
  const JsonNode end_time = node.at("end_time"), step = node.at("step");
  settings.end_time = numbers.fixed(end_time, quantities::time, Range::positive);
  settings.step = numbers.fixed(step, quantities::time, Range::positive);
  if (settings.step > settings.end_time) {
    step.fail_with_value("must not be longer than the simulation");
  }
  if (settings.end_time / settings.step > most_steps) {
    step.fail_with_value(fmt::format("must not make more than {:g} steps", most_steps));
  }
}

void read_step_control(const JsonNode& node, const NumberReader& numbers,
                       SimulationSettings& settings) {
  const auto error = node.find("local_error"), smallest = node.find("smallest_step");
  if (error) {
    if (settings.scheme != SchemeType::generalized_alpha) {
      error->fail("is for the scheme \"generalized-alpha\" only");
    }
    if (settings.formulation.constraints == ConstraintForm::index_3) {
      error->fail("is for the formulations \"stabilized-index-2\" and \"index-1\" only");
    }
    settings.local_error = read_tolerance(*error);
  }
  if (!smallest) return;
  if (!error) smallest->fail("is for a simulation with \"local_error\" only");
  settings.smallest_step = numbers.fixed(*smallest, quantities::time, Range::positive);
  if (settings.smallest_step > settings.step)
    smallest->fail_with_value("must not be above the step");
  if (settings.step / settings.smallest_step > most_parts) {
    smallest->fail_with_value(
        fmt::format("must not be below the step by more than {:g}", most_parts));
  }
}

Formulation read_formulation(const JsonNode& node, const NumberReader& numbers) {
  Formulation formulation;
  if (const auto constraints = node.find("formulation")) {
    formulation.constraints = read_choice<ConstraintForm>(
        *constraints, {{"index-3", ConstraintForm::index_3},
                       {"stabilized-index-2", ConstraintForm::stabilized_index_2},
                       {"index-1", ConstraintForm::index_1}});
  }
  if (const auto baumgarte = node.find("baumgarte")) {
    if (formulation.constraints != ConstraintForm::index_1) {
      baumgarte->fail("is for the formulation \"index-1\" only");
    }
    formulation.baumgarte = numbers.fixed(*baumgarte, quantities::rate, Range::positive);
  }
  if (const auto projection = node.find("projection")) {
    formulation.is_projected = projection->truth();
    if (formulation.is_projected && formulation.constraints != ConstraintForm::index_1) {
      projection->fail("is for the formulation \"index-1\" only");
    }
  }
  return formulation;
}

}  // namespace

SimulationSettings read_simulation(const JsonNode& node, const NumberReader& numbers) {
  node.allow_keys({"end_time", "step", "scheme", "spectral_radius", "formulation", "baumgarte",
                   "projection", "newton_tolerance", "max_newton_iterations", "initial_state",
                   "local_error", "smallest_step", "moves_by_bending", "resolution_check"});
  SimulationSettings settings;
  read_times(node, numbers, settings);
  if (const auto scheme = node.find("scheme")) {
    settings.scheme =
        read_choice<SchemeType>(*scheme, {{"generalized-alpha", SchemeType::generalized_alpha},
                                          {"newmark", SchemeType::newmark},
                                          {"implicit-euler", SchemeType::implicit_euler}});
  }
  settings.formulation = read_formulation(node, numbers);
  read_step_control(node, numbers, settings);
  if (const auto radius = node.find("spectral_radius")) {
    settings.spectral_radius = numbers.fixed(*radius, quantities::pure_number, Range::fraction);
  }
  if (const auto tolerance = node.find("newton_tolerance")) {
    settings.newton_tolerance = read_tolerance(*tolerance);
  }
  if (const auto most = node.find("max_newton_iterations")) {
    settings.max_newton_iterations = most->whole_number(1, most_iterations);
  }
  if (const auto state = node.find("initial_state")) read_initial_state(*state, numbers, settings);
  if (const auto bends = node.find("moves_by_bending")) settings.moves_by_bending = bends->truth();
  if (const auto check = node.find("resolution_check")) settings.checks_resolution = check->truth();
  return settings;
}

}  // namespace pleuel
