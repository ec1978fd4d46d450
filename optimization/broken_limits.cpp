#include "optimization/broken_limits.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

struct BrokenLimit {
  std::string name, text;
  double violation = 0.0;  ///< relative
};

std::string describe(const Problem& problem, std::size_t row, double value) {
  const Constraint& limits = problem.constraints()[row];
  const bool is_above = value > limits.upper;
  return fmt::format("{} = {} {} {}", limits.name, problem.constraint_text(row, value),
                     is_above ? "exceeds its upper limit" : "falls below its lower limit",
                     problem.constraint_text(row, is_above ? limits.upper : limits.lower));
}

}  // namespace

std::string broken_limits(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& scales, double allowed) {
  std::vector<BrokenLimit> broken;
  for (std::size_t row = 0; row < problem.constraints().size(); ++row) {
    const Constraint& limits = problem.constraints()[row];
    const double excess = limits.excess(constraints[row]);
    if (excess <= allowed * scales[row]) continue;
    broken.push_back({limits.name, describe(problem, row, constraints[row]), excess / scales[row]});
  }
  std::stable_sort(broken.begin(), broken.end(),
                   [](const BrokenLimit& one, const BrokenLimit& other) {
                     return one.violation > other.violation;
                   });
  std::vector<std::string> names, texts;
  for (const BrokenLimit& limit : broken) {
    if (std::find(names.begin(), names.end(), limit.name) != names.end()) continue;
    names.push_back(limit.name);
    texts.push_back(limit.text);
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace pleuel
