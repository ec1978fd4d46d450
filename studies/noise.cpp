#include "studies/noise.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/jobs/parallel.hpp"
#include "optimization/problem.hpp"
#include "sensitivity/finite_difference.hpp"

namespace pleuel {

namespace {

constexpr int line_points = 8;
constexpr double spacings[] = {1e-11, 1e-6, 1e-4};

/// σ_k and whether Δᵏf changes its sign.
struct DifferenceLevel {
  double deviation = 0.0;
  bool changes_sign = false;
};

/// Levels k = 1, 2, … with at least three differences each.
std::vector<DifferenceLevel> difference_table(Eigen::VectorXd differences) {
  std::vector<DifferenceLevel> levels;
  double gamma = 1.0;  // (k!)²/(2k)!
  for (int k = 1; differences.size() > 3; ++k) {
    const Eigen::Index rest = differences.size() - 1;
    differences = (differences.tail(rest) - differences.head(rest)).eval();
    gamma *= 0.5 * k / (2 * k - 1);
    levels.push_back({std::sqrt(gamma * differences.squaredNorm() / static_cast<double>(rest)),
                      differences.minCoeff() * differences.maxCoeff() < 0.0});
  }
  return levels;
}

/// NaN where the simulation fails.
Eigen::VectorXd values_at(const ProblemFile& problem, const Eigen::VectorXd& x) {
  try {
    return values_of(*analyze(problem, x, values_only));
  } catch (const SimulationError&) {
    return Eigen::VectorXd::Constant(problem.responses.size(),
                                     std::numeric_limits<double>::quiet_NaN());
  }
}

/// The values of several problems, or of one at several designs.
/// @returns responses × count
template <class ValuesOf>
Eigen::MatrixXd columns_of_values(const ProblemFile& problem, int count, int threads,
                                  const ValuesOf& values_of_one) {
  Eigen::MatrixXd values(problem.responses.size(), count);
  for_each_in_parallel(count, threads, [&](int i) { values.col(i) = values_of_one(i); });
  return values;
}

}  // namespace

Eigen::VectorXd generic_direction(const ProblemFile& problem, const Eigen::VectorXd& x) {
  GenericNumbers numbers;
  Eigen::VectorXd direction = step_scales(problem.variables, x);
  for (double& change : direction) change *= numbers.signed_size();
  return direction;
}

double noise_of(const Eigen::VectorXd& values) {
  const std::vector<DifferenceLevel> levels = difference_table(values);
  for (std::size_t k = 0; k + 2 < levels.size(); ++k) {
    const auto [least, most] =
        std::minmax({levels[k].deviation, levels[k + 1].deviation, levels[k + 2].deviation});
    if (levels[k].changes_sign && most <= 4.0 * least) return levels[k].deviation;
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (const DifferenceLevel& level : levels) smallest = std::min(smallest, level.deviation);
  return smallest;
}

ResponseNoise response_noise(const ProblemFile& problem, const Eigen::VectorXd& x, int threads) {
  const Eigen::Index responses = problem.responses.size();
  ResponseNoise noise{Eigen::VectorXd::Zero(responses), Eigen::VectorXd::Zero(responses)};
  const Eigen::VectorXd direction = generic_direction(problem, x);
  bool is_known = false;
  for (const double spacing : spacings) {
    // x lies in the middle of the line, between two points.
    const Eigen::MatrixXd values = columns_of_values(problem, line_points, threads, [&](int i) {
      const double place = spacing * (i - 0.5 * (line_points - 1));
      return values_at(problem, x + place * direction);
    });
    if (!values.allFinite()) continue;
    is_known = true;
    for (Eigen::Index i = 0; i < responses; ++i) {
      noise.scatter(i) = std::max(noise.scatter(i), noise_of(values.row(i).transpose()));
    }
  }
  if (!is_known) {
    throw SimulationError("the noise is unknown: simulations fail around this design");
  }
  ProblemFile tight = problem;
  tight.simulation.newton_tolerance *= 1e-3;
  const Eigen::MatrixXd values = columns_of_values(
      problem, 2, threads, [&](int i) { return values_at(i == 0 ? problem : tight, x); });
  if (values.allFinite()) noise.remainder = (values.col(1) - values.col(0)).cwiseAbs();
  return noise;
}

}  // namespace pleuel
