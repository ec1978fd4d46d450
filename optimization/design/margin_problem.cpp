#include "optimization/design/margin_problem.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "optimization/robust_problem.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

std::unique_ptr<Problem> with_margins(
    Problem& problem, const DesignProblem& design,
    const std::vector<std::optional<std::size_t>>& constraint_of_row) {
  Eigen::VectorXd margins = Eigen::VectorXd::Zero(Eigen::Index(constraint_of_row.size()));
  for (std::size_t row = 0; row < constraint_of_row.size(); ++row) {
    if (!constraint_of_row[row]) continue;
    margins(row) = design.file().constraints[*constraint_of_row[row]].deviations;
  }
  if (margins.isZero(0.0)) return nullptr;
  if (is_difference(design.file().sensitivity.method)) {
    throw InputError(
        "/sensitivity/method must be \"auto\", \"direct\" or \"adjoint\" where a constraint has "
        "\"deviations\": their gradients are differences of gradients");
  }
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(Eigen::Index(problem.variables().size()));
  deviations.head(Eigen::Index(design.variables().size())) = design.variable_deviations();
  return std::make_unique<RobustProblem>(problem, deviations, margins);
}

}  // namespace pleuel
