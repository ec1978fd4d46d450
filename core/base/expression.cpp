#include "core/base/expression.hpp"

#include <algorithm>
#include <cstddef>

namespace pleuel {

namespace {

double inner_slope(double before, double after) {
  if (before * after <= 0.0) return 0.0;
  return 2.0 * before * after / (before + after);
}

/// @param chord  beside the end, @param next  the one behind it
double end_slope(double chord, double next) {
  const double slope = 0.5 * (3.0 * chord - next);
  if (slope * chord <= 0.0) return 0.0;
  const bool turns = chord * next <= 0.0;
  return turns && std::abs(slope) > 3.0 * std::abs(chord) ? 3.0 * chord : slope;
}

double slope_at(const std::vector<double>& values, std::size_t i) {
  const std::size_t last = values.size() - 1;
  const auto chord = [&](std::size_t k) { return values[k + 1] - values[k]; };
  if (last == 1) return chord(0);
  if (i == 0) return end_slope(chord(0), chord(1));
  if (i == last) return end_slope(chord(last - 1), chord(last - 2));
  return inner_slope(chord(i - 1), chord(i));
}

/// A result with its partial derivatives by both operands.
struct Partials {
  double value = 0.0;
  double by_first = 0.0, by_second = 0.0;
};

/// aᵇ: ∂/∂b = aᵇ ln a, which is 0 in the limit of a → 0 for b > 0.
Partials power(double a, double b) {
  const double value = std::pow(a, b);
  const double by_base = b == 0.0 ? 0.0 : b * std::pow(a, b - 1.0);
  return {value, by_base, a == 0.0 && b > 0.0 ? 0.0 : value * std::log(a)};
}

/// Each from what a change of this operand alone makes of the result.
Partials apply(const ExpressionStep& step, double a, double b) {
  if (step.operation == Operation::power) return power(a, b);
  using Functions = FormulaFunctions<double>;
  if (step.second < 0) {
    const TimeValue<double> result = Functions::of_one(step.operation, {a, 1.0, 0.0});
    return {result.value, result.rate};
  }
  const auto result = [&](double change_of_a, double change_of_b) {
    return Functions::of_two(step.operation, {a, change_of_a, 0.0}, {b, change_of_b, 0.0});
  };
  const TimeValue<double> first = result(1.0, 0.0);
  return {first.value, first.rate, result(0.0, 1.0).rate};
}

Partials compute(const Expression& expression, const ExpressionStep& step,
                 const std::vector<Partials>& results, const std::vector<double>& arguments) {
  if (step.operation == Operation::constant) return {step.constant};
  if (step.operation == Operation::argument) {
    return {arguments[step.first]};
  }
  const auto result = [&](int of) { return of < 0 ? 0.0 : results[of].value; };
  if (step.operation == Operation::path) {
    const PathPoint at = path_point(expression.path, result(step.first));
    return {at.value, at.slope};
  }
  return apply(step, result(step.first), result(step.second));
}

}  // namespace

PathPoint path_point(const std::vector<double>& values, double at) {
  const std::size_t last = values.size() - 1;
  if (last == 0) return {values.front(), 0.0};
  const auto end = static_cast<double>(last);
  if (!(at >= 0.0 && at <= end)) {
    const std::size_t nearest = at < 0.0 ? 0 : last;
    const double slope = slope_at(values, nearest);
    return {values[nearest] + slope * (at - (at < 0.0 ? 0.0 : end)), slope};
  }
  const std::size_t i = std::min(static_cast<std::size_t>(at), last - 1);
  const double s = at - static_cast<double>(i);
  if (s == 0.0) return {values[i], slope_at(values, i)};
  if (s == 1.0) return {values[i + 1], slope_at(values, i + 1)};
  const double rise = values[i + 1] - values[i];
  const double before = slope_at(values, i), after = slope_at(values, i + 1);
  const double c2 = 3.0 * rise - 2.0 * before - after, c3 = before + after - 2.0 * rise;
  return {values[i] + s * (before + s * (c2 + s * c3)), before + s * (2.0 * c2 + 3.0 * s * c3)};
}

ExpressionValue evaluate(const Expression& expression, const std::vector<double>& arguments) {
  const std::vector<ExpressionStep>& steps = expression.steps;
  std::vector<Partials> results;
  for (const ExpressionStep& step : steps) {
    results.push_back(compute(expression, step, results, arguments));
  }

  ExpressionValue found;
  found.value = results.back().value;
  found.derivatives.assign(expression.arguments.size(), 0.0);
  std::vector<double> slopes(steps.size(), 0.0);  // of the whole by each step
  slopes.back() = 1.0;
  for (std::size_t i = steps.size(); i-- > 0;) {
    if (slopes[i] == 0.0 || steps[i].operation == Operation::constant) continue;
    const std::size_t first = steps[i].first;
    if (steps[i].operation == Operation::argument) {
      found.derivatives[first] += slopes[i];
      continue;
    }
    slopes[first] += slopes[i] * results[i].by_first;
    if (steps[i].second >= 0) {
      slopes[steps[i].second] += slopes[i] * results[i].by_second;
    }
  }
  return found;
}

}  // namespace pleuel
