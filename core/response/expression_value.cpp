#include "core/response/expression_value.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

using ArgumentKind = ExpressionArgument::Kind;

/// ", with a = 1, b = 0": the responses that the formula names.
std::string arguments_text(const std::vector<Response>& responses,
                           const std::vector<Reduction>& reductions, const Expression& expression) {
  std::string text;
  for (const ExpressionArgument& argument : expression.arguments) {
    if (argument.kind != ArgumentKind::response) continue;
    text += fmt::format("{}{} = {:.6g}", text.empty() ? ", with " : ", ",
                        responses[argument.index].name, reductions[argument.index].value);
  }
  return text;
}

}  // namespace

ExpressionValue evaluate_at(const std::vector<Reduction>& reductions, const Eigen::VectorXd& x,
                            const Expression& expression) {
  std::vector<double> arguments;
  for (const ExpressionArgument& argument : expression.arguments) {
    arguments.push_back(argument.kind == ArgumentKind::variable ? x(argument.index)
                                                                : reductions[argument.index].value);
  }
  return evaluate(expression, arguments);
}

double expression_value(const std::vector<Response>& responses,
                        const std::vector<Reduction>& reductions, const Eigen::VectorXd& x,
                        std::size_t response) {
  const double value = evaluate_at(reductions, x, *responses[response].expression()).value;
  if (!std::isfinite(value)) refuse_expression(responses, reductions, response, "value");
  return value;
}

void refuse_expression(const std::vector<Response>& responses,
                       const std::vector<Reduction>& reductions, std::size_t response,
                       const char* what) {
  const Expression& expression = *responses[response].expression();
  throw SimulationError(fmt::format("the response \"{}\" has no finite {} there: \"{}\"{}",
                                    responses[response].name, what, expression.text,
                                    arguments_text(responses, reductions, expression)));
}

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
