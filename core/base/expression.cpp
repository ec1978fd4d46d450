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

/// Numbers that are equal but for their round-off, as the frequencies of a square section along two
/// axes.
bool is_tie(double a, double b) {
  constexpr double round_off = 1e-12;
  return std::abs(a - b) <= round_off * std::max(std::abs(a), std::abs(b));
}

/// The operand that counts; at a tie the mean of both.
Partials chosen(double a, double b, bool is_first) {
  if (is_tie(a, b)) return {is_first ? a : b, 0.5, 0.5};
  return is_first ? Partials{a, 1.0, 0.0} : Partials{b, 0.0, 1.0};
}

double sign(double a) {
  if (a == 0.0) return 0.0;
  return a > 0.0 ? 1.0 : -1.0;
}

/// aᵇ: ∂/∂b = aᵇ ln a, which is 0 in the limit of a → 0 for b > 0.
Partials power(double a, double b) {
  const double value = std::pow(a, b);
  const double by_base = b == 0.0 ? 0.0 : b * std::pow(a, b - 1.0);
  return {value, by_base, a == 0.0 && b > 0.0 ? 0.0 : value * std::log(a)};
}

Partials apply(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::plus:
      return {a + b, 1.0, 1.0};
    case Operation::minus:
      return {a - b, 1.0, -1.0};
    case Operation::times:
      return {a * b, b, a};
    case Operation::over:
      return {a / b, 1.0 / b, -a / (b * b)};
    case Operation::power:
      return power(a, b);
    case Operation::negated:
      return {-a, -1.0};
    case Operation::square_root:
      return {std::sqrt(a), 0.5 / std::sqrt(a)};
    case Operation::exponential:
      return {std::exp(a), std::exp(a)};
    case Operation::logarithm:
      return {std::log(a), 1.0 / a};
    case Operation::hyperbolic_tangent:
      return {std::tanh(a), 1.0 - std::tanh(a) * std::tanh(a)};
    case Operation::sine:
      return {std::sin(a), std::cos(a)};
    case Operation::cosine:
      return {std::cos(a), -std::sin(a)};
    case Operation::tangent:
      return {std::tan(a), 1.0 + std::tan(a) * std::tan(a)};
    case Operation::arc_sine:
      return {std::asin(a), 1.0 / std::sqrt(1.0 - a * a)};
    case Operation::arc_cosine:
      return {std::acos(a), -1.0 / std::sqrt(1.0 - a * a)};
    case Operation::arc_tangent:
      return {std::atan(a), 1.0 / (1.0 + a * a)};
    case Operation::arc_tangent_2: {
      const double square = a * a + b * b;
      return {std::atan2(a, b), b / square, -a / square};
    }
    case Operation::smaller:
      return chosen(a, b, a < b);
    case Operation::larger:
      return chosen(a, b, a > b);
    case Operation::magnitude:
      return {std::abs(a), sign(a)};
    case Operation::constant:
    case Operation::argument:
    case Operation::path:
      break;
  }
  return {};
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
  return apply(step.operation, result(step.first), result(step.second));
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
