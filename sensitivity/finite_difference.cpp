#include "sensitivity/finite_difference.hpp"

#include "core/base/parallel.hpp"

namespace pleuel {

namespace {

double step_of(double x, double step) {
  return x == 0.0 ? step : step * std::abs(x);
}

Eigen::VectorXd values_at(const ProblemFile& problem, Eigen::VectorXd x, Eigen::Index j,
                          double value) {
  x(j) = value;
  return values_of(*analyze(problem, x));
}

}  // namespace

Eigen::MatrixXd forward_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    const Analysis& at_x, double step, int threads) {
  const Eigen::VectorXd base = values_of(at_x);
  Eigen::MatrixXd result(base.size(), x.size());
  for_each_in_parallel(static_cast<int>(x.size()), threads, [&](int j) {
    const double upper = x(j) + step_of(x(j), step);
    result.col(j) = (values_at(problem, x, j, upper) - base) / (upper - x(j));
  });
  return result;
}

Eigen::MatrixXd central_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    double step, int threads) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(problem.responses.size()), x.size());
  for_each_in_parallel(static_cast<int>(x.size()), threads, [&](int j) {
    const double upper = x(j) + step_of(x(j), step), lower = x(j) - step_of(x(j), step);
    result.col(j) =
        (values_at(problem, x, j, upper) - values_at(problem, x, j, lower)) / (upper - lower);
  });
  return result;
}

}  // namespace pleuel
