#include "optimization/violation_step.hpp"

#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

constexpr double box_weight = 30.0;
constexpr double regularization = 1e-4;
constexpr int most_iterations = 100;
/// Gradient, relative to that at d = 0, which is round-off.
constexpr double gradient_rounding = 1e-13;
/// Halvings of an interval of step lengths: down to round-off.
constexpr int most_halvings = 60;

class PiecewiseQuadratic {
 public:
  PiecewiseQuadratic(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                     const Eigen::VectorXd& up)
      : limits_(limits), down_(down), up_(up) {}

  /// Half the gradient.
  Eigen::VectorXd gradient(const Eigen::VectorXd& d) const {
    return limits_.slopes.transpose() * violations(d) + box_weight * box_weight * beyond_box(d) +
           regularization * d;
  }

  /// −H⁻¹ g with half the second derivatives H of the piece at d.
  Eigen::VectorXd newton_step(const Eigen::VectorXd& d, const Eigen::VectorXd& gradient) const {
    const Eigen::VectorXd violated = violations(d), beyond = beyond_box(d);
    std::vector<Eigen::Index> rows;
    for (Eigen::Index k = 0; k < violated.size(); ++k) {
      if (violated[k] > 0.0) rows.push_back(k);
    }
    const Eigen::MatrixXd slopes = limits_.slopes(rows, Eigen::all);
    Eigen::MatrixXd second = slopes.transpose() * slopes;
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      second(i, i) += regularization + (beyond[i] != 0.0 ? box_weight * box_weight : 0.0);
    }
    return -DenseLu(second).solve(gradient);
  }

  /// The length of p along which the function is least, at most 1: that of slope 0.
  double best_length(const Eigen::VectorXd& d, const Eigen::VectorXd& p) const {
    const Eigen::VectorXd begin = limits_.residuals + limits_.slopes * d;
    const Eigen::VectorXd change = limits_.slopes * p;
    const auto slope = [&](double length) {
      const Eigen::VectorXd end = d + length * p;
      return change.dot((begin + length * change).cwiseMax(0.0)) +
             p.dot(box_weight * box_weight * beyond_box(end) + regularization * end);
    };
    if (slope(1.0) <= 0.0) return 1.0;
    double lower = 0.0, upper = 1.0;
    for (int i = 0; i < most_halvings; ++i) {
      const double middle = 0.5 * (lower + upper);
      (slope(middle) > 0.0 ? upper : lower) = middle;
    }
    return lower;
  }

 private:
  Eigen::VectorXd violations(const Eigen::VectorXd& d) const {
    return (limits_.residuals + limits_.slopes * d).cwiseMax(0.0);
  }

  Eigen::VectorXd beyond_box(const Eigen::VectorXd& d) const {
    return (d - up_).cwiseMax(0.0) - (-down_ - d).cwiseMax(0.0);
  }

  const LinearizedLimits& limits_;
  const Eigen::VectorXd &down_, &up_;
};

}  // namespace

Eigen::VectorXd violation_step(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                               const Eigen::VectorXd& up) {
  const PiecewiseQuadratic function(limits, down, up);
  Eigen::VectorXd d = Eigen::VectorXd::Zero(down.size());
  Eigen::VectorXd gradient = function.gradient(d);
  const double round_off = gradient_rounding * gradient.norm();
  for (int i = 0; i < most_iterations && gradient.norm() > round_off; ++i) {
    const Eigen::VectorXd p = function.newton_step(d, gradient);
    const double length = function.best_length(d, p);
    if (length == 0.0) break;
    d += length * p;
    gradient = function.gradient(d);
  }
  return d.cwiseMin(up).cwiseMax(-down);
}

}  // namespace pleuel
