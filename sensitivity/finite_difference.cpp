#include "sensitivity/finite_difference.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/jobs/parallel.hpp"

namespace pleuel {

namespace {

Eigen::VectorXd values_at(const ProblemFile& problem, Eigen::VectorXd x, Eigen::Index j,
                          double value, const ValuesOf& values) {
  x(j) = value;
  return values(*analyze(problem, x, values_only));
}

const DesignVariable& variable(const ProblemFile& problem, Eigen::Index j) {
  return problem.variables[j];
}

/// One column a variable. @param column  called in several threads
Eigen::MatrixXd collect(Eigen::Index variables, int threads,
                        const std::function<Eigen::VectorXd(Eigen::Index)>& column) {
  std::vector<Eigen::VectorXd> columns(variables);
  for_each_in_parallel(static_cast<int>(variables), threads,
                       [&](int j) { columns[j] = column(j); });
  Eigen::MatrixXd result(columns.empty() ? 0 : columns.front().size(), variables);
  for (Eigen::Index j = 0; j < variables; ++j) result.col(j) = columns[j];
  return result;
}

}  // namespace

double step_scale(const DesignVariable& variable, double x) {
  constexpr double part_of_range = 0.01;
  const double scale = std::max(std::abs(x), part_of_range * (variable.upper - variable.lower));
  return scale > 0.0 ? scale : 1.0;
}

Eigen::VectorXd step_scales(const std::vector<DesignVariable>& variables,
                            const Eigen::VectorXd& x) {
  Eigen::VectorXd scales(x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) scales(j) = step_scale(variables[j], x(j));
  return scales;
}

Eigen::MatrixXd forward_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    const Analysis& at_x, double step, int threads,
                                    const ValuesOf& values) {
  const Eigen::VectorXd base = values(at_x);
  return collect(x.size(), threads, [&](Eigen::Index j) -> Eigen::VectorXd {
    const DesignVariable& changed = variable(problem, j);
    const double change = step * step_scale(changed, x(j));
    const bool goes_up = x(j) + change <= changed.upper || x(j) - change < changed.lower;
    const double other = goes_up ? x(j) + change : x(j) - change;
    return (values_at(problem, x, j, other, values) - base) / (other - x(j));
  });
}

Eigen::MatrixXd central_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    double step, int threads, const ValuesOf& values) {
  return collect(x.size(), threads, [&](Eigen::Index j) -> Eigen::VectorXd {
    const double change = step * step_scale(variable(problem, j), x(j));
    const double upper = x(j) + change, lower = x(j) - change;
    return (values_at(problem, x, j, upper, values) - values_at(problem, x, j, lower, values)) /
           (upper - lower);
  });
}

}  // namespace pleuel
