#include "core/trust/far_bounds.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// Ranges of some thousand times the start still lead to the same optimum; of 10⁷ times neither SLSQP nor
/// MMA nor Ipopt finds it (`optimize problems/four_bar.json --set /variables/coupler_height/upper=1e6`).
constexpr double far_times = 1e5;

bool is_far(double bound, double other, double start) {
  const double size = std::max(std::abs(start), std::abs(other));
  return start != 0.0 && std::abs(bound) > far_times * size;
}

Finding far_bound(const DesignVariable& variable, const char* side, double bound,
                  const ShownUnit& unit) {
  return {fmt::format(
      "the {} bound of variable \"{}\" is {:.3g}{}, {:.1g} times its start: steps and scales of a "
      "search come from the range between the bounds, which says nothing here, and an optimum may "
      "be missed. Is a unit missing? Else give a bound that the design may come near.",
      side, variable.name, unit.shown(bound), unit.suffix(), std::abs(bound / variable.start))};
}

}  // namespace

std::vector<Finding> check_far_bounds(const ProblemFile& problem) {
  std::vector<Finding> findings;
  const std::vector<ShownUnit> units = variable_units(problem);
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    const auto see = [&](const char* side, double bound, double other) {
      if (!is_far(bound, other, variable.start)) return;
      findings.push_back(far_bound(variable, side, bound, units[i]));
    };
    see("lower", variable.lower, variable.upper);
    see("upper", variable.upper, variable.lower);
  }
  return findings;
}

}  // namespace pleuel
