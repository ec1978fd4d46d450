#include "optimization/peak_problem.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// How much of a limit is used: larger is worse, above 0 is a violation.
double excess(const Constraint& constraint, double value) {
  return std::max(value - constraint.upper, constraint.lower - value);
}

/// By how much of its peak the objective is taken to depend on the design at least.
constexpr double least_dependence = 1e-2;
/// Of one limit. Where places alone are more, each has two windows still.
constexpr int most_rows = 192, least_windows = 2;

Eigen::VectorXd starts_of(const DesignProblem& problem) {
  Eigen::VectorXd start(problem.variables().size());
  for (Eigen::Index i = 0; i < start.size(); ++i) start(i) = problem.variables()[i].start;
  return start;
}

}  // namespace

PeakProblem::PeakProblem(DesignProblem& problem, int windows)
    : PeakProblem(problem, windows, starts_of(problem)) {}

PeakProblem::PeakProblem(DesignProblem& problem, int windows, const Eigen::VectorXd& start, Of of)
    : problem_(problem), windows_(windows), variables_(problem.variables()) {
  const ProblemFile& file = problem.file();
  const int samples = step_count(file.simulation) + 1;
  windows_ = std::min(windows_, samples);
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    Variable& variable = variables_[i];
    variable.start = std::clamp(start(i), variable.lower, variable.upper);
  }
  for (std::size_t i = 0; i < file.constraints.size(); ++i) {
    const Constraint& constraint = problem.constraints()[i];
    const auto response = problem.response_of({i, std::nullopt});
    splits_.emplace_back();
    if (response && !constraint.is_equality() && has_peaks(file.responses[*response])) {
      splits_.back() = split(i);
      add_rows(*splits_.back(), constraint);
    } else {
      rows_.push_back(constraint);
      constraint_of_row_.emplace_back(i);
    }
  }
  if (of == Of::objective_and_limits) bound_objective();
}

PeakProblem::Split PeakProblem::split(std::optional<std::size_t> constraint) const {
  Split split;
  split.constraint = constraint;
  split.response = *problem_.response_of({constraint, std::nullopt});
  split.places = place_count(problem_.file(), problem_.file().responses[split.response]);
  const int fewest = std::min(least_windows, windows_);
  split.windows =
      split.places == 1 ? windows_ : std::clamp(most_rows / split.places, fewest, windows_);
  return split;
}

void PeakProblem::add_rows(const Split& split, const Constraint& limits) {
  const auto count = static_cast<std::size_t>(split.rows());
  rows_.insert(rows_.end(), count, limits);
  constraint_of_row_.insert(constraint_of_row_.end(), count, split.constraint);
}

void PeakProblem::bound_objective() {
  const std::size_t objective = *problem_.response_of({});
  const ResponseSettings& response = problem_.file().responses[objective];
  // What is pressed down from above: a maximum that is minimized, a minimum that is maximized.
  const bool is_minimum = response.over_time == OverTime::min;
  const bool is_maximized = problem_.file().objective->aim == Aim::maximize;
  if (!has_peaks(response) || is_minimum != is_maximized) return;
  bound_ = split(std::nullopt);
  add_rows(*bound_, {response.name, -infinity, 0.0});
  Eigen::VectorXd start(variables_.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) start(i) = variables_[i].start;
  const Evaluation at_start = problem_.evaluate(start, Request::values_and_gradients);
  const double change =
      scaled_objective_gradient(problem_, at_start, variable_scales(problem_, start)).norm();
  const double magnitude = std::max(change, least_dependence * std::abs(at_start.objective));
  variables_.push_back({"bound of " + response.name, at_start.objective, -infinity, infinity,
                        magnitude > 0.0 ? magnitude : 1.0});
}

std::string PeakProblem::variable_text(std::size_t variable, double value) const {
  return variable < problem_.variables().size() ? problem_.variable_text(variable, value)
                                                : problem_.objective_text(value);
}

std::string PeakProblem::constraint_text(std::size_t constraint, double value) const {
  const auto& of_file = constraint_of_row_[constraint];
  return of_file ? problem_.constraint_text(*of_file, value) : problem_.objective_text(value);
}

Evaluation PeakProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  const NamedRows rows = {
      fmt::format("peaks of {} windows{}", windows_, bound_ ? " with the objective" : ""),
      [this](const Analysis& analysis) { return rows_of(analysis); }};
  Evaluation evaluation = problem_.evaluate_rows(design_of(x), request, rows);
  if (!bound_) return evaluation;
  evaluation.objective = x(x.size() - 1);
  evaluation.constraints.tail(bound_->rows()).array() -= evaluation.objective;
  if (request == Request::values) return evaluation;
  evaluation.objective_gradient = Eigen::VectorXd::Unit(x.size(), x.size() - 1);
  evaluation.constraint_jacobian.conservativeResize(Eigen::NoChange, x.size());
  evaluation.constraint_jacobian.rightCols(1).setZero();
  evaluation.constraint_jacobian.rightCols(1).bottomRows(bound_->rows()).setConstant(-1.0);
  return evaluation;
}

void PeakProblem::add_peaks(Split& split, const Analysis& analysis,
                            std::vector<ConstraintRow>& rows) const {
  if (split.places > 1 && split.ranges.empty()) {
    split.ranges = places_of(analysis, problem_.file(), split.response, split.places);
  }
  for (Reduction& peak : peaks_of_places(analysis, split.response, split.ranges, split.windows)) {
    rows.push_back({split.constraint, std::move(peak)});
  }
}

std::vector<ConstraintRow> PeakProblem::rows_of(const Analysis& analysis) {
  std::vector<ConstraintRow> rows;
  for (std::size_t i = 0; i < splits_.size(); ++i) {
    if (splits_[i]) {
      add_peaks(*splits_[i], analysis, rows);
    } else {
      rows.push_back({i, std::nullopt});
    }
  }
  if (bound_) add_peaks(*bound_, analysis, rows);
  return rows;
}

Eigen::VectorXd PeakProblem::design_of(const Eigen::VectorXd& x) const {
  return x.head(problem_.variables().size());
}

double PeakProblem::fold_objective(double objective, const Eigen::VectorXd& rows) const {
  return bound_ ? objective + rows.tail(bound_->rows()).maxCoeff() : objective;
}

Eigen::VectorXd PeakProblem::fold_values(const Eigen::VectorXd& rows) const {
  const auto& constraints = problem_.constraints();
  Eigen::VectorXd values(constraints.size());
  std::vector<bool> is_set(constraints.size(), false);
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    if (!constraint_of_row_[row]) continue;
    const std::size_t i = *constraint_of_row_[row];
    const double value = rows(row);
    double& worst = values(i);
    if (!is_set[i] || excess(constraints[i], value) > excess(constraints[i], worst)) worst = value;
    is_set[i] = true;
  }
  return values;
}

Eigen::VectorXd PeakProblem::fold_multipliers(const Eigen::VectorXd& rows) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(problem_.constraints().size());
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    if (!constraint_of_row_[row]) continue;
    sums(*constraint_of_row_[row]) += rows(row);
  }
  return sums;
}

}  // namespace pleuel
