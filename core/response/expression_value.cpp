#include "core/response/expression_value.hpp"

#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

bool is_response(const ExpressionArgument& argument) {
  return argument.kind == ExpressionArgument::Kind::response;
}

/// What counts of responses that are no expressions, and of the design.
struct CountedParts {
  std::map<std::size_t, double> weights;
  Eigen::VectorXd design;
};

void add_parts(const ResponseNumbers& numbers, std::size_t response, double weight,
               CountedParts& counted) {
  const Expression* expression = numbers.expression_of(response);
  if (expression == nullptr) {
    counted.weights[response] += weight;
    return;
  }
  const ExpressionValue at = numbers.evaluated(*expression);
  for (std::size_t i = 0; i < expression->arguments.size(); ++i) {
    const ExpressionArgument& argument = expression->arguments[i];
    const double share = weight * at.derivatives[i];
    if (is_response(argument)) {
      add_parts(numbers, argument.index, share, counted);
    } else {
      counted.design(argument.index) += share;
    }
  }
}

}  // namespace

ExpressionValue ResponseNumbers::evaluated(const Expression& expression) const {
  std::vector<double> arguments;
  for (const ExpressionArgument& argument : expression.arguments) {
    arguments.push_back(is_response(argument) ? value_of(argument.index) : x(argument.index));
  }
  return evaluate(expression, arguments);
}

double ResponseNumbers::value(std::size_t response) const {
  const double value = evaluated(*expression_of(response)).value;
  if (!std::isfinite(value)) refuse(response, "value");
  return value;
}

LinearizedResponse ResponseNumbers::linearized(std::size_t response) const {
  CountedParts counted{{}, Eigen::VectorXd::Zero(x.size())};
  add_parts(*this, response, 1.0, counted);
  LinearizedResponse found{{}, std::move(counted.design)};
  for (const auto& [part, weight] : counted.weights) found.parts.push_back({part, weight});
  return found;
}

void ResponseNumbers::refuse(std::size_t response, const char* what) const {
  const Expression& expression = *expression_of(response);
  std::string numbers;
  for (const ExpressionArgument& argument : expression.arguments) {
    if (!is_response(argument)) continue;
    numbers += fmt::format("{}{} = {:.6g}", numbers.empty() ? ", with " : ", ",
                           name_of(argument.index), value_of(argument.index));
  }
  throw SimulationError(fmt::format("the response \"{}\" has no finite {} there: \"{}\"{}",
                                    name_of(response), what, expression.text, numbers));
}

ResponseNumbers numbers_of(const std::vector<Response>& responses,
                           const std::vector<Reduction>& reductions, const Eigen::VectorXd& x) {
  return {x, [&](std::size_t response) { return responses[response].expression(); },
          [&](std::size_t response) { return reductions[response].value; },
          [&](std::size_t response) { return responses[response].name; }};
}

}  // namespace pleuel
