#include "optimization/design/peak_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/load_cases.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// By how much of its peak the objective is taken to depend on the design at least.
constexpr double least_dependence = 1e-2;
/// Of one limit, and of all limits together. Where places or limits alone are more, each has two
/// windows still.
constexpr int most_rows = 192, most_rows_of_all = 2048, least_windows = 2;

/// Whether the response is the largest, or the smallest, of its windows of time: a limit on it is one
/// on each of them.
bool is_extreme(const ResponseSettings& response, Extreme extreme) {
  return (response.over_time == OverTime::min) == (extreme == Extreme::smallest);
}

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
  int samples = 1;
  for (std::size_t c = 0; c < problem.case_count(); ++c) {
    samples = std::max(samples, step_count(problem.load_case(c).file().simulation) + 1);
  }
  windows_ = std::min(windows_, samples);
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    Variable& variable = variables_[i];
    variable.start = std::clamp(start(i), variable.lower, variable.upper);
  }
  for (std::size_t i = 0; i < file.constraints.size(); ++i) {
    const OfCase of_case = case_of_constraint(file, i);
    for (Split& one : is_of_several(of_case) ? split_over_cases(*problem.response_of(i), i)
                                             : split(of_case.load_case, i)) {
      add_rows(one, problem.constraints()[i]);
      splits_.push_back(std::move(one));
    }
  }
  if (of == Of::objective_and_limits) bound_objective();
  name_rows();
}

/// Which values of a response count: the large ones of an upper limit and of what is minimized. None
/// where both do, or a single one.
std::optional<Extreme> PeakProblem::pressed_side(std::optional<std::size_t> constraint) const {
  if (!constraint) {
    const bool is_maximized = problem_.file().objective->aim == Aim::maximize;
    return is_maximized ? Extreme::smallest : Extreme::largest;
  }
  const Constraint& limits = problem_.constraints()[*constraint];
  if (limits.has_upper() == limits.has_lower()) return std::nullopt;
  return limits.has_upper() ? Extreme::largest : Extreme::smallest;
}

std::vector<PeakProblem::Split> PeakProblem::split(std::size_t load_case,
                                                   std::optional<std::size_t> constraint) const {
  const DesignCase& of_case = problem_.load_case(load_case);
  const ProblemFile& file = of_case.file();
  Split whole;
  whole.load_case = load_case;
  whole.constraint = constraint;
  if (constraint) whole.in_case = case_of_constraint(problem_.file(), *constraint).index;
  const std::optional<std::size_t> in_case =
      constraint ? std::optional(whole.in_case) : std::nullopt;
  const auto response = of_case.response_of({in_case});
  if (response) whole.response = *response;
  const auto side = pressed_side(constraint);
  if (!response || !side) return {whole};
  std::vector<Split> all;
  for (const std::size_t part : extreme_parts(file, *response, *side)) {
    Split one = whole;
    one.part = part;
    one.response = part;
    all.push_back(told_apart(std::move(one), *side));
  }
  if (all.empty()) all.push_back(told_apart(whole, *side));
  return all;
}

const ResponseSettings& PeakProblem::response_of(const Split& split) const {
  if (split.over_cases) return problem_.file().responses[*split.over_cases];
  return problem_.load_case(split.load_case).file().responses[split.response];
}

PeakProblem::Split PeakProblem::told_apart(Split one, Extreme side) const {
  if (one.over_cases) return one;
  const ResponseSettings& settings = response_of(one);
  const bool can_be_divided = has_peaks(settings) || is_fatigue(settings);
  if (can_be_divided && is_extreme(settings, side)) {
    one.division = division_of(one.load_case, settings);
  }
  return one;
}

std::vector<PeakProblem::Split> PeakProblem::split_over_cases(
    std::size_t response, std::optional<std::size_t> constraint) const {
  const ProblemFile& file = problem_.file();
  const auto side = pressed_side(constraint);
  std::vector<std::size_t> parts;
  if (side) parts = extreme_parts(file, response, *side);
  if (parts.empty()) parts.push_back(response);
  std::vector<Split> all;
  for (const std::size_t part : parts) {
    Split one;
    one.constraint = constraint;
    one.sign = constraint ? 1.0 : problem_.objective_sign();
    const OfCase of_case = case_of_response(file, part);
    if (is_of_several(of_case)) {
      one.over_cases = part;
    } else {
      one.load_case = of_case.load_case;
      one.response = of_case.index;
      one.part = of_case.index;
    }
    all.push_back(side ? told_apart(std::move(one), *side) : std::move(one));
  }
  return all;
}

PeakDivision PeakProblem::division_of(std::size_t load_case,
                                      const ResponseSettings& response) const {
  const ProblemFile& file = problem_.load_case(load_case).file();
  const int places = place_count(file, response);
  if (is_fatigue(response)) return {1, places};
  const int windows = std::min(windows_, step_count(file.simulation) + 1);
  const int fewest = std::min(least_windows, windows);
  const auto limits = int_size(problem_.file().constraints);
  const int rows = most_rows_of_all / std::max(1, limits);
  if (places == 1) return {std::clamp(rows, fewest, windows), 1};
  return {std::clamp(std::min(most_rows, rows) / places, fewest, windows), places};
}

void PeakProblem::add_rows(const Split& split, const Constraint& limits) {
  const std::size_t count = split.rows();
  rows_.insert(rows_.end(), count, limits);
  constraint_of_row_.insert(constraint_of_row_.end(), count, split.constraint);
}

/// What is pressed down from above: a maximum that is minimized, a minimum that is maximized.
bool PeakProblem::objective_has_peaks() const {
  const std::vector<Split> first =
      problem_.has_objective_in_cases() ? split(0, std::nullopt) : objective_over_cases();
  return first.size() > 1 || first.front().division;
}

std::vector<PeakProblem::Split> PeakProblem::objective_over_cases() const {
  return split_over_cases(problem_.objective_response(), std::nullopt);
}

void PeakProblem::bound_objective() {
  const bool has_peaks = objective_has_peaks();
  if (!has_peaks && !problem_.minimizes_worst()) return;
  Bound all;
  if (!problem_.has_objective_in_cases()) {
    all.splits = objective_over_cases();
    add_bound(std::move(all));
    return start_bounds();
  }
  for (std::size_t c = 0; c < problem_.case_count(); ++c) {
    const double weight = problem_.objective_weight(c);
    if (weight == 0.0) continue;
    for (Split& of_case : split(c, std::nullopt)) all.splits.push_back(std::move(of_case));
    if (problem_.minimizes_worst()) continue;
    all.weight = weight;
    add_bound(std::exchange(all, Bound()));
  }
  if (!all.splits.empty()) add_bound(std::move(all));
  start_bounds();
}

void PeakProblem::add_bound(Bound bound) {
  bound.first_row = std::ssize(rows_);
  for (const Split& split : bound.splits) {
    add_rows(split, {response_of(split).name, -infinity, 0.0});
  }
  bound.rows = std::ssize(rows_) - bound.first_row;
  bounds_.push_back(std::move(bound));
}

/// Each t begins at what it bounds.
void PeakProblem::start_bounds() {
  const Eigen::Index count = variables_.size();
  Eigen::VectorXd start(count);
  for (Eigen::Index i = 0; i < count; ++i) start(i) = variables_[i].start;
  const Evaluation at_start = problem_.evaluate(start, Request::values_and_gradients);
  const double change =
      scaled_objective_gradient(problem_, at_start, variable_scales(problem_, start)).norm();
  const double magnitude = std::max(change, least_dependence * std::abs(at_start.objective));
  const std::string name = "bound of " + problem_.file().objective->response;
  const bool is_one = bounds_.size() == 1 && bounds_.front().weight == 1.0;
  for (const Bound& bound : bounds_) {
    const std::size_t c = bound.splits.front().load_case;
    DesignCase& of_case = problem_.load_case(c);
    const double value =
        is_one ? at_start.objective
               : of_case.objective_sign() *
                     of_case.analysis_at(start).reductions[*of_case.response_of({})].value;
    variables_.push_back({is_one ? name : name_in_case(name, of_case.file().load_case), value,
                          -infinity, infinity, magnitude > 0.0 ? magnitude / bound.weight : 1.0});
  }
}

/// All that is split, in the order of the rows.
void PeakProblem::name_rows() {
  named_rows_.name =
      fmt::format("peaks of {} windows{}", windows_, bounds_.empty() ? "" : " with the objective");
  named_rows_.cases.resize(problem_.case_count());
  Eigen::Index row = 0;
  const auto add = [&](const Split& split) {
    if (split.over_cases) {
      named_rows_.over_cases.push_back({*split.over_cases, row++, *split.sign});
      return;
    }
    CaseRows& rows = named_rows_.cases[split.load_case];
    const bool is_of_case = split.constraint && !split.sign;
    const auto constraint = is_of_case ? std::optional(split.in_case) : std::nullopt;
    rows.of.push_back({constraint, split.part, split.division, split.sign});
    if (split.sign) {  // no goal of its case, whose goals the record knows (setting_text.hpp)
      named_rows_.name += fmt::format(", {}{} in case {}", *split.sign < 0.0 ? "-" : "",
                                      response_of(split).name, split.load_case);
    }
    for (int i = 0; i < split.rows(); ++i) rows.places.push_back(row++);
  };
  for (const Split& split : splits_) add(split);
  for (const Bound& bound : bounds_) {
    for (const Split& split : bound.splits) add(split);
  }
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
  Evaluation evaluation = problem_.evaluate_rows(design_of(x), request, named_rows_);
  if (bounds_.empty()) return evaluation;
  const Eigen::Index designed = problem_.variables().size();
  const bool has_gradients = request == Request::values_and_gradients;
  evaluation.objective = 0.0;
  if (has_gradients) {
    evaluation.objective_gradient = Eigen::VectorXd::Zero(x.size());
    evaluation.constraint_jacobian.conservativeResize(Eigen::NoChange, x.size());
    evaluation.constraint_jacobian.rightCols(x.size() - designed).setZero();
  }
  for (std::size_t b = 0; b < bounds_.size(); ++b) {
    const Bound& bound = bounds_[b];
    const Eigen::Index column = designed + static_cast<Eigen::Index>(b);
    evaluation.objective += bound.weight * x(column);
    evaluation.constraints.segment(bound.first_row, bound.rows).array() -= x(column);
    if (!has_gradients) continue;
    evaluation.objective_gradient(column) = bound.weight;
    evaluation.constraint_jacobian.col(column)
        .segment(bound.first_row, bound.rows)
        .setConstant(-1.0);
  }
  return evaluation;
}

bool PeakProblem::divides_time() const {
  const auto divides = [](const Split& split) {
    return split.division && split.division->windows > 1;
  };
  return std::ranges::any_of(splits_, divides) ||
         std::ranges::any_of(bounds_, [&](const Bound& bound) {
           return std::ranges::any_of(bound.splits, divides);
         });
}

Eigen::VectorXd PeakProblem::objective_shares(const Eigen::VectorXd& multipliers) const {
  if (!problem_.minimizes_worst() || bounds_.empty()) return {};
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(problem_.case_count());
  Eigen::Index row = bounds_.front().first_row;
  for (const Split& split : bounds_.front().splits) {
    shares(split.load_case) += multipliers.segment(row, split.rows()).sum();
    row += split.rows();
  }
  return shares;
}

Eigen::VectorXd PeakProblem::design_of(const Eigen::VectorXd& x) const {
  return x.head(problem_.variables().size());
}

double PeakProblem::fold_objective(double objective, const Eigen::VectorXd& rows) const {
  for (const Bound& bound : bounds_) {
    objective += bound.weight * rows.segment(bound.first_row, bound.rows).maxCoeff();
  }
  return objective;
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
    const Constraint& limits = constraints[i];
    if (!is_set[i] || limits.excess(value) > limits.excess(worst)) worst = value;
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
