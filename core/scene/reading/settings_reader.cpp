#include "core/scene/reading/settings_reader.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/base/machine_memory.hpp"
#include "core/scene/reading/key_reader.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/sample_design.hpp"
#include "core/scene/reading/tolerance.hpp"
#include "core/scene/sample_extent.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {
namespace {

constexpr int most_samples = 10000000;

}  // namespace

SensitivitySettings read_sensitivity(const JsonNode& node, NumberReader& numbers) {
  SensitivitySettings settings;
  settings.memory = default_memory();
  read_keys(node, numbers, settings);
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
  const Design<double> start = sample_designs(variables).front().design;
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
