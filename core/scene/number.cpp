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
  if (!std::isfinite(value)) return false;
  switch (range) {
    case Range::any:
      return true;
    case Range::positive:
      return value > 0.0;
    case Range::not_negative:
      return value >= 0.0;
    case Range::poisson:
      return value > -1.0 && value < 0.5;
    case Range::fraction:
      return value >= 0.0 && value <= 1.0;
    case Range::below_one:
      return value >= 0.0 && value < 1.0;
  }
  return false;
}

}  // namespace pleuel
