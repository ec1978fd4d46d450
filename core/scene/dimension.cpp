#include "core/scene/dimension.hpp"

#include <optional>

#include <fmt/format.h>

#include "core/scene/named_quantities.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {

namespace {

/// "m^2"
std::string factor(std::size_t base, double power) {
  const char* name = Dimension::bases[base];
  return power == 1.0 ? name : fmt::format("{}^{:.4g}", name, power);
}

void append(std::string& text, const std::string& more) {
  if (!text.empty()) text += " ";
  text += more;
}

}  // namespace

std::string base_units(const Dimension& dimension) {
  std::string above, below;
  std::size_t count_below = 0;
  for (const std::size_t base : {1U, 0U, 3U, 4U, 5U, 6U, 7U, 8U, 2U}) {
    const double power = dimension.powers[base];
    if (power > 1e-9) append(above, factor(base, power));
    if (power < -1e-9) {
      append(below, factor(base, -power));
      ++count_below;
    }
  }
  if (below.empty()) return above.empty() ? "1" : above;
  if (above.empty()) above = "1";
  if (count_below == 1) return above + "/" + below;
  // without brackets: "kg/m/s^2"
  for (std::size_t at = below.find(' '); at != std::string::npos; at = below.find(' ', at)) {
    below[at] = '/';
  }
  return above + "/" + below;
}

bool has_dimension(const Quantity& quantity, const Dimension& dimension, const UnitSystem& units) {
  return units.measure(std::string(quantity.unit)).dimension == dimension;
}

std::optional<Quantity> find_quantity(const Dimension& dimension, const UnitSystem& units) {
  for (const Quantity& quantity : named_quantities) {
    if (has_dimension(quantity, dimension, units)) return quantity;
  }
  return std::nullopt;
}

std::string describe(const Dimension& dimension, const UnitSystem& units) {
  if (const auto quantity = find_quantity(dimension, units)) return describe(*quantity);
  return fmt::format("a quantity [{}]", base_units(dimension));
}

namespace {

std::optional<Quantity> find_quantity(const Scene& scene, int variable) {
  std::optional<Quantity> found;
  visit_numbers(scene, [&](const Number& number, const Quantity& quantity) {
    if (!found && number.variable == variable) found.emplace(quantity);
  });
  return found;
}

bool names(const ConstraintSettings& constraint, int variable) {
  for (const auto& [other, coefficient] : constraint.linear) {
    if (other == variable) return true;
  }
  return false;
}

}  // namespace

Quantity variable_quantity(const ProblemFile& problem, int variable) {
  if (const auto quantity = find_quantity(problem.scene, variable)) return *quantity;
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (!names(constraint, variable)) continue;
    for (const auto& [other, coefficient] : constraint.linear) {
      if (const auto quantity = find_quantity(problem.scene, other)) return *quantity;
    }
  }
  return problem.variables[variable].quantity.value_or(quantities::pure_number);
}

}  // namespace pleuel
