#include "core/scene/reading/variable_reader.hpp"

#include <fmt/format.h>

namespace pleuel {
namespace {

/// The unit in the first of the texts that has one.
std::string written_unit(std::initializer_list<JsonNode> nodes) {
  for (const JsonNode& node : nodes) {
    if (!node.value().is_string()) continue;
    const std::string unit = split_quantity(node.value().get<std::string>()).unit;
    if (!unit.empty()) return unit;
  }
  return "";
}

DesignVariable read_variable(const std::string& name, const JsonNode& node,
                             const Quantity& quantity, const NumberReader& numbers) {
  node.allow_keys({"start", "lower", "upper"});
  const JsonNode start = node.at("start"), lower = node.at("lower"), upper = node.at("upper");
  DesignVariable variable;
  variable.name = name;
  variable.start = numbers.fixed(start, quantity);
  variable.lower = numbers.fixed(lower, quantity);
  variable.upper = numbers.fixed(upper, quantity);
  variable.unit = written_unit({start, lower, upper});
  if (variable.lower > variable.upper) lower.fail_with_value("must not be above the upper bound");
  if (variable.start < variable.lower) start.fail_with_value("must not be below the lower bound");
  if (variable.start > variable.upper) start.fail_with_value("must not be above the upper bound");
  return variable;
}

void check_range(const VariableUse& use, const DesignVariable& variable) {
  struct Sample {
    double value;
    const char* where;
  };
  for (const Sample& sample :
       {Sample{variable.start, "start value"}, Sample{variable.lower, "lower bound"},
        Sample{variable.upper, "upper bound"}}) {
    const double value = use.number.constant + use.number.factor * sample.value;
    if (is_within(use.range, value)) continue;
    use.node.fail(fmt::format("{}, got {:g} with the variable \"{}\" at its {}",
                              rule_of(use.range, use.quantity), value, variable.name,
                              sample.where));
  }
}

}  // namespace

std::vector<DesignVariable> read_variables(const JsonNode& node, const NumberReader& numbers) {
  std::vector<DesignVariable> variables;
  for (const auto& [name, member] : node.members()) {
    const auto quantity = numbers.quantity_of(static_cast<int>(variables.size()));
    if (!quantity) {
      member.fail("is not used: no number of the scene and no linear constraint names it");
    }
    variables.push_back(read_variable(name, member, *quantity, numbers));
  }
  for (const VariableUse& use : numbers.uses()) {
    check_range(use, variables[static_cast<std::size_t>(use.number.variable)]);
  }
  return variables;
}

}  // namespace pleuel
