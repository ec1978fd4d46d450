#include "studies/missing_settings.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {
namespace {

std::string quantity_text(double value, const ShownUnit& unit) {
  if (unit.name == "1") return significant(value, 3);
  return fmt::format("\"{} {}\"", significant(unit.shown(value), 3), unit.name);
}

/// From half of a limit to twice of it, in all load cases; empty without a limit that can be varied.
std::string pareto_example(const ProblemFile& problem) {
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const ConstraintSettings& constraint = problem.constraints[i];
    const double limit = constraint.upper.value_or(constraint.lower.value_or(0.0));
    const bool has_two = constraint.upper && constraint.lower;
    if (constraint.response.empty() || has_two || limit == 0.0) continue;
    const ShownUnit unit = unit_of(problem, constraint);
    return fmt::format(
        R"(, for instance "pareto": {{"constraint": "{}", "from": {}, "to": {}, "points": 7}})",
        limit_name(problem, i), quantity_text(0.5 * limit, unit), quantity_text(2.0 * limit, unit));
  }
  return "";
}

/// A hundredth of its start as the deviation of the first variable.
std::string uncertainty_example(const ProblemFile& problem) {
  if (problem.variables.empty() || problem.variables[0].start == 0.0) return "";
  const DesignVariable& variable = problem.variables[0];
  return fmt::format(
      R"(, for instance "uncertainty": {{"parameters": {{"{}": {{"deviation": {}}}}}}})",
      variable.name,
      quantity_text(0.01 * std::abs(variable.start), variable_units(problem).front()));
}

}  // namespace

void require_pareto(const ProblemFile& problem) {
  if (problem.pareto) return;
  throw InputError("/pareto is missing: it says which limit to vary" + pareto_example(problem));
}

void require_uncertainty(const ProblemFile& problem) {
  if (problem.uncertainty) return;
  throw InputError("/uncertainty is missing: it says which parameters are uncertain" +
                   uncertainty_example(problem));
}

}  // namespace pleuel
