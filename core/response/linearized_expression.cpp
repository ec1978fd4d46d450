#include "core/response/linearized_expression.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

LinearizedResponse linearized(const Analysis& analysis, std::size_t response) {
  return numbers_of(analysis.responses, analysis.reductions, analysis.x).linearized(response);
}

void require_derivatives(const Analysis& analysis, std::size_t response) {
  const LinearizedResponse found = linearized(analysis, response);
  const bool is_finite = found.design.allFinite() &&
                         std::ranges::all_of(found.parts, [](const WeightedResponse& part) {
                           return std::isfinite(part.weight);
                         });
  if (is_finite) return;
  numbers_of(analysis.responses, analysis.reductions, analysis.x).refuse(response, "derivative");
}

double magnitude_of(const Analysis& analysis, std::size_t response) {
  const Eigen::MatrixXd& history = analysis.histories[response];
  if (history.size() > 0) return history.cwiseAbs().maxCoeff();
  double magnitude = std::abs(analysis.reductions[response].value);
  if (analysis.responses[response].expression() == nullptr) return magnitude;
  for (const WeightedResponse& part : linearized(analysis, response).parts) {
    magnitude = std::max(magnitude, std::abs(part.weight) * magnitude_of(analysis, part.response));
  }
  return magnitude;
}

bool depends_on_motion(const Analysis& analysis, std::size_t response) {
  const std::vector<WeightedResponse> parts = linearized(analysis, response).parts;
  return std::ranges::any_of(parts, [&](const WeightedResponse& part) {
    return analysis.histories[part.response].size() > 0;
  });
}

}  // namespace pleuel
