#include "tests/optimization/known_problems.hpp"

#include <array>
#include <cmath>

#include <Eigen/LU>

#include "core/base/eager_matrices.hpp"
#include "optimization/scaling.hpp"

namespace pleuel::test {

namespace {

std::vector<Variable> variables(const std::vector<double>& start, double lower, double upper) {
  std::vector<Variable> result;
  for (const double value : start) {
    result.push_back({"x" + std::to_string(result.size() + 1), value, lower, upper});
  }
  return result;
}

/// g ≤ limit, count times.
std::vector<Constraint> limits(int count, double limit) {
  std::vector<Constraint> result;
  for (int j = 1; j <= count; ++j) result.push_back({"g" + std::to_string(j), -infinity, limit});
  return result;
}

}  // namespace

KnownProblem hs035() {
  const auto function = [](const auto& x) {
    const auto a = x[0], b = x[1], c = x[2];
    return responses(9.0 - 8.0 * a - 6.0 * b - 4.0 * c + 2.0 * a * a + 2.0 * b * b + c * c +
                         2.0 * a * b + 2.0 * a * c,
                     a + b + 2.0 * c);
  };
  return {"HS035", by_formulas(variables({0.5, 0.5, 0.5}, 0.0, infinity), limits(1, 3.0), function),
          1.0 / 9.0};
}

KnownProblem hs043() {
  const auto function = [](const auto& x) {
    const auto a = x[0], b = x[1], c = x[2], d = x[3];
    return responses(a * a + b * b + 2.0 * c * c + d * d - 5.0 * a - 5.0 * b - 21.0 * c + 7.0 * d,
                     a * a + b * b + c * c + d * d + a - b + c - d,
                     a * a + 2.0 * b * b + c * c + 2.0 * d * d - a - d,
                     2.0 * a * a + b * b + c * c + 2.0 * a - b - d);
  };
  return {"HS043",
          by_formulas(variables({0.0, 0.0, 0.0, 0.0}, -infinity, infinity),
                      {{"g1", -infinity, 8.0}, {"g2", -infinity, 10.0}, {"g3", -infinity, 5.0}},
                      function),
          -44.0};
}

KnownProblem hs071() {
  const auto function = [](const auto& x) {
    return responses(x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2], x[0] * x[1] * x[2] * x[3],
                     x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
  };
  return {"HS071",
          by_formulas(variables({1.0, 5.0, 5.0, 1.0}, 1.0, 5.0),
                      {{"product", 25.0, infinity}, {"sphere", 40.0, 40.0}}, function),
          17.0140172892};
}

KnownProblem hs100() {
  const auto function = [](const auto& x) {
    const auto square = [](const auto& value) { return value * value; };
    const auto a = x[0], b = x[1], c = x[2], d = x[3], e = x[4], p = x[5], q = x[6];
    return responses(square(a - 10.0) + 5.0 * square(b - 12.0) + square(c * c) +
                         3.0 * square(d - 11.0) + 10.0 * square(e * e * e) + 7.0 * p * p +
                         square(q * q) - 4.0 * p * q - 10.0 * p - 8.0 * q,
                     2.0 * a * a + 3.0 * square(b * b) + c + 4.0 * d * d + 5.0 * e - 127.0,
                     7.0 * a + 3.0 * b + 10.0 * c * c + d - e - 282.0,
                     23.0 * a + b * b + 6.0 * p * p - 8.0 * q - 196.0,
                     4.0 * a * a + b * b - 3.0 * a * b + 2.0 * c * c + 5.0 * p - 11.0 * q);
  };
  return {"HS100",
          by_formulas(variables({1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0}, -infinity, infinity),
                      limits(4, 0.0), function),
          680.630057374};
}

KnownProblem cantilever(double limit) {
  const auto function = [](const auto& x) {
    const auto cube = [&](int i) { return x[i] * x[i] * x[i]; };
    return responses(
        0.0624 * (x[0] + x[1] + x[2] + x[3] + x[4]),
        61.0 / cube(0) + 37.0 / cube(1) + 19.0 / cube(2) + 7.0 / cube(3) + 1.0 / cube(4));
  };
  return {"cantilever",
          by_formulas(variables({5.0, 5.0, 5.0, 5.0, 5.0}, 1.0, 10.0),
                      {{"deflection", -infinity, limit}}, function),
          1.339956360599 * std::pow(limit, -1.0 / 3.0)};
}

KnownProblem three_bar_truss() {
  const auto function = [](const auto& x) {
    const double root = std::sqrt(2.0);
    const auto a = x[0], b = x[1];
    const auto denominator = root * a * a + 2.0 * a * b;
    return responses(100.0 * (2.0 * root * a + b), 2.0 * (root * a + b) / denominator,
                     2.0 * b / denominator, 2.0 / (a + root * b));
  };
  return {"three-bar truss",
          by_formulas(variables({0.5, 0.5}, 1e-3, 1.0), limits(3, 2.0), function), 263.895843376};
}

KnownProblem tension_spring() {
  const auto function = [](const auto& x) {
    const auto d = x[0], D = x[1], N = x[2];
    return responses((N + 2.0) * D * d * d, -D * D * D * N / (71785.0 * d * d * d * d),
                     (4.0 * D * D - d * D) / (12566.0 * (D * d * d * d - d * d * d * d)) +
                         1.0 / (5108.0 * d * d),
                     -140.45 * d / (D * D * N), (D + d) / 1.5);
  };
  return {
      "tension spring",
      by_formulas({{"wire", 0.07, 0.05, 2.0}, {"coil", 0.6, 0.25, 1.3}, {"turns", 9.0, 2.0, 15.0}},
                  {{"deflection", -infinity, -1.0},
                   {"shear", -infinity, 1.0},
                   {"surge", -infinity, -1.0},
                   {"size", -infinity, 1.0}},
                  function),
      0.012665232798};
}

namespace {

struct Bar {
  int from, to;
};

const std::array<Eigen::Vector2d, 6> nodes = {
    {{720.0, 360.0}, {720.0, 0.0}, {360.0, 360.0}, {360.0, 0.0}, {0.0, 360.0}, {0.0, 0.0}}};
const std::array<Bar, 10> bars = {
    {{4, 2}, {2, 0}, {5, 3}, {3, 1}, {3, 2}, {1, 0}, {4, 3}, {5, 2}, {2, 1}, {3, 0}}};
constexpr int free_coordinates = 8;  // the last two nodes are fixed
constexpr double young = 1e4, density = 0.1, load = -100.0;

/// b with elongation = bᵀ u, over all 12 coordinates.
Eigen::VectorXd elongation_row(const Bar& bar) {
  const Eigen::Vector2d direction = (nodes[bar.to] - nodes[bar.from]).normalized();
  Eigen::VectorXd row = Eigen::VectorXd::Zero(12);
  row.segment<2>(2 * bar.to) = direction;
  row.segment<2>(2 * bar.from) = -direction;
  return row.head(free_coordinates);
}

double length(const Bar& bar) {
  return (nodes[bar.to] - nodes[bar.from]).norm();
}

/// (mass, stresses) of the ten areas.
template <typename Scalar>
Vector<Scalar> mass_and_stresses(const Vector<Scalar>& areas) {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  Matrix stiffness = Matrix::Zero(free_coordinates, free_coordinates);
  Vector<Scalar> result(11);
  result[0] = 0.0;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Vector<Scalar> b = elongation_row(bars[i]).cast<Scalar>();
    stiffness += young / length(bars[i]) * areas[i] * b * b.transpose();
    result[0] += density * length(bars[i]) * areas[i];
  }
  Vector<Scalar> force = Vector<Scalar>::Zero(free_coordinates);
  force[3] = force[7] = load;  // downwards at the second and the fourth node
  const Vector<Scalar> displacement = stiffness.partialPivLu().solve(force);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Vector<Scalar> b = elongation_row(bars[i]).cast<Scalar>();
    result[i + 1] = young / length(bars[i]) * (b.transpose() * displacement);
  }
  return result;
}

}  // namespace

KnownProblem ten_bar_truss() {
  const auto function = [](const auto& areas) { return mass_and_stresses(areas.eval()); };
  std::vector<Constraint> stresses;
  for (int j = 1; j <= 10; ++j) stresses.push_back({"stress" + std::to_string(j), -25.0, 25.0});
  return {"ten-bar truss",
          by_formulas(variables(std::vector<double>(10, 10.0), 0.1, 100.0), stresses, function),
          1593.180909};
}

std::vector<KnownProblem> all_known_problems() {
  return {hs035(),      hs043(),           hs071(),          hs100(),
          cantilever(), three_bar_truss(), tension_spring(), ten_bar_truss()};
}

Verdict judge_anew(Problem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& x) {
  const Evaluation first = problem.evaluate(start, Request::values_and_gradients);
  const Eigen::VectorXd variables = variable_scales(problem, start);
  const Eigen::VectorXd constraints = constraint_scales(problem, first, variables);
  EvaluationCache cache(problem, {start, first}, {variables, constraints}, {});
  const Evaluation evaluation = problem.evaluate(x, Request::values_and_gradients);
  const double violation = max_violation(problem, evaluation.constraints, constraints);
  return judge(cache, {x, evaluation, violation}, first, {});
}

}  // namespace pleuel::test
