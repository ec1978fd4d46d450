#include "studies/row_prices.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "optimization/design/peak_windows.hpp"
#include "optimization/kkt_audit.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

constexpr int fewest_windows = 16, most_windows = 128;
/// KKT residual up to which multipliers explain a design.
constexpr double nearly_optimal = 1e-2;

/// Value of a row, or of the same limit in one of the windows beside it, if that is nearer to be
/// broken: with other steps a peak may cross the border of its window.
double nearby_value(const std::vector<Constraint>& rows, const Eigen::VectorXd& values,
                    Eigen::Index row, double multiplier) {
  const auto name = [&](Eigen::Index i) { return rows[i].name; };
  double value = values(row);
  for (const Eigen::Index other : {row - 1, row + 1}) {
    if (other < 0 || other >= values.size() || name(other) != name(row)) continue;
    value = multiplier > 0.0 ? std::max(value, values(other)) : std::min(value, values(other));
  }
  return value;
}

}  // namespace

DesignRows::DesignRows(const ProblemFile& problem, const Eigen::VectorXd& start, int windows,
                       int threads, Request request)
    : design(problem, threads),
      peaks(design, windows, start),
      robust(with_margins(peaks, design, peaks.constraint_of_row())),
      rows(robust ? *robust : peaks),
      x(checked_start(rows)),
      evaluation(rows.evaluate(x, request)) {}

int windows_at(const ProblemFile& problem, const Eigen::VectorXd& x, int threads) {
  if (problem.simulation.local_error > 0.0) return 1;
  DesignProblem design(problem, threads);
  return windows_that_part_peaks(design, x, fewest_windows, most_windows);
}

RowPrices::RowPrices(const ProblemFile& problem, const Eigen::VectorXd& x, int window_count,
                     int thread_count)
    : design(x),
      windows(window_count),
      threads(thread_count),
      at(problem, x, windows, threads),
      scales(constraint_scales(at.rows, at.evaluation, variable_scales(at.rows, at.x))) {
  const double violation = max_violation(at.rows, at.evaluation.constraints, scales);
  // No search led here: the objective itself says what is small of its slopes.
  Evaluation reference = at.evaluation;
  reference.objective *= 2.0;
  const KktAudit audit = audit_kkt(at.rows, {at.x, at.evaluation, violation}, reference, scales);
  residual = audit.residual;
  multipliers = prices_of(at.rows, at.evaluation.constraints, audit.constraint_multipliers, scales);
  bound_multipliers = audit.bound_multipliers;
}

double RowPrices::lagrangian(const ProblemFile& other) const {
  const DesignRows there(other, design, windows, threads, Request::values);
  // The bound of the peak that is minimized is that of this design, not of the other problem.
  const Evaluation evaluation =
      there.x == at.x ? there.evaluation : there.rows.evaluate(at.x, Request::values);
  double sum = evaluation.objective;
  for (Eigen::Index i = 0; i < multipliers.size(); ++i) {
    if (multipliers(i) == 0.0) continue;
    sum += multipliers(i) *
           nearby_value(at.rows.constraints(), evaluation.constraints, i, multipliers(i));
  }
  return sum;
}

PricedDesign::PricedDesign(const ProblemFile& problem, const Eigen::VectorXd& x)
    : x_(x), has_equal_steps_(problem.simulation.local_error == 0.0) {
  if (!problem.objective || x.size() == 0 || x == start_design(problem)) return;
  try {
    prices_ = std::make_unique<RowPrices>(problem, x, windows_at(problem, x, 1), 1);
    if (prices_->residual > nearly_optimal) prices_.reset();
  } catch (const SimulationError&) {
    prices_.reset();
  }
}

std::optional<double> PricedDesign::lagrangian(const ProblemFile& other) const {
  const bool has_windows = (other.simulation.local_error == 0.0) == has_equal_steps_;
  if (!prices_ || !has_windows) return std::nullopt;
  std::optional<double> sum;  // none where it fails
  failure_of([&] { sum = prices_->lagrangian(other); });
  return sum;
}

std::optional<double> PricedDesign::change(const std::optional<double>& before,
                                           const ProblemFile& after) const {
  const std::optional<double> changed = before ? lagrangian(after) : std::nullopt;
  return changed ? std::optional(*changed - *before) : std::nullopt;
}

}  // namespace pleuel
