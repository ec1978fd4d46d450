#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "optimization/phase_one.hpp"
#include "optimization/scaling.hpp"

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

namespace {

/// Distance to the limits that is aimed at, relative; a step ends within them although they bend.
constexpr double margin = 0.01;
/// Of an equality: relative distance that counts as none.
constexpr double equal = 1e-7;
/// Radius of the box: at the start, at most, and that below which nothing helps.
constexpr double first_radius = 0.7, largest_radius = 2.0, least_radius = 1e-5;
/// A step has to make so much of the decrease that its model promises.
constexpr double least_ratio = 0.1, good_ratio = 0.7;
/// Decrease of the sum, relative, below which a step is none.
constexpr double least_decrease = 1e-2;
constexpr int most_idle_steps = 3;

/// x as coordinates u in which steps of order one are sensible: ln x for positive bounds, else x/s.
class Coordinates {
 public:
  Coordinates(const Problem& problem, const Eigen::VectorXd& x)
      : problem_(problem), scales_(variable_scales(problem, x)) {}

  Eigen::VectorXd of(const Eigen::VectorXd& x) const {
    Eigen::VectorXd u = x.cwiseQuotient(scales_);
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      if (is_logarithmic(i)) u[i] = std::log(x[i]);
    }
    return u;
  }

  /// Within the bounds.
  Eigen::VectorXd design(const Eigen::VectorXd& u) const {
    Eigen::VectorXd x = u.cwiseProduct(scales_);
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      if (is_logarithmic(i)) x[i] = std::exp(u[i]);
    }
    return within_bounds(problem_, std::move(x));
  }

  /// dx/du
  Eigen::VectorXd slopes(const Eigen::VectorXd& x) const {
    Eigen::VectorXd slopes = scales_;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (is_logarithmic(i)) slopes[i] = x[i];
    }
    return slopes;
  }

  /// How far u may go down and up, at most `radius`.
  std::pair<Eigen::VectorXd, Eigen::VectorXd> box(const Eigen::VectorXd& u, double radius) const {
    Eigen::VectorXd down = Eigen::VectorXd::Constant(u.size(), radius), up = down;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const bool is_log = is_logarithmic(i);
      const double lower = is_log ? std::log(variable(i).lower) : variable(i).lower / scales_[i];
      const double upper = is_log ? std::log(variable(i).upper) : variable(i).upper / scales_[i];
      down[i] = std::clamp(u[i] - lower, 0.0, radius);
      up[i] = std::clamp(upper - u[i], 0.0, radius);
    }
    return {down, up};
  }

 private:
  const Variable& variable(Eigen::Index i) const { return problem_.variables()[i]; }
  bool is_logarithmic(Eigen::Index i) const { return variable(i).lower > 0.0; }

  const Problem& problem_;
  Eigen::VectorXd scales_;
};

class Restoration {
 public:
  Restoration(Problem& problem, const RestorationBudget& budget, const Eigen::VectorXd& start,
              Evaluation at_start)
      : problem_(problem),
        budget_(budget),
        coordinates_(problem, start),
        sides_(limit_sides(problem,
                           constraint_scales(problem, at_start, variable_scales(problem, start)))),
        x_(start),
        at_x_(std::move(at_start)) {}

  std::optional<Eigen::VectorXd> run() {
    double radius = first_radius;
    int idle = 0;
    while (!keeps_limits() && radius > least_radius && idle < most_idle_steps &&
           gradients_ < budget_.gradients && evaluations_ < budget_.evaluations) {
      const double before = sum(at_x_);
      const double ratio = try_step(radius);
      if (ratio < least_ratio) radius *= ratio < 0.0 ? 0.25 : 0.5;
      if (ratio > good_ratio) radius = std::min(2.0 * radius, largest_radius);
      if (ratio < least_ratio) continue;
      idle = before - sum(at_x_) < least_decrease * before ? idle + 1 : 0;
    }
    if (!keeps_limits()) return std::nullopt;
    return x_;
  }

 private:
  bool is_equality(const LimitSide& side) const {
    return problem_.constraints()[side.constraint].is_equality();
  }

  bool keeps_limits() const {
    return std::ranges::all_of(sides_, [&](const LimitSide& side) {
      return side.violation(at_x_.constraints) <= (is_equality(side) ? equal : 0.0);
    });
  }

  double residual(const LimitSide& side, const Evaluation& evaluation) const {
    return damped_violation(side.violation(evaluation.constraints)) +
           (is_equality(side) ? 0.0 : margin);
  }

  double sum(const Evaluation& evaluation) const {
    double sum = 0.0;
    for (const LimitSide& side : sides_) {
      sum += std::pow(std::max(0.0, residual(side, evaluation)), 2);
    }
    return sum;
  }

  /// r = ψ + margin, A = dψ/du
  LinearizedLimits linearized() const {
    const Eigen::Index count = sides_.size();
    LinearizedLimits model{Eigen::VectorXd(count), Eigen::MatrixXd(count, x_.size())};
    const Eigen::VectorXd slopes = coordinates_.slopes(x_);
    for (Eigen::Index k = 0; k < count; ++k) {
      const LimitSide& side = sides_[k];
      const double violation = side.violation(at_x_.constraints);
      model.residuals[k] = residual(side, at_x_);
      model.slopes.row(k) =
          damped_violation_slope(violation) * side.sign / side.magnitude *
          at_x_.constraint_jacobian.row(side.constraint).cwiseProduct(slopes.transpose());
    }
    return model;
  }

  /// Goes there if it helps. @returns the decrease, relative to that of the model; −1 if the design
  /// cannot be evaluated
  double try_step(double radius) {
    const LinearizedLimits model = linearized();
    const Eigen::VectorXd u = coordinates_.of(x_);
    const auto [down, up] = coordinates_.box(u, radius);
    const Eigen::VectorXd step = violation_step(model, down, up);
    const double before = sum(at_x_);
    const double promised = before - model.sum(step);
    const Eigen::VectorXd x = coordinates_.design(u + step);
    if (!(promised > 0.0) || x == x_) return 0.0;
    ++evaluations_;
    Attempt attempt = attempt_evaluation(problem_, x, Request::values);
    if (!attempt.evaluation) return -1.0;
    const double ratio = (before - sum(*attempt.evaluation)) / promised;
    if (ratio < least_ratio) return std::max(0.0, ratio);
    ++gradients_;
    attempt = attempt_evaluation(problem_, x, Request::values_and_gradients);
    if (!attempt.evaluation) return -1.0;
    x_ = x;
    at_x_ = std::move(*attempt.evaluation);
    return ratio;
  }

  Problem& problem_;
  RestorationBudget budget_;
  Coordinates coordinates_;
  std::vector<LimitSide> sides_;
  Eigen::VectorXd x_;
  Evaluation at_x_;  ///< with gradients
  int gradients_ = 1, evaluations_ = 1;
};

}  // namespace

std::optional<Eigen::VectorXd> restore_limits(Problem& problem, const Eigen::VectorXd& start,
                                              const RestorationBudget& budget) {
  Attempt first = attempt_evaluation(problem, start, Request::values_and_gradients);
  if (!first.evaluation) return std::nullopt;
  return Restoration(problem, budget, start, std::move(*first.evaluation)).run();
}

}  // namespace pleuel
