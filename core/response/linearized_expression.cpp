#include "core/response/linearized_expression.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/response/expression_value.hpp"

namespace pleuel {

namespace {

class Linearization {
 public:
  explicit Linearization(const Analysis& analysis)
      : analysis_(analysis), design_(Eigen::VectorXd::Zero(analysis.x.size())) {}

  void add(std::size_t response, double weight) {
    const Expression* expression = analysis_.responses[response].expression();
    if (expression == nullptr) {
      weights_[response] += weight;
      return;
    }
    const ExpressionValue at = evaluate_at(analysis_.reductions, analysis_.x, *expression);
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

  LinearizedResponse take() && {
    LinearizedResponse found;
    for (const auto& [response, weight] : weights_) found.parts.push_back({response, weight});
    found.design = std::move(design_);
    return found;
  }

 private:
  const Analysis& analysis_;
  std::map<std::size_t, double> weights_;
  Eigen::VectorXd design_;
};

}  // namespace

LinearizedResponse linearized(const Analysis& analysis, std::size_t response) {
  Linearization linearization(analysis);
  linearization.add(response, 1.0);
  return std::move(linearization).take();
}

void require_derivatives(const Analysis& analysis, std::size_t response) {
  const LinearizedResponse found = linearized(analysis, response);
  const bool is_finite =
      found.design.allFinite() &&
      std::all_of(found.parts.begin(), found.parts.end(),
                  [](const WeightedResponse& part) { return std::isfinite(part.weight); });
  if (!is_finite) {
    refuse_expression(analysis.responses, analysis.reductions, response, "derivative");
  }
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
  return std::any_of(parts.begin(), parts.end(), [&](const WeightedResponse& part) {
    return analysis.histories[part.response].size() > 0;
  });
}

}  // namespace pleuel
