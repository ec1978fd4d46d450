#include "core/scene/reading/settings_reader.hpp"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/reading/key_reader.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/variable_reader.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

constexpr int most_samples = 10000000;
constexpr int most_starts = 10000;

/// The start of the variables, with those that the node names at other values.
std::vector<double> read_start(const JsonNode& node, const std::vector<DesignVariable>& variables,
                               const NumberReader& numbers) {
  std::vector<double> start = start_values(variables);
  for (const auto& [name, value] : node.members()) {
    const std::size_t i = numbers.variable(value, name);
    start[i] = numbers.fixed(value, variables[i].quantity);
    if (start[i] < variables[i].lower || start[i] > variables[i].upper) {
      value.fail_with_value("must lie within the bounds of " + bounds_text(variables[i]));
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
  settings.starts = 1 + int_size(settings.given_starts);
}

}  // namespace

OptimizerSettings read_optimizer(const JsonNode& node, const std::vector<DesignVariable>& variables,
                                 NumberReader& numbers) {
  OptimizerSettings settings;
  read_keys(node, numbers, settings);
  settings.names_backend = node.find("backend").has_value();
  if (const auto starts = node.find("starts")) read_starts(*starts, variables, numbers, settings);
  return settings;
}

namespace {

std::vector<std::string> read_names(const JsonNode& node,
                                    const std::vector<ResponseSettings>& responses,
                                    const NumberReader& numbers) {
  const std::vector<std::string> known = names_of(responses);
  std::vector<std::string> names;
  for (const JsonNode& item : node.items()) {
    if (numbers.leaves_out(item.text())) continue;
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
    const double given = numbers.fixed(*error, quantities::pure_number, Range::tolerance);
    settings.target = std::max(settings.target, given);
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
    settings.responses = read_names(*names, responses, numbers);
  }
  if (const auto target = node.find("target")) {
    settings.chooses_setting = true;
    settings.target = numbers.fixed(*target, quantities::pure_number, Range::tolerance);
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
  for (const VariableUse& use : numbers.uses()) {
    if (!use.number.depends_on(parameter.variable)) continue;
    for (const double sign : {-1.0, 1.0}) {
      Design<double> design = start_values(variables);
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

namespace {

enum class InitialState { consistent, quasi_static, periodic };

/// The end is a whole number of periods up to round-off: it becomes exact.
void fit_to_end(const JsonNode& node, SimulationSettings& settings) {
  constexpr double round_off = 1e-6;
  const double periods = settings.end_time / settings.period, whole = std::round(periods);
  if (whole < 1.0 || std::abs(periods - whole) > round_off * whole) {
    node.fail_with_value(fmt::format(
        "must fit into /simulation/end_time a whole number of times, and does so {:.6g} times",
        periods));
  }
  settings.period = settings.end_time / whole;
}

/// What a motion that repeats itself cannot be combined with.
void check_periodic(const JsonNode& node, const SimulationSettings& settings) {
  const Formulation& formulation = settings.formulation;
  if (formulation.constraints == ConstraintForm::index_1 && formulation.baumgarte == 0.0 &&
      !formulation.is_projected) {
    node.fail(
        "is \"periodic\", but with the formulation \"index-1\" joints drift apart, which does not "
        "repeat itself: add \"projection\": true or \"baumgarte\", or take another formulation");
  }
  if (settings.local_error > 0.0) {
    node.fail(
        "is \"periodic\", which needs the same steps in each period: leave out \"local_error\"");
  }
}

void read_initial_state(const JsonNode& node, const NumberReader& numbers,
                        SimulationSettings& settings) {
  const bool is_object = node.value().is_object();
  if (is_object) node.allow_keys({"type", "period"});
  const auto type = read_choice<InitialState>(is_object ? node.at("type") : node,
                                              {{"consistent", InitialState::consistent},
                                               {"quasi-static", InitialState::quasi_static},
                                               {"periodic", InitialState::periodic}});
  settings.quasi_static_start = type == InitialState::quasi_static;
  const auto period = is_object ? node.find("period") : std::nullopt;
  if (type != InitialState::periodic) {
    if (period) period->fail("is for the initial state \"periodic\" only");
    return;
  }
  check_periodic(node, settings);
  settings.period = settings.end_time;
  if (!period) return;
  settings.period = numbers.fixed(*period, quantities::time, Range::positive);
  fit_to_end(*period, settings);
}

}  // namespace

SimulationSettings read_simulation(const JsonNode& node, NumberReader& numbers) {
  SimulationSettings settings;
  read_keys(node, numbers, settings);
  if (const auto state = node.find("initial_state")) read_initial_state(*state, numbers, settings);
  return settings;
}

void check_effects(const JsonNode& node, const ProblemFile& problem) {
  const EffectSettings& effects = problem.effects;
  const bool has_elastic_body = std::ranges::any_of(problem.scene.bodies, is_elastic);
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

}  // namespace pleuel
