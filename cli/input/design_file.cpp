#include "cli/input/design_file.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/syntax_error.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/scene/variable_quantity.hpp"

namespace pleuel {

namespace {

void check_names(const JsonNode& variables, const ProblemFile& problem) {
  std::vector<std::string> known;
  for (const DesignVariable& variable : problem.variables) known.push_back(variable.name);
  for (const auto& [name, member] : variables.members()) {
    if (std::ranges::find(known, name) != known.end()) continue;
    fail_unknown_name(variables, "design variable", name, known);
  }
}

/// A number in the unit that stands beside it, by default SI ("1" of a pure number); or a text with
/// unit.
double read_number(const std::optional<JsonNode>& unit, const JsonNode& value,
                   const UnitSystem& units, const Quantity& quantity) {
  const JsonNode& written = value.value().is_string() || !unit ? value : *unit;
  try {
    if (value.value().is_string()) return units.read(value.text(), quantity);
    const bool is_si = !unit || unit->text() == quantity.unit;
    return value.number() * (is_si ? 1.0 : units.scale(unit->text(), quantity));
  } catch (const UnitError& error) {
    written.fail_with_value("must be " + describe(quantity), fmt::format(": {}", error.what()));
  }
}

/// {"value", "unit"}, or the value alone.
double read_value(const JsonNode& node, const DesignVariable& variable, const UnitSystem& units,
                  const Quantity& quantity) {
  const JsonNode value = node.value().is_object() ? node.at("value") : node;
  for (const SizeChoice& choice : variable.choices) {
    if (value.value().is_string() && value.text() == choice.text) return choice.value;
  }
  const auto unit = node.value().is_object() ? node.find("unit") : std::nullopt;
  const double x = read_number(unit, value, units, quantity);
  if (x < variable.lower || x > variable.upper) {
    value.fail_with_value("must lie within the bounds of " + bounds_text(variable, quantity),
                          value.value().is_number() && !unit ? " in SI units" : "");
  }
  return x;
}

/// The member "variables" of what a command has written, or the whole document.
JsonNode variables_of(const JsonNode& root) {
  const bool is_result = root.find("variables") || root.find("status");
  return is_result ? root.at("variables") : root;
}

}  // namespace

Eigen::VectorXd read_design(const std::filesystem::path& path, const ProblemFile& problem) {
  if (std::filesystem::is_directory(path)) return read_design(path / "result.json", problem);
  const std::string file = path.string();
  const Json document = parse_json(read_text_file(path), file);
  const JsonNode root(document, file, "", "the design");
  const JsonNode variables = variables_of(root);
  check_names(variables, problem);
  const UnitSystem units;
  Eigen::VectorXd x(problem.variables.size());
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    x(i) = read_value(variables.at(variable.name), variable, units,
                      variable_quantity(problem, static_cast<int>(i)));
  }
  return x;
}

}  // namespace pleuel
