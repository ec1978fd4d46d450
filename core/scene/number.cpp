#include "core/scene/number.hpp"

#include <cmath>

namespace pleuel {

std::vector<int> Number::variables() const {
  std::vector<int> all;
  if (variable >= 0) all.push_back(variable);
  if (!expression) return all;
  for (const ExpressionArgument& argument : expression->arguments) {
    all.push_back(static_cast<int>(argument.index));
  }
  return all;
}

bool Number::depends_on(int design_variable) const {
  const std::vector<int> all = variables();
  return std::ranges::find(all, design_variable) != all.end();
}

double derivative_by(int variable, const Number& number, const Design<double>& design) {
  Design<Dual> seeded(design.begin(), design.end());
  seeded[variable].derivatives()[0] = 1.0;
  return derivative_of(resolve(number, seeded));
}

bool is_within(Range range, double value) {
  return std::isfinite(value) && kind_of(range).holds(value);
}

}  // namespace pleuel
