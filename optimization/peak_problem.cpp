#include "optimization/peak_problem.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace pleuel {

namespace {

/// Whether a response is the height of a peak of a history.
bool has_peaks(const ResponseSettings& response) {
  const bool is_constant =
      response.type == ResponseType::mass || response.type == ResponseType::frequency;
  return !is_constant && is_peak(response.over_time);
}

/// How much of a limit is used: larger is worse, above 0 is a violation.
double excess(const Constraint& constraint, double value) {
  return std::max(value - constraint.upper, constraint.lower - value);
}

}  // namespace

PeakProblem::PeakProblem(DesignProblem& problem, int windows)
    : problem_(problem), windows_(windows), variables_(problem.variables()) {
  const ProblemFile& file = problem.file();
  const SimulationSettings& settings = file.simulation;
  const int samples = step_count({.end_time = settings.end_time, .step = settings.step}) + 1;
  windows_ = std::min(windows_, samples);
  for (std::size_t i = 0; i < file.constraints.size(); ++i) {
    const Constraint& constraint = problem.constraints()[i];
    const std::string& name = file.constraints[i].response;
    const bool is_split = !name.empty() && !constraint.is_equality() &&
                          has_peaks(file.responses[problem.response_index(name)]);
    is_split_.push_back(is_split);
    for (int window = 0; window < (is_split ? windows_ : 1); ++window) {
      rows_.push_back(constraint);
      if (is_split) {
        const ResponseSettings& response = file.responses[problem.response_index(name)];
        const double from = response.from.value_or(0.0);
        const double duration = response.to.value_or(settings.end_time) - from;
        rows_.back().name +=
            fmt::format(" between {:.4g} and {:.4g} s", from + duration * window / windows_,
                        from + duration * (window + 1) / windows_);
      }
      constraint_of_row_.push_back(i);
    }
  }
}

void PeakProblem::start_from(const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    Variable& variable = variables_[i];
    variable.start = std::clamp(x(static_cast<Eigen::Index>(i)), variable.lower, variable.upper);
  }
}

Evaluation PeakProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  return problem_.evaluate_rows(x, request,
                                [this](const Analysis& analysis) { return rows_of(analysis); });
}

std::vector<ConstraintRow> PeakProblem::rows_of(const Analysis& analysis) const {
  std::vector<ConstraintRow> rows;
  for (std::size_t i = 0; i < is_split_.size(); ++i) {
    if (!is_split_[i]) {
      rows.push_back({i, std::nullopt});
      continue;
    }
    const std::size_t response = problem_.response_index(problem_.file().constraints[i].response);
    const Response& observed = analysis.responses[response];
    const Eigen::VectorXd& time = analysis.trajectory.time;
    for (Reduction& peak : reduce_windows(observed.over_time, time, analysis.histories[response],
                                          windows_, observed.steps(time))) {
      rows.push_back({i, std::move(peak)});
    }
  }
  return rows;
}

Eigen::VectorXd PeakProblem::fold_values(const Eigen::VectorXd& rows) const {
  const auto& constraints = problem_.constraints();
  Eigen::VectorXd values(static_cast<Eigen::Index>(constraints.size()));
  std::vector<bool> is_set(constraints.size(), false);
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const std::size_t i = constraint_of_row_[row];
    const double value = rows(static_cast<Eigen::Index>(row));
    double& worst = values(static_cast<Eigen::Index>(i));
    if (!is_set[i] || excess(constraints[i], value) > excess(constraints[i], worst)) worst = value;
    is_set[i] = true;
  }
  return values;
}

Eigen::VectorXd PeakProblem::fold_multipliers(const Eigen::VectorXd& rows) const {
  Eigen::VectorXd sums =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem_.constraints().size()));
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    sums(static_cast<Eigen::Index>(constraint_of_row_[row])) +=
        rows(static_cast<Eigen::Index>(row));
  }
  return sums;
}

}  // namespace pleuel
