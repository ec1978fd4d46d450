#include "core/scene/variable_quantity.hpp"

#include <optional>

#include "core/scene/visit_numbers.hpp"

namespace pleuel {

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
