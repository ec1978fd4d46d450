#include "core/scene/reading/settings_reader.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/base/machine_memory.hpp"
#include "core/scene/reading/initial_state_reader.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/sample.hpp"
#include "core/scene/sample_extent.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {
namespace {

constexpr int most_iterations = 1000000;
constexpr int most_samples = 10000000;
constexpr double most_steps = 1e9;
constexpr double most_parts = 1e6;

/// A tolerance of one or more asks for nothing.
double read_tolerance(const JsonNode& node) {
  if (node.number() <= 0.0 || node.number() >= 1.0) {
    node.fail_with_value("must be greater than 0 and less than 1");
  }
  return node.number();
}

EffectChoice read_effect(const JsonNode& node) {
  return read_choice<EffectChoice>(
      node,
      {{"auto", EffectChoice::automatic}, {"on", EffectChoice::on}, {"off", EffectChoice::off}});
}

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

}  // namespace

void check_effects(const JsonNode& node, const ProblemFile& problem) {
  const EffectSettings& effects = problem.effects;
  const bool has_elastic_body =
      std::any_of(problem.scene.bodies.begin(), problem.scene.bodies.end(), [](const Body& body) {
        const auto* beam = std::get_if<BeamBody>(&body.shape);
        return std::holds_alternative<ImportedBody>(body.shape) || (beam && !beam->is_rigid);
      });
  const bool is_rigid = effects.elasticity == EffectChoice::off;
  for (const auto& [key, choice] :
       {std::pair("elasticity", effects.elasticity),
        std::pair("axial_elasticity", effects.axial_elasticity),
        std::pair("torsional_elasticity", effects.torsional_elasticity),
        std::pair("geometric_stiffening", effects.geometric_stiffening)}) {
    if (choice != EffectChoice::on) continue;
    if (!has_elastic_body) node.at(key).fail("is \"on\", but all bodies are rigid");
    if (is_rigid) node.at(key).fail("is \"on\", but /effects/elasticity is \"off\"");
  }
  if (effects.geometric_stiffening == EffectChoice::on &&
      effects.axial_elasticity == EffectChoice::off) {
    node.at("geometric_stiffening")
        .fail(
            "is \"on\", but /effects/axial_elasticity is \"off\": the axial force that stiffens "
            "comes from axial strain; leave out \"axial_elasticity\", or set it to \"on\"");
  }
}

EffectSettings read_effects(const JsonNode& node) {
  node.allow_keys({"spatial_motion", "geometric_stiffening", "rotary_inertia", "elasticity",
                   "axial_elasticity", "torsional_elasticity", "tolerance"});
  EffectSettings effects;
  for (const auto& [key, effect] :
       {std::pair("spatial_motion", &effects.spatial_motion),
        std::pair("geometric_stiffening", &effects.geometric_stiffening),
        std::pair("rotary_inertia", &effects.rotary_inertia),
        std::pair("elasticity", &effects.elasticity),
        std::pair("axial_elasticity", &effects.axial_elasticity),
        std::pair("torsional_elasticity", &effects.torsional_elasticity)}) {
    if (const auto choice = node.find(key)) *effect = read_effect(*choice);
  }
  if (const auto tolerance = node.find("tolerance")) {
    effects.tolerance = tolerance->number();
    if (!is_within(Range::below_one, effects.tolerance)) {
      tolerance->fail_with_value(rule_of(Range::below_one, quantities::pure_number));
    }
  }
  return effects;
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

SimulationSettings read_simulation(const JsonNode& node, const NumberReader& numbers) {
  node.allow_keys({"end_time", "step", "scheme", "spectral_radius", "formulation", "baumgarte",
                   "projection", "newton_tolerance", "max_newton_iterations", "initial_state",
                   "local_error", "smallest_step", "resolution_check"});
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
  if (const auto check = node.find("resolution_check")) settings.checks_resolution = check->truth();
  return settings;
}

namespace {

void read_invariant_derivatives(const JsonNode& node, InvariantDifferentiation& invariants) {
  using enum InvariantDerivatives;
  if (const auto derivatives = node.find("invariant_derivatives")) {
    invariants.derivatives = read_choice(*derivatives, invariant_derivatives);
  }
  const auto step = node.find("invariant_step");
  if (!step) return;
  if (invariants.derivatives != central && invariants.derivatives != forward) {
    step->fail("is for the invariant derivatives \"central\" and \"forward\" only");
  }
  invariants.step = read_tolerance(*step);
}

}  // namespace

SensitivitySettings read_sensitivity(const JsonNode& node, const NumberReader& numbers) {
  node.allow_keys(
      {"method", "difference_step", "invariant_derivatives", "invariant_step", "memory"});
  SensitivitySettings settings;
  if (const auto method = node.find("method")) {
    settings.method = read_choice(*method, gradient_methods);
  }
  if (const auto step = node.find("difference_step")) {
    settings.difference_step = read_tolerance(*step);
  }
  read_invariant_derivatives(node, settings.invariants);
  const auto memory = node.find("memory");
  settings.memory =
      memory ? numbers.fixed(*memory, quantities::data, Range::positive) : default_memory();
  return settings;
}

namespace {

constexpr int most_starts = 10000;

/// The start of the variables, with those that the node names at other values.
std::vector<double> read_start(const JsonNode& node, const std::vector<DesignVariable>& variables,
                               const NumberReader& numbers) {
  std::vector<double> start;
  for (const DesignVariable& variable : variables) start.push_back(variable.start);
  for (const auto& [name, value] : node.members()) {
    const std::size_t i = numbers.variable(value, name);
    const Quantity quantity = *numbers.quantity_of(static_cast<int>(i));
    start[i] = numbers.fixed(value, quantity);
    if (start[i] < variables[i].lower || start[i] > variables[i].upper) {
      value.fail_with_value("must lie within the bounds of " + bounds_text(variables[i], quantity));
    }
  }
  return start;
}

void read_starts(const JsonNode& node, const std::vector<DesignVariable>& variables,
                 const NumberReader& numbers, OptimizerSettings& settings) {
  if (!node.value().is_array()) {
    settings.starts = node.whole_number(1, most_starts);
    return;
  }
  for (const JsonNode& item : node.items()) {
    settings.given_starts.push_back(read_start(item, variables, numbers));
  }
  settings.starts = 1 + static_cast<int>(settings.given_starts.size());
}

}  // namespace

OptimizerSettings read_optimizer(const JsonNode& node, const std::vector<DesignVariable>& variables,
                                 const NumberReader& numbers) {
  node.allow_keys({"backend", "tolerance", "max_iterations", "starts"});
  OptimizerSettings settings;
  if (const auto backend = node.find("backend")) {
    settings.backend = backend->text();
    settings.names_backend = true;
  }
  if (const auto starts = node.find("starts")) read_starts(*starts, variables, numbers, settings);
  if (const auto tolerance = node.find("tolerance"))
    settings.tolerance = read_tolerance(*tolerance);
  if (const auto most = node.find("max_iterations")) {
    settings.max_iterations = most->whole_number(1, most_iterations);
  }
  return settings;
}

namespace {

std::vector<std::string> read_names(const JsonNode& node,
                                    const std::vector<ResponseSettings>& responses) {
  std::vector<std::string> known, names;
  for (const ResponseSettings& response : responses) known.push_back(response.name);
  for (const JsonNode& item : node.items()) {
    names.push_back(read_known_name(item, "response", known));
  }
  return names;
}

}  // namespace

AccuracySettings read_accuracy(const JsonNode& node, const std::vector<ResponseSettings>& responses,
                               const NumberReader& numbers) {
  node.allow_keys({"target", "responses", "steps", "elements", "error"});
  AccuracySettings settings;
  // The older name was of the study only: it makes no verdict stricter.
  if (const auto error = node.find("error")) {
    settings.target = std::max(settings.target, read_tolerance(*error));
  }
  if (const auto steps = node.find("steps")) {
    for (const JsonNode& step : steps->items()) {
      settings.steps.push_back(numbers.fixed(step, quantities::time, Range::positive));
    }
    if (settings.steps.empty()) steps->fail("must have at least one step");
  }
  if (const auto elements = node.find("elements")) {
    for (const JsonNode& number : elements->items()) {
      settings.elements.push_back(number.whole_number(1, most_elements));
    }
    if (settings.elements.empty()) elements->fail("must have at least one number");
  }
  if (const auto names = node.find("responses")) {
    settings.responses = read_names(*names, responses);
  }
  if (const auto target = node.find("target")) {
    settings.chooses_setting = true;
    settings.target = numbers.fixed(*target, quantities::pure_number);
    if (settings.target <= 0.0 || settings.target >= 1.0) {
      target->fail_with_value("must be greater than 0 and less than 1");
    }
  }
  return settings;
}

namespace {

UncertainParameter read_parameter(const std::string& name, const JsonNode& node,
                                  const NumberReader& numbers) {
  node.allow_keys({"deviation", "interval"});
  UncertainParameter parameter{numbers.variable(node, name)};
  const auto quantity = numbers.quantity_of(parameter.variable);
  const auto deviation = node.find("deviation"), interval = node.find("interval");
  if (deviation.has_value() == interval.has_value()) {
    node.fail("must have either a deviation or an interval");
  }
  if (!quantity) node.fail("is not used by the scene");
  if (deviation) parameter.deviation = numbers.fixed(*deviation, *quantity, Range::positive);
  if (interval) parameter.interval = numbers.fixed(*interval, *quantity, Range::positive);
  return parameter;
}

/// The numbers of the scene that depend on the parameter must make sense in all of its range.
void check_range(const JsonNode& node, const UncertainParameter& parameter,
                 const std::vector<DesignVariable>& variables, const NumberReader& numbers) {
  const Design<double> start = make_samples(variables).front().design;
  for (const VariableUse& use : numbers.uses()) {
    if (!use.number.depends_on(parameter.variable)) continue;
    for (const double sign : {-1.0, 1.0}) {
      Design<double> design = start;
      design[parameter.variable] += sign * sample_extent(parameter);
      const double value = resolve(use.number, design);
      if (is_within(use.range, value)) continue;
      node.fail(fmt::format("leads to {:g} for {}, which {}", value, use.node.place(),
                            rule_of(use.range, use.quantity)));
    }
  }
}

}  // namespace

UncertaintySettings read_uncertainty(const JsonNode& node, const NumberReader& numbers,
                                     const std::vector<DesignVariable>& variables) {
  node.allow_keys({"parameters", "samples", "seed"});
  UncertaintySettings settings;
  for (const auto& [name, parameter] : node.at("parameters").members()) {
    settings.parameters.push_back(read_parameter(name, parameter, numbers));
    check_range(parameter, settings.parameters.back(), variables, numbers);
  }
  if (settings.parameters.empty()) node.at("parameters").fail("must have at least one parameter");
  if (const auto samples = node.find("samples")) {
    settings.samples = samples->whole_number(2, most_samples);
  }
  if (const auto seed = node.find("seed")) {
    settings.seed = static_cast<unsigned>(seed->whole_number(0, most_samples));
  }
  return settings;
}

}  // namespace pleuel
