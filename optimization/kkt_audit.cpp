#include "optimization/kkt_audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Slack, relative to the magnitude of the limit, beyond which a limit holds nothing.
constexpr double near_limit = 0.1;
/// Slope, relative to |f|, with respect to which all slopes are small: 1e-3 of it would change the
/// objective by 1e-4 across the whole range of a variable.
constexpr double flat = 1e-3;
/// Part of the gradient scale that the terms of a variable count for at least.
constexpr double least_part = 1e-5;
/// The terms that make the weights follow from multipliers, and these from the weights.
constexpr int weighted_passes = 3;

/// One side of a constraint or of a variable: g = sign · (c − limit) / magnitude ≤ 0.
struct Limit {
  Eigen::Index index;
  double sign;
  double magnitude;
  double value;              ///< g
  Eigen::VectorXd gradient;  ///< s ∘ ∇g

  double slack() const { return std::max(0.0, -value); }
};

/// Adds the sides of lower ≤ value ≤ upper that are near.
/// @param side  index, magnitude, and the gradient s ∘ ∇c / magnitude; the rest is filled in here.
void add_near_limits(std::vector<Limit>& limits, const Limit& side, double value, double lower,
                     double upper) {
  const double above = (value - upper) / side.magnitude;
  const double below = (lower - value) / side.magnitude;
  if (above > -near_limit) {
    limits.push_back({side.index, 1.0, side.magnitude, above, side.gradient});
  }
  if (below > -near_limit) {
    limits.push_back({side.index, -1.0, side.magnitude, below, -side.gradient});
  }
}

std::vector<Limit> near_constraints(const Problem& problem, const Evaluation& evaluation,
                                    const Eigen::VectorXd& scales,
                                    const Eigen::VectorXd& variable_scales) {
  std::vector<Limit> limits;
  for (Eigen::Index j = 0; j < evaluation.constraints.size(); ++j) {
    const Constraint& constraint = problem.constraints()[j];
    const Eigen::VectorXd gradient =
        evaluation.constraint_jacobian.row(j).transpose().cwiseProduct(variable_scales) / scales[j];
    add_near_limits(limits, {j, 0.0, scales[j], 0.0, gradient}, evaluation.constraints[j],
                    constraint.lower, constraint.upper);
  }
  return limits;
}

std::vector<Limit> near_bounds(const Problem& problem, const Eigen::VectorXd& x,
                               const Eigen::VectorXd& variable_scales) {
  std::vector<Limit> limits;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    if (variable.is_fixed()) continue;
    add_near_limits(limits, {i, 0.0, variable_scales[i], 0.0, Eigen::VectorXd::Unit(x.size(), i)},
                    x[i], variable.lower, variable.upper);
  }
  return limits;
}

/// Least squares of all rows, each times its weight.
class MultiplierSystem {
 public:
  MultiplierSystem(std::vector<Limit> limits, std::size_t constraints, Eigen::VectorXd right)
      : limits_(std::move(limits)), constraints_(constraints), right_(std::move(right)) {}

  /// λ of the system [W (s ∘ ∇g); diag(slack ‖W (s ∘ ∇g)‖ / ‖s ∘ ∇g‖)] λ = [−W (s ∘ ∇f); 0].
  Eigen::VectorXd solve(const Eigen::VectorXd& weights) const {
    const Eigen::Index count = limits_.size();
    const Eigen::Index variables = right_.size();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(variables + count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(variables + count);
    right.head(variables) = weights.cwiseProduct(right_);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Limit& limit = limits_[k];
      const Eigen::VectorXd weighted = weights.cwiseProduct(limit.gradient);
      const double length = limit.gradient.norm();
      matrix.col(k).head(variables) = weighted;
      matrix(variables + k, k) = limit.slack() * (length > 0.0 ? weighted.norm() / length : 1.0);
    }
    return nonnegative_least_squares(matrix, right);
  }

  /// What these λ make of the audit, without its scales.
  KktAudit audit(const Eigen::VectorXd& lambda, Eigen::Index constraints,
                 const Eigen::VectorXd& s) const {
    KktAudit audit;
    audit.constraint_multipliers = Eigen::VectorXd::Zero(constraints);
    audit.bound_multipliers = Eigen::VectorXd::Zero(s.size());
    audit.unpaid = Eigen::VectorXd::Zero(s.size());
    audit.stationarity = -right_;
    // Both sides of a limit may have a price: what counts is their difference.
    Eigen::MatrixXd of_constraints = Eigen::MatrixXd::Zero(s.size(), constraints);
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const Limit& limit = limits_[k];
      const double price = lambda[k];
      const Eigen::VectorXd force = price * limit.gradient;
      const double multiplier = limit.sign * price / limit.magnitude;
      if (k < constraints_) {
        audit.constraint_multipliers[limit.index] += multiplier;
        of_constraints.col(limit.index) += force;
      } else {
        audit.bound_multipliers[limit.index] += multiplier;
      }
      const double length = limit.gradient.lpNorm<1>();
      audit.stationarity += force;
      audit.complementarity += price * std::abs(limit.value);
      if (price > 0.0) audit.unpaid += force.cwiseAbs() * std::min(1.0, limit.slack() / length);
    }
    audit.terms = right_.cwiseAbs() + of_constraints.cwiseAbs().rowwise().sum() +
                  audit.bound_multipliers.cwiseProduct(s).cwiseAbs();
    return audit;
  }

 private:
  std::vector<Limit> limits_;  ///< of constraints, then of variables
  std::size_t constraints_;    ///< how many are of constraints
  Eigen::VectorXd right_;      ///< −s ∘ ∇f
};

double gradient_scale(const Problem& problem, const EvaluatedDesign& design,
                      const Evaluation& start, const Eigen::VectorXd& scales) {
  const double here = scaled_objective_gradient(problem, design.evaluation, scales).norm();
  const double at_start = std::max(scaled_objective_gradient(problem, start, scales).norm(),
                                   std::abs(start.objective - design.evaluation.objective));
  const double value = objective_value_scale(design.evaluation, start);
  return std::max(
      {here, std::min(at_start, 0.1 * value), flat * value, std::numeric_limits<double>::min()});
}

/// Magnitudes of the variables; zero of fixed ones, so that they are in no balance.
Eigen::VectorXd scales_of_free(const Problem& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd scales = local_scales(problem, x);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (problem.variables()[i].is_fixed()) scales[i] = 0.0;
  }
  return scales;
}

/// What holds fixed variables in place: whatever the limits leave of their slopes.
void add_multipliers_of_fixed(KktAudit& audit, const Problem& problem,
                              const Evaluation& evaluation) {
  const Eigen::VectorXd slopes =
      evaluation.objective_gradient +
      evaluation.constraint_jacobian.transpose() * audit.constraint_multipliers;
  for (Eigen::Index i = 0; i < slopes.size(); ++i) {
    if (problem.variables()[i].is_fixed()) audit.bound_multipliers[i] = -slopes[i];
  }
}

/// How far multipliers are from explaining the design: by all variables together, and by the worst
/// one, which may be ten times as far off (verdict.hpp).
double distance_from_optimum(const KktAudit& audit) {
  return std::max(audit.residual, 0.1 * audit.variable_residuals().maxCoeff());
}

}  // namespace

Eigen::VectorXd KktAudit::variable_residuals(const Eigen::VectorXd& curvatures) const {
  Eigen::VectorXd magnitudes = terms;
  if (curvatures.size() > 0) magnitudes = magnitudes.cwiseMax(curvatures);
  return stationarity.cwiseAbs().cwiseMax(unpaid).cwiseQuotient(
      magnitudes.cwiseMax(least_part * gradient_scale));
}

KktAudit audit_kkt(const Problem& problem, const EvaluatedDesign& design, const Evaluation& start,
                   const Eigen::VectorXd& scales) {
  const Eigen::VectorXd s = scales_of_free(problem, design.x);
  std::vector<Limit> limits = near_constraints(problem, design.evaluation, scales, s);
  const std::size_t constraints = limits.size();
  const std::vector<Limit> bounds = near_bounds(problem, design.x, s);
  limits.insert(limits.end(), bounds.begin(), bounds.end());
  const MultiplierSystem system(std::move(limits), constraints,
                                -s.cwiseProduct(design.evaluation.objective_gradient));

  const double gradients = gradient_scale(problem, design, start, s);
  const double values = std::min(gradients, objective_value_scale(design.evaluation, start));
  const auto audit_with = [&](const Eigen::VectorXd& weights) {
    KktAudit audit = system.audit(system.solve(weights), scales.size(), s);
    audit.gradient_scale = gradients;
    audit.residual =
        std::max(audit.stationarity.norm() / gradients, audit.complementarity / values);
    return audit;
  };
  KktAudit audit = audit_with(Eigen::VectorXd::Ones(s.size()));
  for (int pass = 0; pass < weighted_passes; ++pass) {
    const Eigen::VectorXd weights = (audit.terms / gradients).cwiseMax(least_part).cwiseInverse();
    KktAudit weighted = audit_with(weights);
    if (!(distance_from_optimum(weighted) < distance_from_optimum(audit))) break;
    audit = std::move(weighted);
  }
  add_multipliers_of_fixed(audit, problem, design.evaluation);
  return audit;
}

namespace {

/// Part of ‖b‖ below which the correlation of a unit column with the residual is rounding.
constexpr double slope_rounding = 1e-13;

class LawsonHanson {
 public:
  LawsonHanson(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right)
      : matrix_(matrix), right_(right), z_(Eigen::VectorXd::Zero(matrix.cols())) {}

  Eigen::VectorXd solve() {
    begin_with_many();
    const Eigen::Index most_steps = 3 * matrix_.cols() + 10;
    for (Eigen::Index step = 0; step < most_steps; ++step) {
      const Eigen::Index entering = most_useful_column();
      if (entering < 0) break;
      passive_.push_back(entering);
      move_to_passive_solution();
    }
    return z_;
  }

 private:
  /// All columns without those that turn negative, so often until none does: most often the solution,
  /// with a few factorizations in place of one a column. Not where columns depend on others, of which
  /// the steepest ones are to be taken.
  void begin_with_many() {
    std::vector<Eigen::Index> kept(matrix_.cols());
    std::iota(kept.begin(), kept.end(), 0);
    while (!kept.empty()) {
      const PivotedQr factors(matrix_(Eigen::all, kept));
      if (factors.rank() < std::ssize(kept)) return;
      const Eigen::VectorXd target = factors.solve(right_);
      if (target.minCoeff() >= 0.0) {
        passive_ = kept;
        z_(kept) = target;
        return;
      }
      const std::size_t before = kept.size();
      for (Eigen::Index k = target.size() - 1; k >= 0; --k) {
        if (target[k] < 0.0) kept.erase(kept.begin() + k);
      }
      if (kept.size() == before) return;  // what is no number
    }
  }

  /// The column outside the passive set along which the residual falls most steeply; −1 if none.
  Eigen::Index most_useful_column() const {
    Eigen::VectorXd slope = matrix_.transpose() * (right_ - matrix_ * z_);
    for (const Eigen::Index j : passive_) slope[j] = 0.0;
    Eigen::Index best = -1;
    const double steepest = slope.size() > 0 ? slope.maxCoeff(&best) : 0.0;
    return steepest > slope_rounding * right_.norm() ? best : -1;
  }

  /// Unconstrained least squares on the passive columns; those that would turn negative leave.
  void move_to_passive_solution() {
    while (!passive_.empty()) {
      const Eigen::MatrixXd columns = matrix_(Eigen::all, passive_);
      const Eigen::VectorXd target = PivotedQr(columns).solve(right_);
      const double step = longest_step(target);
      for (Eigen::Index k = 0; k < target.size(); ++k) {
        z_[passive_[k]] += step * (target[k] - z_[passive_[k]]);
      }
      if (step == 1.0) return;
      drop_zeros(target);
    }
  }

  /// The part of the way to the target on which all passive unknowns stay nonnegative.
  double longest_step(const Eigen::VectorXd& target) const {
    double step = 1.0;
    for (Eigen::Index k = 0; k < target.size(); ++k) {
      const double now = z_[passive_[k]];
      if (target[k] < 0.0) step = std::min(step, now / (now - target[k]));
    }
    return step;
  }

  void drop_zeros(const Eigen::VectorXd& target) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index k = 0; k < target.size(); ++k) {
      double& unknown = z_[passive_[k]];
      if (target[k] < 0.0 && unknown <= std::numeric_limits<double>::epsilon() * -target[k]) {
        unknown = 0.0;
      } else {
        kept.push_back(passive_[k]);
      }
    }
    passive_ = kept;
  }

  const Eigen::MatrixXd& matrix_;
  const Eigen::VectorXd& right_;
  Eigen::VectorXd z_;
  std::vector<Eigen::Index> passive_;
};

}  // namespace

Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& matrix,
                                          const Eigen::VectorXd& right) {
  Eigen::VectorXd lengths = matrix.colwise().norm();
  lengths = (lengths.array() > 0.0).select(lengths, 1.0);
  const Eigen::MatrixXd unit_columns = matrix * lengths.cwiseInverse().asDiagonal();
  return LawsonHanson(unit_columns, right).solve().cwiseQuotient(lengths);
}

namespace {

constexpr double slack = 1e-3;

}  // namespace

Eigen::VectorXd prices_of(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& multipliers, const Eigen::VectorXd& scales) {
  Eigen::VectorXd prices = multipliers;
  for (Eigen::Index j = 0; j < prices.size(); ++j) {
    const Constraint& limits = problem.constraints()[j];
    const double room =
        prices[j] > 0.0 ? limits.upper - constraints[j] : constraints[j] - limits.lower;
    if (room > slack * scales[j]) prices[j] = 0.0;
  }
  return prices;
}

void set_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                const KktAudit& audit, const Eigen::VectorXd& scales) {
  result.constraint_multipliers =
      prices_of(problem, design.evaluation.constraints, audit.constraint_multipliers, scales);
  result.bound_multipliers = audit.bound_multipliers;
  result.kkt_residual = audit.residual;
  result.max_violation = design.max_violation;
  result.x = std::move(design.x);
  result.evaluation = std::move(design.evaluation);
}

void set_unproven_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                         const Eigen::VectorXd& scales) {
  const KktAudit audit = audit_kkt(problem, design, design.evaluation, scales);
  set_answer(result, problem, std::move(design), audit, scales);
}

}  // namespace pleuel
