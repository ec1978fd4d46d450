#include "core/scene/reading/variable_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/symbols.hpp"

namespace pleuel {
namespace {

/// As the user wrote it, if with its unit.
std::string choice_text(const JsonNode& node, double value) {
  if (node.value().is_string() && !is_formula(node)) return node.text();
  return fmt::format("{:g}", value);
}

/// In ascending order, each once.
std::vector<SizeChoice> read_sizes(const JsonNode& node, const Quantity& quantity,
                                   const NumberReader& numbers) {
  std::vector<SizeChoice> choices;
  for (const JsonNode& one : node.items()) {
    const double value = numbers.fixed(one, quantity);
    choices.push_back({value, choice_text(one, value)});
  }
  if (choices.empty()) node.fail("must have at least one choice");
  std::ranges::stable_sort(choices, [](const SizeChoice& one, const SizeChoice& other) {
    return one.value < other.value;
  });
  const auto is_same = [](const SizeChoice& one, const SizeChoice& other) {
    return one.value == other.value;
  };
  choices.erase(std::unique(choices.begin(), choices.end(), is_same), choices.end());
  return choices;
}

/// One number out of a list. Without a start it begins in the middle of the list.
DesignVariable read_chosen(const std::string& name, const JsonNode& node, const Quantity& quantity,
                           const NumberReader& numbers) {
  node.allow_keys({"start", "choices"});
  const JsonNode list = node.at("choices");
  DesignVariable variable;
  variable.name = name;
  variable.choices = read_sizes(list, quantity, numbers);
  variable.lower = variable.choices.front().value;
  variable.upper = variable.choices.back().value;
  variable.start = variable.choices[(variable.choices.size() - 1) / 2].value;
  if (const auto start = node.find("start")) {
    variable.start = numbers.fixed(*start, quantity);
    if (std::ranges::none_of(variable.choices,
                             [&](const SizeChoice& one) { return one.value == variable.start; })) {
      start->fail_with_value("must be one of the choices");
    }
  }
  for (const JsonNode& one : list.items()) {
    if (variable.unit.empty()) variable.unit = written_unit({one});
  }
  variable.quantity = quantity;
  return variable;
}

/// The names of sections, which section_choices.hpp wrote.
void read_entries(const JsonNode& node, DesignVariable& variable) {
  for (const JsonNode& name : node.items()) {
    variable.choices.push_back({static_cast<double>(variable.choices.size()), name.text()});
  }
}

DesignVariable read_variable(const std::string& name, const JsonNode& node,
                             const Quantity& quantity, const NumberReader& numbers) {
  if (node.find("choices")) return read_chosen(name, node, quantity, numbers);
  node.allow_keys({"start", "lower", "upper", "entries"});
  const JsonNode start = node.at("start"), lower = node.at("lower"), upper = node.at("upper");
  DesignVariable variable;
  variable.name = name;
  variable.start = numbers.fixed(start, quantity);
  variable.lower = numbers.fixed(lower, quantity);
  variable.upper = numbers.fixed(upper, quantity);
  variable.unit = written_unit({start, lower, upper});
  variable.quantity = quantity;
  if (const auto entries = node.find("entries")) read_entries(*entries, variable);
  const auto must_not = [](const JsonNode& number, const char* side, const JsonNode& bound) {
    const std::string text = bound.value().is_string() ? bound.text() : bound.value().dump();
    number.fail_with_value(fmt::format("must not be {} bound of {}", side, text));
  };
  if (variable.lower > variable.upper) must_not(lower, "above the upper", upper);
  if (variable.start < variable.lower) must_not(start, "below the lower", lower);
  if (variable.start > variable.upper) must_not(start, "above the upper", upper);
  return variable;
}

/// At the start, and with each variable at either bound.
void check_range(const VariableUse& use, const std::vector<SampleDesign>& samples,
                 const std::vector<DesignVariable>& variables) {
  for (const auto& [design, where] : samples) {
    const double value = resolve(use.number, design);
    if (is_within(use.range, value)) continue;
    const std::string rule = rule_of(use.range, use.quantity);
    if (use.number.expression) {
      use.node.fail_with_value(
          rule, fmt::format(", which is {:g}{}", value, where.empty() ? " at the start" : where));
    }
    use.node.fail(fmt::format("{}, got {:g}{}", rule, value,
                              where.empty()
                                  ? fmt::format(" with the variable \"{}\" at its start value",
                                                variables[use.number.variable].name)
                                  : where.substr(1)));
  }
}

}  // namespace

std::vector<DesignVariable> read_variables(const JsonNode& node, const NumberReader& numbers) {
  for (const VariableMention& mention : numbers.mentions()) numbers.check_mention(mention);
  std::vector<DesignVariable> variables;
  int index = 0;
  read_each(node, [&](const std::string& name, const JsonNode& member) {
    const auto quantity = numbers.quantity_of(index++);
    if (!quantity) {
      member.fail(
          "is not used: no number of the scene, no formula and no linear constraint names it");
    }
    variables.push_back(read_variable(name, member, *quantity, numbers));
  });
  const std::vector<SampleDesign> samples = sample_designs(variables);
  for (const VariableUse& use : numbers.uses()) check_range(use, samples, variables);
  return variables;
}

std::vector<std::string> variable_names(const JsonNode& root) {
  std::vector<std::string> names;
  if (const auto variables = root.find("variables")) {
    for (const auto& [name, variable] : variables->members()) names.push_back(name);
  }
  return names;
}

Design<double> start_values(const std::vector<DesignVariable>& variables) {
  Design<double> start;
  for (const DesignVariable& variable : variables) start.push_back(variable.start);
  return start;
}

std::vector<SampleDesign> sample_designs(const std::vector<DesignVariable>& variables) {
  const SampleDesign start{start_values(variables), ""};
  std::vector<SampleDesign> samples = {start};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    for (const auto& [bound, word] :
         {std::pair(variables[i].lower, "lower"), std::pair(variables[i].upper, "upper")}) {
      SampleDesign sample = start;
      sample.design[i] = bound;
      sample.where =
          fmt::format(", with the variable \"{}\" at its {} bound", variables[i].name, word);
      samples.push_back(sample);
    }
  }
  return samples;
}

}  // namespace pleuel
