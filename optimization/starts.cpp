#include "optimization/starts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

constexpr double reach_without_bounds = 10.0;

std::pair<double, double> range_of(const Variable& variable) {
  double lower = variable.lower, upper = variable.upper;
  if (variable.has_lower() && variable.has_upper()) return {lower, upper};
  const double reach =
      reach_without_bounds * std::max(std::abs(variable.start), variable.magnitude);
  if (reach == 0.0) {
    throw InputError(fmt::format(
        "/variables/{} has no bounds and starts at 0: nothing says where other starts may lie",
        variable.name));
  }
  if (!variable.has_lower()) lower = variable.start - reach;
  if (!variable.has_upper()) upper = variable.start + reach;
  return {lower, upper};
}

/// In [0, 1); distributions of the standard library differ between its makers.
double uniform(std::mt19937& engine) {
  return static_cast<double>(engine()) / 4294967296.0;
}

std::vector<int> shuffled(int count, std::mt19937& engine) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<std::size_t>(uniform(engine) * (i + 1))]);
  }
  return order;
}

}  // namespace

std::vector<Eigen::VectorXd> latin_hypercube(const std::vector<Variable>& variables, int count,
                                             unsigned seed) {
  std::mt19937 engine(seed);
  const Eigen::Index n = variables.size();
  std::vector<Eigen::VectorXd> designs(count, Eigen::VectorXd(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    const Variable& variable = variables[i];
    const auto [lower, upper] = range_of(variable);
    const std::vector<int> parts = shuffled(count, engine);
    for (std::size_t k = 0; k < designs.size(); ++k) {
      const double share = (parts[k] + uniform(engine)) / count;
      designs[k][i] = std::clamp(std::lerp(lower, upper, share), variable.lower, variable.upper);
    }
  }
  return designs;
}

}  // namespace pleuel
