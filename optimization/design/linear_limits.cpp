#include "optimization/design/linear_limits.hpp"

#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "optimization/linear_conflict.hpp"

namespace pleuel {

void require_linear_limits(const ProblemFile& file) {
  std::vector<const ConstraintSettings*> linear;
  for (const ConstraintSettings& limit : file.constraints) {
    if (!limit.linear.empty()) linear.push_back(&limit);
  }
  if (linear.empty()) return;
  constexpr double none = std::numeric_limits<double>::infinity();
  const Eigen::Index count = std::ssize(linear), variables = std::ssize(file.variables);
  LinearLimits limits{Eigen::MatrixXd::Zero(count, variables), Eigen::VectorXd(count),
                      Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    for (const auto& [variable, factor] : linear[i]->linear) limits.rows(i, variable) += factor;
    limits.lower(i) = linear[i]->lower.value_or(-none);
    limits.upper(i) = linear[i]->upper.value_or(none);
  }
  Eigen::VectorXd lower(variables), upper(variables);
  for (Eigen::Index k = 0; k < variables; ++k) {
    lower(k) = file.variables[k].lower;
    upper(k) = file.variables[k].upper;
  }
  std::vector<std::string> names;
  for (const std::size_t i : linear_conflict(limits, lower, upper)) {
    names.push_back(linear[i]->name);
  }
  if (names.empty()) return;
  throw InputError(
      fmt::format("/constraints: no design within the bounds of the variables keeps the linear "
                  "limit{} \"{}\"{}",
                  names.size() == 1 ? "" : "s", fmt::join(names, "\", \""),
                  names.size() == 1 ? "" : " together"));
}

}  // namespace pleuel
