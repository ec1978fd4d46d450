#include "optimization/neighbourhood.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "optimization/problem.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Below this part of its length a vector lies in the span of the others.
constexpr double dependent = 1e-6;

/// What is left of a vector across orthonormal columns; twice is enough against rounding.
Eigen::VectorXd across(const Eigen::MatrixXd& columns, Eigen::VectorXd vector) {
  for (int pass = 0; pass < 2; ++pass) vector -= columns * (columns.transpose() * vector);
  return vector;
}

/// A vector with entries of generic size, as far as it lies in the subspace and across the others.
Eigen::VectorXd generic_direction(GenericNumbers& numbers, const Eigen::MatrixXd& basis,
                                  const Eigen::MatrixXd& others) {
  Eigen::VectorXd direction;
  do {
    Eigen::VectorXd parts(basis.cols());
    for (double& part : parts) {
      part = numbers.part() - 0.5;
    }
    direction = across(others, basis * parts);
  } while (direction.norm() < dependent);
  return direction.normalized();
}

}  // namespace

LowestCurvature lowest_curvature(const HessianProduct& product, const Eigen::MatrixXd& basis,
                                 int max_products) {
  GenericNumbers numbers;
  const Eigen::Index most = std::min<Eigen::Index>(max_products, basis.cols());
  Eigen::MatrixXd directions(basis.rows(), 0), images(basis.rows(), 0);
  Eigen::VectorXd next = generic_direction(numbers, basis, directions);
  while (true) {
    const auto image = product(next);
    if (!image) break;
    const Eigen::Index count = directions.cols() + 1;
    directions.conservativeResize(Eigen::NoChange, count);
    images.conservativeResize(Eigen::NoChange, count);
    directions.col(count - 1) = next;
    images.col(count - 1) = basis * (basis.transpose() * *image);
    if (count == most) break;
    next = across(directions, images.col(count - 1));
    const bool is_invariant = next.norm() <= dependent * images.col(count - 1).norm();
    next = is_invariant ? generic_direction(numbers, basis, directions) : next.normalized();
  }
  LowestCurvature lowest;
  lowest.products = static_cast<int>(directions.cols());
  if (lowest.products == 0) return lowest;
  const Eigen::MatrixXd form = directions.transpose() * images;
  lowest.form = 0.5 * (form + form.transpose());
  const SymmetricModes modes = symmetric_modes(lowest.form);
  lowest.curvature = modes.values[0];
  lowest.directions = directions;
  lowest.direction = (directions * modes.vectors.col(0)).normalized();
  return lowest;
}

namespace {

constexpr double distance = 0.02;    ///< h
constexpr int doublings = 5;         ///< of h, at most
constexpr int most_directions = 6;   ///< whose Hessian product is computed
constexpr double reach = 0.5;        ///< R
constexpr double held = 1e-3;        ///< part of the gradient scale that makes a multiplier count
constexpr double noise = 1e-8;       ///< of the objective
constexpr double nothing = 1e-12;    ///< of the objective, as slope or curvature
constexpr double far_enough = 1e-2;  ///< relative gain: a backend finds on from there
/// Relative distance from its limit that a restored constraint may keep.
constexpr double restored = 1e-5;
/// Relative violation beyond which a neighbour does not count as within the limits.
constexpr double tolerated = 1e-3;

/// Lengths by which variables are moved: those of the backends, and where there are no bounds those
/// of the audit, which do not vanish with the variable.
Eigen::VectorXd lengths(const Problem& problem, const Eigen::VectorXd& x) {
  return variable_scales(problem, x).cwiseMax(local_scales(problem, x));
}

/// The limits that hold a design.
struct Holding {
  Eigen::VectorXd open;           ///< s; 0 of variables at a bound with multiplier, or fixed
  std::vector<bool> constraints;  ///< with multiplier, or equalities
};

Holding holding_limits(const Problem& problem, const EvaluatedDesign& design, const KktAudit& audit,
                       const Eigen::VectorXd& s) {
  const double threshold = held * audit.gradient_scale;
  Holding holding{s, {}};
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    const bool has_price = std::abs(audit.bound_multipliers[i]) * s[i] > threshold;
    if (has_price || problem.variables()[i].is_fixed()) holding.open[i] = 0.0;
  }
  for (Eigen::Index j = 0; j < design.evaluation.constraints.size(); ++j) {
    const double slope =
        design.evaluation.constraint_jacobian.row(j).transpose().cwiseProduct(s).norm();
    const bool has_price = std::abs(audit.constraint_multipliers[j]) * slope > threshold;
    holding.constraints.push_back(has_price || problem.constraints()[j].is_equality());
  }
  return holding;
}

/// Gradients of some constraints with respect to the variables that no bound holds, the rows of
/// length 1 (or 0).
class Rows {
 public:
  Rows(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& open,
       const std::vector<bool>& chosen)
      : matrix_(jacobian.rows(), open.size()), lengths_(jacobian.rows()) {
    Eigen::Index count = 0;
    for (Eigen::Index j = 0; j < jacobian.rows(); ++j) {
      const Eigen::VectorXd row = jacobian.row(j).transpose().cwiseProduct(open);
      const double length = row.norm();
      if (!chosen[j] || length == 0.0) continue;
      indices_.push_back(j);
      matrix_.row(count) = row.transpose() / length;
      lengths_[count++] = length;
    }
    matrix_.conservativeResize(count, Eigen::NoChange);
    lengths_.conservativeResize(count);
  }

  const Eigen::MatrixXd& matrix() const { return matrix_; }

  /// The shortest step, in variables divided by s, that changes the constraints by −excess.
  Eigen::VectorXd step_against(const Eigen::VectorXd& excess) const {
    const Eigen::VectorXd right = excess(indices_).cwiseQuotient(lengths_);
    return -least_norm_solution(matrix_, right);
  }

 private:
  std::vector<Eigen::Index> indices_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd lengths_;
};

/// Orthonormal, variables × dimension.
Eigen::MatrixXd tangent_basis(const Eigen::MatrixXd& rows, const Eigen::VectorXd& open) {
  const Eigen::Index count = (open.array() != 0.0).count();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(open.size(), count);
  Eigen::Index column = 0;
  for (Eigen::Index i = 0; i < open.size(); ++i) {
    if (open[i] != 0.0) basis(i, column++) = 1.0;
  }
  if (rows.rows() == 0 || count == 0) return basis;
  const Eigen::MatrixXd columns = (rows * basis).transpose();
  return basis * PivotedQr(columns, 1e-6).normal_space();
}

class Exploration {
 public:
  Exploration(EvaluationCache& cache, const EvaluatedDesign& design, const KktAudit& audit)
      : cache_(cache),
        design_(design),
        multipliers_(audit.constraint_multipliers),
        bound_multipliers_(audit.bound_multipliers),
        s_(lengths(cache.problem(), design.x)),
        holding_(holding_limits(cache.problem(), design, audit, s_)),
        basis_(tangent_basis(rows(holding_.constraints).matrix(), holding_.open)) {}

  Neighbourhood explore(double value_scale, double least_gain) {
    Neighbourhood result;
    result.dimension = static_cast<int>(basis_.cols());
    if (result.dimension == 0) return result;
    const LowestCurvature lowest = find_lowest_curvature();
    result.directions = lowest.products;
    if (lowest.products == 0) return result;
    result.gain_left = gain_left(lowest) / value_scale;
    result.is_plateau = is_plateau(lowest, value_scale);
    for (const double sign : {1.0, -1.0}) {
      const Neighbour neighbour = follow(sign * lowest.direction, value_scale);
      if (neighbour.gain <= std::max(result.gain, least_gain) * value_scale) continue;
      result.gain = neighbour.gain / value_scale;
      result.better = neighbour.x;
    }
    return result;
  }

 private:
  struct Neighbour {
    Eigen::VectorXd x;
    double gain = 0.0;
  };

  Rows rows(const std::vector<bool>& chosen) const {
    return Rows(design_.evaluation.constraint_jacobian, holding_.open, chosen);
  }

  /// s ∘ ∇L
  std::optional<Eigen::VectorXd> lagrangian_gradient(const Eigen::VectorXd& x) {
    const Evaluation* evaluation = cache_.evaluate(x, Request::values_and_gradients);
    if (evaluation == nullptr) return std::nullopt;
    return s_.cwiseProduct(evaluation->objective_gradient +
                           evaluation->constraint_jacobian.transpose() * multipliers_);
  }

  /// s ∘ ∇L at the design.
  Eigen::VectorXd remaining_gradient() const {
    const Evaluation& here = design_.evaluation;
    return s_.cwiseProduct(here.objective_gradient +
                           here.constraint_jacobian.transpose() * multipliers_ +
                           bound_multipliers_);
  }

  bool is_plateau(const LowestCurvature& lowest, double value_scale) const {
    const double bend = symmetric_modes(lowest.form).values.cwiseAbs().maxCoeff();
    return std::max((basis_.transpose() * remaining_gradient()).norm(), bend) <=
           nothing * value_scale;
  }

  /// See explore_neighbourhood().
  double gain_left(const LowestCurvature& lowest) const {
    const Eigen::VectorXd gradient = remaining_gradient();
    const Eigen::VectorXd open = basis_.transpose() * gradient;
    const SymmetricModes modes = symmetric_modes(lowest.form);
    const Eigen::VectorXd slopes =
        modes.vectors.transpose() * (lowest.directions.transpose() * gradient);
    const double rest = std::sqrt(std::max(0.0, open.squaredNorm() - slopes.squaredNorm()));
    double sum = gain_along(rest, modes.values[0]);
    for (Eigen::Index k = 0; k < slopes.size(); ++k) {
      sum += gain_along(slopes[k], modes.values[k]);
    }
    return sum;
  }

  static double gain_along(double slope, double curvature) {
    const double steep = std::abs(slope);
    if (steep <= reach * curvature) return steep == 0.0 ? 0.0 : 0.5 * steep * steep / curvature;
    return steep * reach - 0.5 * std::max(0.0, curvature) * reach * reach;
  }

  /// The design, moved off bounds that do not hold it: so far that a step to any side stays within.
  Eigen::VectorXd moved_off_bounds() const {
    Eigen::VectorXd x = design_.x;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (holding_.open[i] == 0.0) continue;
      const Variable& variable = cache_.problem().variables()[i];
      const double step = distance * s_[i];
      x[i] = std::clamp(x[i], variable.lower + step, variable.upper - step);
    }
    return x;
  }

  LowestCurvature find_lowest_curvature() {
    const Eigen::VectorXd base = moved_off_bounds();
    const auto at_base = lagrangian_gradient(base);
    if (!at_base) return {};
    const HessianProduct product =
        [&](const Eigen::VectorXd& direction) -> std::optional<Eigen::VectorXd> {
      for (const double h : {distance, -distance}) {
        const Eigen::VectorXd moved = base + h * s_.cwiseProduct(direction);
        const auto gradient = lagrangian_gradient(within_bounds(cache_.problem(), moved));
        if (gradient) return (*gradient - *at_base) / h;
      }
      return std::nullopt;
    };
    return lowest_curvature(product, basis_, most_directions);
  }

  /// The best design on the way, for as long as it gets better.
  Neighbour follow(const Eigen::VectorXd& direction, double value_scale) {
    Neighbour best{design_.x, 0.0};
    for (int k = 0; k <= doublings; ++k) {
      const double length = distance * std::pow(2.0, k);
      const auto neighbour = neighbour_at(design_.x + length * s_.cwiseProduct(direction));
      if (!neighbour || neighbour->x == best.x) break;
      if (neighbour->gain <= best.gain + noise * value_scale) break;
      best = *neighbour;
      if (best.gain > far_enough * value_scale) break;
    }
    return best;
  }

  /// The design beside x that keeps the limits, to the accuracy of one Newton step.
  std::optional<Neighbour> neighbour_at(const Eigen::VectorXd& x) {
    Eigen::VectorXd moved = within_bounds(cache_.problem(), x);
    const Evaluation* evaluation = cache_.evaluate(moved, Request::values);
    if (evaluation == nullptr) return std::nullopt;
    const Eigen::VectorXd excess = excess_of(evaluation->constraints);
    const Eigen::VectorXd relative = excess.cwiseQuotient(cache_.scales().constraints);
    if (relative.size() > 0 && relative.lpNorm<Eigen::Infinity>() > restored) {
      const Eigen::VectorXd back = rows(exceeded(excess)).step_against(excess);
      moved = within_bounds(cache_.problem(), moved + s_.cwiseProduct(back));
      evaluation = cache_.evaluate(moved, Request::values);
      if (evaluation == nullptr) return std::nullopt;
    }
    const double violation =
        max_violation(cache_.problem(), evaluation->constraints, cache_.scales().constraints);
    if (violation > std::max(tolerated, design_.max_violation)) return std::nullopt;
    // What is still missing to the limits, or has been gained by leaving them, at its price.
    const double correction =
        multipliers_.dot(evaluation->constraints - design_.evaluation.constraints);
    return Neighbour{moved, design_.evaluation.objective - evaluation->objective - correction};
  }

  /// How far constraints are off: those that hold the design from their values there, others from
  /// the limit that they exceed.
  Eigen::VectorXd excess_of(const Eigen::VectorXd& constraints) const {
    Eigen::VectorXd excess = constraints - design_.evaluation.constraints;
    for (Eigen::Index j = 0; j < excess.size(); ++j) {
      if (holding_.constraints[j]) continue;
      const Constraint& limits = cache_.problem().constraints()[j];
      excess[j] = std::max(0.0, constraints[j] - limits.upper) -
                  std::max(0.0, limits.lower - constraints[j]);
    }
    return excess;
  }

  std::vector<bool> exceeded(const Eigen::VectorXd& excess) const {
    std::vector<bool> chosen = holding_.constraints;
    for (Eigen::Index j = 0; j < excess.size(); ++j) {
      if (excess[j] != 0.0) chosen[j] = true;
    }
    return chosen;
  }

  EvaluationCache& cache_;
  const EvaluatedDesign& design_;
  const Eigen::VectorXd multipliers_, bound_multipliers_;
  const Eigen::VectorXd s_;
  const Holding holding_;
  const Eigen::MatrixXd basis_;
};

}  // namespace

Neighbourhood explore_neighbourhood(EvaluationCache& cache, const EvaluatedDesign& design,
                                    const KktAudit& audit, const Evaluation& start,
                                    double least_gain) {
  return Exploration(cache, design, audit)
      .explore(objective_value_scale(design.evaluation, start), least_gain);
}

}  // namespace pleuel
