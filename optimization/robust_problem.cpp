#include "optimization/robust_problem.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Of the differences of gradients: they are good to some 1e-8 of the value, and the error of
/// second order is that of third derivatives.
constexpr double relative_step = 1e-4;

}  // namespace

RobustProblem::RobustProblem(Problem& problem, Eigen::VectorXd deviations, Eigen::VectorXd margins)
    : FunctionProblem(problem, {}),
      problem_(problem),
      deviations_(std::move(deviations)),
      margins_(std::move(margins)) {
  assert(deviations_.size() == static_cast<Eigen::Index>(variables().size()));
  assert(margins_.size() == static_cast<Eigen::Index>(constraints().size()));
  for (std::size_t j = 0; j < constraints().size(); ++j) {
    const Constraint& limits = constraints()[j];
    assert(margins_(j) == 0.0 || limits.has_upper() != limits.has_lower());
    if (!limits.has_upper()) margins_(j) *= -1.0;
  }
}

Eigen::MatrixXd RobustProblem::deviation_gradients(const Eigen::VectorXd& x,
                                                   const Evaluation& evaluation,
                                                   const Eigen::VectorXd& deviations) {
  const Eigen::MatrixXd& jacobian = evaluation.constraint_jacobian;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(jacobian.rows(), jacobian.cols());
  const Eigen::VectorXd sizes = x.cwiseAbs().cwiseMax(local_scales(problem_, x));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (deviations_(i) == 0.0) continue;
    const double step = relative_step * sizes(i);
    Eigen::VectorXd upper = x, lower = x;
    if (!variables()[i].is_fixed()) {
      upper(i) = std::min(x(i) + step, variables()[i].upper);
      lower(i) = std::max(x(i) - step, variables()[i].lower);
    } else {
      upper(i) += step;
      lower(i) -= step;
    }
    const Eigen::MatrixXd change = neighbour_jacobian(upper, i) - neighbour_jacobian(lower, i);
    const Eigen::VectorXd weights = deviations_(i) * deviations_(i) * jacobian.col(i);
    sum += weights.asDiagonal() * change / (upper(i) - lower(i));
  }
  // A value that does not scatter has no gradient of its deviation: zero is one of them.
  const Eigen::VectorXd inverse = deviations.unaryExpr(
      [](double deviation) { return deviation > 0.0 ? 1.0 / deviation : 0.0; });
  return inverse.asDiagonal() * sum;
}

Eigen::MatrixXd RobustProblem::neighbour_jacobian(const Eigen::VectorXd& x, Eigen::Index changed) {
  try {
    return problem_.evaluate(x, Request::values_and_gradients).constraint_jacobian;
  } catch (const SimulationError& error) {
    throw EvaluationFailure(fmt::format("with {} = {:.9g}, for the gradient of a margin: {}",
                                        variables()[changed].name, x(changed), error.what()));
  }
}

Evaluation RobustProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  // Backends ask for values first, and often for the gradients of the same design after.
  if (x_.size() == 0 || x != x_) {
    x_.resize(0);
    at_x_ = problem_.evaluate(x, Request::values_and_gradients);
    x_ = x;
  }
  Evaluation evaluation = at_x_;
  const Eigen::VectorXd deviations =
      (evaluation.constraint_jacobian * deviations_.asDiagonal()).rowwise().norm();
  if (request == Request::values_and_gradients) {
    const Eigen::MatrixXd gradients = deviation_gradients(x, evaluation, deviations);
    evaluation.constraint_jacobian += margins_.asDiagonal() * gradients;
  } else {
    evaluation.objective_gradient.resize(0);
    evaluation.constraint_jacobian.resize(0, 0);
  }
  evaluation.constraints += margins_.cwiseProduct(deviations);
  return evaluation;
}

}  // namespace pleuel
