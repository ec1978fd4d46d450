#include "core/response/expression_value.hpp"

#include <cmath>
#include <string>

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

}  // namespace pleuel
