#include "sensitivity/unknown_derivatives.hpp"

#include <fmt/format.h>

#include "core/scene/scene_rules.hpp"

namespace pleuel {

std::vector<std::string> unknown_derivatives(const ProblemFile& problem, const Design<double>& x) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    if (variable.lower < variable.upper) continue;
    if (const auto moved = find_point_moved_along(problem.scene, x, i)) {
      sentences.push_back(fmt::format(
          "the derivatives with respect to \"{}\" are not those of the mechanism: it {}",
          variable.name, *moved));
    }
  }
  return sentences;
}

}  // namespace pleuel
