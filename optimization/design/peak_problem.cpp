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

Extreme opposite(Extreme extreme) {
  return extreme == Extreme::largest ? Extreme::smallest : Extreme::largest;
}

const ResponseSettings& response_of(const DesignProblem& problem, const RowSource& source) {
  if (source.over_cases) return problem.file().responses[*source.over_cases];
  const DesignCase& of_case = problem.load_case(source.load_case);
  return of_case.file().responses[*of_case.response_of(source)];
}

/// The sources of the rows.
struct Sources {
  DesignProblem& problem;
  int windows;

  /// Which values of a response count: the large ones of an upper limit and of what is minimized. None
  /// where both do, or a single one.
  std::optional<Extreme> pressed_side(std::optional<std::size_t> constraint) const {
    if (!constraint) {
      const bool is_maximized = problem.file().objective->aim == Aim::maximize;
      return is_maximized ? Extreme::smallest : Extreme::largest;
    }
    const Constraint& limits = problem.constraints()[*constraint];
    if (limits.has_upper() == limits.has_lower()) return std::nullopt;
    return limits.has_upper() ? Extreme::largest : Extreme::smallest;
  }

  /// Of a limit or, without a constraint, of the objective of a case: one for each response that is pressed upon.
  std::vector<RowSource> in_case(std::size_t load_case,
                                 std::optional<std::size_t> constraint) const {
    const DesignCase& of_case = problem.load_case(load_case);
    RowSource whole{load_case};
    if (constraint) {
      whole.constraint = case_of_constraint(problem.file(), *constraint).index;
    }
    const auto response = of_case.response_of(whole);
    const auto side = pressed_side(constraint);
    if (!response || !side) return {whole};
    std::vector<RowSource> sources;
    for (const std::size_t part : extreme_parts(of_case.file(), *response, *side)) {
      RowSource one = whole;
      one.part = part;
      sources.push_back(divided(one, *side));
    }
    if (sources.empty()) sources.push_back(divided(whole, *side));
    return sources;
  }

  /// The same of a response of the joined problem.
  std::vector<RowSource> over_cases(std::size_t response,
                                    std::optional<std::size_t> constraint) const {
    const ProblemFile& file = problem.file();
    const auto side = pressed_side(constraint);
    std::vector<std::size_t> parts;
    if (side) parts = extreme_parts(file, response, *side);
    if (parts.empty()) parts.push_back(response);
    std::vector<RowSource> sources;
    for (const std::size_t part : parts) {
      const RowSource one = response_row(file, part, constraint ? 1.0 : problem.objective_sign());
      sources.push_back(side ? divided(one, *side) : one);
    }
    return sources;
  }

  RowSource divided(RowSource source, Extreme side) const {
    if (source.over_cases) return source;
    const DesignCase& of_case = problem.load_case(source.load_case);
    const std::size_t response = *of_case.response_of(source);
    std::vector<LinearPart> parts = linear_parts(of_case.file(), response);
    if (parts.empty()) parts = {{response, 1.0}};
    std::erase_if(parts, [&](const LinearPart& part) {
      const bool presses = is_extreme(of_case.file().responses[part.response],
                                      part.factor > 0.0 ? side : opposite(side));
      return !presses || !can_be_divided(of_case.file().responses[part.response]);
    });
    const int most = static_cast<int>(
        std::pow(most_rows, 1.0 / std::max(1.0, static_cast<double>(parts.size()))));
    for (const auto& [part, factor] : parts) {
      const PeakDivision division =
          division_of(of_case.file(), of_case.file().responses[part], most);
      const bool is_whole = part == response;
      if (is_whole || division.peaks() <= most) source.divided.push_back({part, factor, division});
    }
    return source;
  }

  /// @param most  peaks
  PeakDivision division_of(const ProblemFile& file, const ResponseSettings& response,
                           int most) const {
    const int places = place_count(file, response);
    if (response.is<FatigueResponse>()) return {1, places};
    const int most_windows = std::min(windows, step_count(file.simulation) + 1);
    const int fewest = std::min(least_windows, most_windows);
    const auto limits = int_size(problem.file().constraints);
    const int rows = most_rows_of_all / std::max(1, limits);
    if (places == 1) return {std::clamp(std::min(rows, most), fewest, most_windows), 1};
    return {std::clamp(std::min(most, rows) / places, fewest, most_windows), places};
  }
};

}  // namespace

PeakProblem::PeakProblem(DesignProblem& problem, int windows)
    : PeakProblem(problem, windows, start_of(problem)) {}

PeakProblem::PeakProblem(DesignProblem& problem, int windows, const Eigen::VectorXd& start,
                         Scope scope)
    : problem_(problem), windows_(windows), variables_(problem.variables()) {
  const ProblemFile& file = problem.file();
  int samples = 1;
  for (std::size_t c = 0; c < problem.case_count(); ++c) {
    samples = std::max(samples, step_count(problem.load_case(c).file().simulation) + 1);
  }
  windows_ = std::min(windows_, samples);
  const Sources from{problem, windows_};
  set_start(variables_, within_bounds(problem, start));
  for (std::size_t i = 0; i < file.constraints.size(); ++i) {
    const OfCase of_case = case_of_constraint(file, i);
    const auto sources = is_of_several(of_case) ? from.over_cases(*problem.response_of(i), i)
                                                : from.in_case(of_case.load_case, i);
    for (const RowSource& source : sources) add_rows(source, i, problem.constraints()[i]);
  }
  if (scope == Scope::objective_and_limits) bound_objective();
  name_rows();
}

void PeakProblem::add_rows(const RowSource& source, std::optional<std::size_t> constraint,
                           const Constraint& limits) {
  rows_.insert(rows_.end(), source.count(), limits);
  constraint_of_row_.insert(constraint_of_row_.end(), source.count(), constraint);
  named_rows_.sources.push_back(source);
}

/// Where peaks are pressed down from above, a maximum that is minimized or a minimum that is maximized, or the
/// worst of several.
void PeakProblem::bound_objective() {
  const bool is_in_cases = problem_.has_objective_in_cases();
  const Sources from{problem_, windows_};
  const std::vector<RowSource> first =
      is_in_cases ? from.in_case(0, std::nullopt)
                  : from.over_cases(problem_.objective_response(), std::nullopt);
  const bool is_divided = first.size() > 1 || !first.front().divided.empty();
  if (!is_divided && !problem_.minimizes_worst()) return;
  EpigraphVariable all;
  if (!is_in_cases) all.sources = first;
  for (std::size_t c = 0; is_in_cases && c < problem_.case_count(); ++c) {
    const double weight = problem_.objective_weight(c);
    if (weight == 0.0) continue;
    for (const RowSource& source : from.in_case(c, std::nullopt)) all.sources.push_back(source);
    if (problem_.minimizes_worst()) continue;
    all.weight = weight;
    add_epigraph_variable(std::exchange(all, {}));
  }
  if (!all.sources.empty()) add_epigraph_variable(std::move(all));
  start_epigraph_variables();
}

void PeakProblem::add_epigraph_variable(EpigraphVariable bound) {
  bound.first_row = std::ssize(rows_);
  for (const RowSource& source : bound.sources) {
    add_rows(source, std::nullopt, {response_of(problem_, source).name, -infinity, 0.0});
  }
  bound.rows = std::ssize(rows_) - bound.first_row;
  bounds_.push_back(std::move(bound));
}

/// Each t begins at what it bounds.
void PeakProblem::start_epigraph_variables() {
  const Eigen::VectorXd start = start_of(*this);
  const Evaluation at_start = problem_.evaluate(start, Request::values_and_gradients);
  const double change =
      scaled_objective_gradient(problem_, at_start, variable_scales(problem_, start)).norm();
  const double magnitude = std::max(change, least_dependence * std::abs(at_start.objective));
  const std::string name = "bound of " + problem_.file().objective->response;
  const bool is_one = bounds_.size() == 1 && bounds_.front().weight == 1.0;
  for (const EpigraphVariable& bound : bounds_) {
    DesignCase& of_case = problem_.load_case(bound.sources.front().load_case);
    const double value =
        is_one ? at_start.objective
               : of_case.objective_sign() *
                     of_case.analysis_at(start).reductions[*of_case.response_of({})].value;
    variables_.push_back({is_one ? name : name_in_case(name, of_case.file().load_case), value,
                          -infinity, infinity, magnitude > 0.0 ? magnitude / bound.weight : 1.0});
  }
}

/// What is no goal of its case, whose goals the record knows (setting_text()), is named.
void PeakProblem::name_rows() {
  named_rows_.name =
      fmt::format("peaks of {} windows{}", windows_, bounds_.empty() ? "" : " with the objective");
  for (const RowSource& source : named_rows_.sources) {
    if (source.over_cases || !source.sign) continue;
    named_rows_.name += fmt::format(", {}{} in case {}", *source.sign < 0.0 ? "-" : "",
                                    response_of(problem_, source).name, source.load_case);
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
    const EpigraphVariable& bound = bounds_[b];
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
  return std::ranges::any_of(named_rows_.sources, [](const RowSource& source) {
    return std::ranges::any_of(
        source.divided, [](const DividedPeaks& peaks) { return peaks.division.windows > 1; });
  });
}

Eigen::VectorXd PeakProblem::objective_shares(const Eigen::VectorXd& multipliers) const {
  if (!problem_.minimizes_worst() || bounds_.empty()) return {};
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(problem_.case_count());
  Eigen::Index row = bounds_.front().first_row;
  for (const RowSource& source : bounds_.front().sources) {
    shares(source.load_case) += multipliers.segment(row, source.count()).sum();
    row += source.count();
  }
  return shares;
}

double PeakProblem::fold_objective(double objective, const Eigen::VectorXd& rows) const {
  for (const EpigraphVariable& bound : bounds_) {
    objective += bound.weight * rows.segment(bound.first_row, bound.rows).maxCoeff();
  }
  return objective;
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
