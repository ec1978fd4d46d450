#include "core/response/value_over_cases.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/load_cases.hpp"

namespace pleuel {

namespace {

ResponseNumbers numbers_over_cases(const ProblemFile& joined, const Eigen::VectorXd& x,
                                   const ValueInCase& value_in_case) {
  const auto expression_of = [&](std::size_t response) {
    return is_over_cases(joined, response) ? formula_of(joined.responses[response]) : nullptr;
  };
  const auto value_of = [&](std::size_t response) {
    return value_over_cases(joined, response, x, value_in_case);
  };
  const auto name_of = [&](std::size_t response) { return joined.responses[response].name; };
  return {x, expression_of, value_of, name_of};
}

/// Values and derivatives, of an expression and of those that it names.
void require_finite_derivatives(const ResponseNumbers& numbers, std::size_t response) {
  const Expression* expression = numbers.expression_of(response);
  if (expression == nullptr) return;
  const ExpressionValue at = numbers.evaluated(*expression);
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!is_finite(at.value)) numbers.refuse(response, "value");
  if (!std::ranges::all_of(at.derivatives, is_finite)) {
    numbers.refuse(response, "derivative");
  }
  for (const ExpressionArgument& argument : expression->arguments) {
    if (argument.kind != ExpressionArgument::Kind::response) continue;
    require_finite_derivatives(numbers, argument.index);
  }
}

}  // namespace

double value_over_cases(const ProblemFile& joined, std::size_t response, const Eigen::VectorXd& x,
                        const ValueInCase& value_of) {
  if (!is_over_cases(joined, response)) return value_of(response);
  return numbers_over_cases(joined, x, value_of).value(response);
}

LinearizedResponse linearized_over_cases(const ProblemFile& joined, std::size_t response,
                                         const Eigen::VectorXd& x, const ValueInCase& value_of) {
  const ResponseNumbers numbers = numbers_over_cases(joined, x, value_of);
  require_finite_derivatives(numbers, response);
  return numbers.linearized(response);
}

}  // namespace pleuel
