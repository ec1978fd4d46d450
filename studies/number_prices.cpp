#include "studies/number_prices.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "optimization/kkt_audit.hpp"
#include "optimization/margin_problem.hpp"
#include "optimization/peak_problem.hpp"
#include "optimization/peak_windows.hpp"
#include "optimization/prices.hpp"
#include "optimization/scaling.hpp"
#include "studies/priced_numbers.hpp"

namespace pleuel {

namespace {

constexpr int fewest_windows = 16, most_windows = 128;
/// What is left of the terms of a price where they cancel, by the round-off of gradients.
constexpr double round_off = 1e-7;
/// Of the objective: a percent of a number that changes less of it has no price.
constexpr double least_change = 1e-10;
/// Of the magnitude of a limit: what counts as reaching it.
constexpr double at_limit = 1e-6;

/// A design with its rows (the peaks of all windows) and their gradients.
class Rows {
 public:
  Rows(const ProblemFile& problem, const Eigen::VectorXd& x, int windows, int threads)
      : design_(problem, threads),
        peaks_(design_, windows, x),
        robust_(with_margins(peaks_, design_, peaks_.constraint_of_row())) {
    x_ = checked_start(rows());
    evaluation_ = rows().evaluate(x_, Request::values_and_gradients);
  }

  Problem& rows() { return robust_ ? *robust_ : peaks_; }
  const PeakProblem& peaks() const { return peaks_; }
  DesignProblem& design() { return design_; }
  const Eigen::VectorXd& x() const { return x_; }
  const Evaluation& evaluation() const { return evaluation_; }

 private:
  DesignProblem design_;
  PeakProblem peaks_;
  std::unique_ptr<Problem> robust_;
  Eigen::VectorXd x_;  ///< with the peak that is minimized, if one is
  Evaluation evaluation_;
};

/// The problem as the file has it, its multipliers, and how it answers a small change.
class Optimum {
 public:
  Optimum(const ProblemFile& problem, const Eigen::VectorXd& x, int windows, int threads)
      : rows_(problem, x, windows, threads) {
    const Problem& peaks = rows_.rows();
    const Evaluation& evaluation = rows_.evaluation();
    scales_ = constraint_scales(peaks, evaluation, variable_scales(peaks, rows_.x()));
    const double violation = max_violation(peaks, evaluation.constraints, scales_);
    const KktAudit audit =
        audit_kkt(peaks, {rows_.x(), evaluation, violation}, evaluation, scales_);
    residual_ = audit.residual;
    multipliers_ = prices_of(peaks, evaluation.constraints, audit.constraint_multipliers, scales_);
    bound_multipliers_ = audit.bound_multipliers;
  }

  Rows& rows() { return rows_; }
  double residual() const { return residual_; }
  const Eigen::VectorXd& multipliers() const { return multipliers_; }
  const Eigen::VectorXd& bound_multipliers() const { return bound_multipliers_; }

  /// The first limit beyond those that decide now which a change of the rows makes a design break
  /// that answers it; empty if there is none.
  /// @param change  of the values of the rows, at the design as it is
  std::string next_limit(const Eigen::VectorXd& change) const {
    const Eigen::VectorXd step = answer(change);
    const Evaluation& evaluation = rows_.evaluation();
    const Eigen::VectorXd values =
        evaluation.constraints + change + evaluation.constraint_jacobian * step;
    const std::vector<Constraint>& constraints = problem().constraints();
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const Constraint& limits = constraints[static_cast<std::size_t>(i)];
      const double excess = std::max(values(i) - limits.upper, limits.lower - values(i));
      if (multipliers_(i) == 0.0 && excess > at_limit * scales_(i)) return name_of_row(i);
    }
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      const Variable& variable = problem().variables()[static_cast<std::size_t>(i)];
      const double value = rows_.x()(i) + step(i);
      const double room = at_limit * std::abs(value);
      if (bound_multipliers_(i) == 0.0 && !variable.is_fixed() &&
          (value > variable.upper + room || value < variable.lower - room)) {
        return variable.name;
      }
    }
    return "";
  }

 private:
  const Problem& problem() const { return rows_.peaks(); }

  /// A row of a constraint that decides already is another of its peaks.
  std::string name_of_row(Eigen::Index row) const {
    const std::string& name = problem().constraints()[static_cast<std::size_t>(row)].name;
    for (Eigen::Index i = 0; i < multipliers_.size(); ++i) {
      const bool is_same = problem().constraints()[static_cast<std::size_t>(i)].name == name;
      if (is_same && multipliers_(i) != 0.0) return "another peak of " + name;
    }
    return name;
  }

  /// The least change of the free variables, in their magnitudes, that keeps the rows which decide
  /// where they are. The whole answer if as many rows decide as there are free variables.
  Eigen::VectorXd answer(const Eigen::VectorXd& change) const {
    const Eigen::VectorXd s = local_scales(problem(), rows_.x());
    std::vector<Eigen::Index> free, deciding;
    for (Eigen::Index i = 0; i < s.size(); ++i) {
      const bool is_fixed = problem().variables()[static_cast<std::size_t>(i)].is_fixed();
      if (bound_multipliers_(i) == 0.0 && !is_fixed) free.push_back(i);
    }
    for (Eigen::Index i = 0; i < change.size(); ++i) {
      if (multipliers_(i) != 0.0) deciding.push_back(i);
    }
    Eigen::VectorXd step = Eigen::VectorXd::Zero(s.size());
    if (free.empty() || deciding.empty()) return step;
    const Eigen::MatrixXd scaled = rows_.evaluation().constraint_jacobian * s.asDiagonal();
    const Eigen::VectorXd magnitudes = scales_(deciding).cwiseInverse();
    const Eigen::MatrixXd matrix = magnitudes.asDiagonal() * scaled(deciding, free);
    const Eigen::VectorXd right = -magnitudes.cwiseProduct(change(deciding));
    const Eigen::VectorXd found = matrix.completeOrthogonalDecomposition().solve(right);
    for (std::size_t k = 0; k < free.size(); ++k) {
      step(free[k]) = s(free[k]) * found(static_cast<Eigen::Index>(k));
    }
    return step;
  }

  Rows rows_;
  Eigen::VectorXd scales_, multipliers_, bound_multipliers_;
  double residual_ = 0.0;
};

/// Prices of variables from the gradient of their problem, at the multipliers of the optimum.
class Pricing {
 public:
  Pricing(const Optimum& optimum, const Evaluation& evaluation)
      : optimum_(optimum), evaluation_(evaluation) {}

  void set(Eigen::Index variable, NumberPrice& price) const {
    const double direct = evaluation_.objective_gradient(variable);
    const Eigen::VectorXd through =
        optimum_.multipliers().cwiseProduct(evaluation_.constraint_jacobian.col(variable));
    const double terms = std::abs(direct) + through.cwiseAbs().sum();
    const double sum = direct + through.sum();
    const double change = price.value == 0.0 ? sum : 0.01 * price.value * sum;
    const bool is_noise = std::abs(sum) <= round_off * terms ||
                          std::abs(change) <= least_change * std::abs(evaluation_.objective);
    price.per_unit = is_noise ? 0.0 : sum;
    price.next_limit =
        optimum_.next_limit(0.01 * price.value * evaluation_.constraint_jacobian.col(variable));
  }

 private:
  const Optimum& optimum_;
  const Evaluation& evaluation_;
};

/// The problem with all numbers as variables; decisions that a measurement made stay.
ProblemFile with_numbers(const ProblemText& text, const ProblemFile& problem,
                         const std::vector<NumberGroup>& groups) {
  ProblemFile extended = bind_numbers(text, groups);
  extended.effects = problem.effects;
  extended.sensitivity = problem.sensitivity;
  return extended;
}

Eigen::VectorXd extended_design(const ProblemFile& extended, const Eigen::VectorXd& x) {
  Eigen::VectorXd design = start_design(extended);
  design.head(x.size()) = x;
  return design;
}

void add_limits(const ProblemFile& problem, Optimum& optimum, PriceList& list) {
  const Eigen::VectorXd multipliers =
      optimum.rows().peaks().fold_multipliers(optimum.multipliers());
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const double multiplier = multipliers(static_cast<Eigen::Index>(i));
    if (multiplier == 0.0) continue;
    const ConstraintSettings& constraint = problem.constraints[i];
    const bool is_upper = multiplier > 0.0;
    NumberPrice price;
    price.kind = NumberPrice::Kind::limit;
    price.name = fmt::format("/constraints/{}/{}", constraint.name, is_upper ? "upper" : "lower");
    price.pointers = {price.name};
    price.value = is_upper ? *constraint.upper : *constraint.lower;
    price.unit = unit_of(problem, constraint);
    price.per_unit = -multiplier;
    list.prices.push_back(std::move(price));
  }
}

void add_variables(const ProblemFile& problem, const Optimum& optimum, const Pricing& pricing,
                   PriceList& list) {
  const std::vector<ShownUnit> units = variable_units(problem);
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    const auto index = static_cast<Eigen::Index>(i);
    NumberPrice price;
    price.unit = units[i];
    if (variable.lower == variable.upper) {
      price.kind = NumberPrice::Kind::variable;
      price.name = variable.name;
      price.value = variable.lower;
      pricing.set(index, price);
    } else {
      const double multiplier = optimum.bound_multipliers()(index);
      if (multiplier == 0.0) continue;
      const bool is_upper = multiplier > 0.0;
      price.kind = NumberPrice::Kind::bound;
      price.name = fmt::format("/variables/{}/{}", variable.name, is_upper ? "upper" : "lower");
      price.value = is_upper ? variable.upper : variable.lower;
      price.per_unit = -multiplier;
    }
    price.pointers = {price.name};
    list.prices.push_back(std::move(price));
  }
}

void add_numbers(const ProblemFile& extended, const std::vector<NumberGroup>& groups,
                 const Pricing& pricing, PriceList& list) {
  const std::vector<ShownUnit> units = variable_units(extended);
  const std::size_t first = extended.variables.size() - groups.size();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    NumberPrice price;
    price.name = groups[i].name;
    price.pointers = groups[i].pointers;
    price.value = extended.variables[first + i].start;
    price.unit = units[first + i];
    pricing.set(static_cast<Eigen::Index>(first + i), price);
    list.prices.push_back(std::move(price));
  }
}

}  // namespace

PriceList number_prices(const ProblemText& text, const ProblemFile& problem,
                        const Eigen::VectorXd& x, int threads) {
  DesignProblem design(problem, threads);
  const int windows = windows_that_part_peaks(design, x, fewest_windows, most_windows);
  Optimum optimum(problem, x, windows, threads);
  const std::vector<NumberGroup> groups = priced_numbers(text, problem);
  const ProblemFile extended = with_numbers(text, problem, groups);
  Rows rows(extended, extended_design(extended, x), windows, threads);
  const Pricing pricing(optimum, rows.evaluation());
  PriceList list;
  const Evaluation& evaluation = optimum.rows().evaluation();
  list.objective =
      optimum.rows().peaks().fold_objective(evaluation.objective, evaluation.constraints);
  list.residual = optimum.residual();
  add_limits(problem, optimum, list);
  add_variables(problem, optimum, pricing, list);
  add_numbers(extended, groups, pricing, list);
  std::stable_sort(list.prices.begin(), list.prices.end(),
                   [](const NumberPrice& a, const NumberPrice& b) {
                     return std::abs(a.per_percent()) > std::abs(b.per_percent());
                   });
  return list;
}

}  // namespace pleuel
