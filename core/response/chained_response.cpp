#include "core/response/chained_response.hpp"

#include <utility>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

ChainedResponse::ChainedResponse(Eigen::Index variables, ExpressionOf expression_of,
                                 Evaluated evaluated)
    : expression_of_(std::move(expression_of)),
      evaluated_(std::move(evaluated)),
      design_(Eigen::VectorXd::Zero(variables)) {}

LinearizedResponse ChainedResponse::linearized(std::size_t response) && {
  add(response, 1.0);
  LinearizedResponse found;
  for (const auto& [part, weight] : weights_) found.parts.push_back({part, weight});
  found.design = std::move(design_);
  return found;
}

void ChainedResponse::add(std::size_t response, double weight) {
  const Expression* expression = expression_of_(response);
  if (expression == nullptr) {
    weights_[response] += weight;
    return;
  }
  const ExpressionValue at = evaluated_(response, *expression);
  for (std::size_t i = 0; i < expression->arguments.size(); ++i) {
    const ExpressionArgument& argument = expression->arguments[i];
    const double share = weight * at.derivatives[i];
    if (argument.kind == ExpressionArgument::Kind::response) {
      add(argument.index, share);
    } else {
      design_(argument.index) += share;
    }
  }
}

}  // namespace pleuel
