#include "optimization/restoration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/eager_matrices.hpp"
#include "optimization/elastic_problem.hpp"
#include "optimization/scaling.hpp"
#include "optimization/violation_step.hpp"

namespace pleuel {

namespace {

/// Distance to the limits that is aimed at, relative; a step ends within them although they bend.
constexpr double margin = 0.01;
/// Of an equality: relative distance that counts as none.
constexpr double equal = 1e-7;
/// Radius of the box: at the start, at most, and that below which nothing helps.
constexpr double first_radius = 0.7, largest_radius = 2.0, least_radius = 1e-5;
/// A step has to make so much of the decrease that its model promises.
constexpr double least_share = 0.1, good_share = 0.7;
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
      x[i] = std::clamp(x[i], variable(i).lower, variable(i).upper);
    }
    return x;
  }

  /// dx/du
  Eigen::VectorXd slopes(const Eigen::VectorXd& x) const {
    Eigen::VectorXd slopes = scales_;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (is_logarithmic(i)) slopes[i] = x[i];
    }
    return slopes;
  }

  /// How far u may go to each side, at most `radius`.
  std::pair<Eigen::VectorXd, Eigen::VectorXd> room(const Eigen::VectorXd& u, double radius) const {
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
  Restoration(Problem& problem, const RestorationBudget& budget, EvaluatedDesign start)
      : problem_(problem),
        budget_(budget),
        coordinates_(problem, start.x),
        magnitudes_(
            constraint_scales(problem, start.evaluation, variable_scales(problem, start.x))),
        sides_(limit_sides(problem, magnitudes_)),
        design_(std::move(start)) {}

  Restored run() {
    double radius = first_radius;
    int idle = 0;
    while (!keeps_limits(design_.evaluation) && radius > least_radius && idle < most_idle_steps &&
           gradients_ < budget_.gradients && evaluations_ < budget_.evaluations) {
      const double before = sum(design_.evaluation);
      const double share = try_step(radius);
      if (share < least_share) radius *= share < 0.0 ? 0.25 : 0.5;
      if (share > good_share) radius = std::min(2.0 * radius, largest_radius);
      if (share < least_share) continue;
      idle = before - sum(design_.evaluation) < least_decrease * before ? idle + 1 : 0;
    }
    design_.max_violation = max_violation(problem_, design_.evaluation.constraints, magnitudes_);
    return {design_, magnitudes_, keeps_limits(design_.evaluation)};
  }

 private:
  bool is_equality(const LimitSide& side) const {
    return problem_.constraints()[side.constraint].is_equality();
  }

  bool keeps_limits(const Evaluation& evaluation) const {
    return std::all_of(sides_.begin(), sides_.end(), [&](const LimitSide& side) {
      return side.violation(evaluation.constraints) <= (is_equality(side) ? equal : 0.0);
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
    LinearizedLimits model{Eigen::VectorXd(count), Eigen::MatrixXd(count, design_.x.size())};
    const Eigen::VectorXd slopes = coordinates_.slopes(design_.x);
    for (Eigen::Index k = 0; k < count; ++k) {
      const LimitSide& side = sides_[k];
      const double violation = side.violation(design_.evaluation.constraints);
      model.residuals[k] = residual(side, design_.evaluation);
      model.slopes.row(k) = damped_violation_slope(violation) * side.sign / side.magnitude *
                            design_.evaluation.constraint_jacobian.row(side.constraint)
                                .cwiseProduct(slopes.transpose());
    }
    return model;
  }

  /// Goes there if it helps. @returns the decrease, relative to that of the model; −1 if the design
  /// cannot be evaluated
  double try_step(double radius) {
    const LinearizedLimits model = linearized();
    const Eigen::VectorXd u = coordinates_.of(design_.x);
    const auto [down, up] = coordinates_.room(u, radius);
    const Eigen::VectorXd step = violation_step(model, down, up);
    const double before = sum(design_.evaluation);
    const double promised = before - model.sum(step);
    const Eigen::VectorXd x = coordinates_.design(u + step);
    if (!(promised > 0.0) || x == design_.x) return 0.0;
    ++evaluations_;
    Attempt attempt = attempt_evaluation(problem_, x, Request::values);
    if (!attempt.evaluation) return -1.0;
    const double share = (before - sum(*attempt.evaluation)) / promised;
    if (share < least_share) return std::max(0.0, share);
    ++gradients_;
    attempt = attempt_evaluation(problem_, x, Request::values_and_gradients);
    if (!attempt.evaluation) return -1.0;
    design_ = {x, std::move(*attempt.evaluation)};
    return share;
  }

  Problem& problem_;
  RestorationBudget budget_;
  Coordinates coordinates_;
  Eigen::VectorXd magnitudes_;
  std::vector<LimitSide> sides_;
  EvaluatedDesign design_;
  int gradients_ = 1, evaluations_ = 1;
};

}  // namespace

std::optional<Restored> restore_limits(Problem& problem, const Eigen::VectorXd& start,
                                       const RestorationBudget& budget) {
  Attempt first = attempt_evaluation(problem, start, Request::values_and_gradients);
  if (!first.evaluation) return std::nullopt;
  return Restoration(problem, budget, {start, std::move(*first.evaluation)}).run();
}

}  // namespace pleuel
