#include "optimization/linear_choice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "optimization/kkt_audit.hpp"

namespace pleuel {

namespace {

class Branching {
 public:
  Branching(const LinearChoiceModel& model, std::size_t count, double allowed, long nodes)
      : model_(model), count_(count), nodes_(nodes), order_(model.options.size()) {
    lower_ = model.lower - allowed * model.scales;
    upper_ = model.upper + allowed * model.scales;
    sort_variables();
    find_least_additions();
    sizes_.resize(model.options.size());
  }

  std::vector<PredictedChoice> run() {
    branch(0, model_.objective, model_.constraints);
    return std::move(found_);
  }

 private:
  /// Of what a variable can change of the objective.
  double spread(std::size_t variable) const {
    const auto [least, most] =
        std::ranges::minmax_element(model_.options[variable], {}, &LinearOption::objective);
    return most->objective - least->objective;
  }

  /// Those that matter most first.
  void sort_variables() {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::stable_sort(order_, std::greater(),
                             [&](std::size_t variable) { return spread(variable); });
    for (const std::size_t variable : order_) {
      sorted_.push_back(model_.options[variable]);
      std::ranges::stable_sort(sorted_.back(), {}, &LinearOption::objective);
    }
  }

  /// What the variables from each depth on add at least, and at most.
  void find_least_additions() {
    const std::size_t depth = order_.size();
    const Eigen::Index rows = model_.constraints.size();
    least_objective_.assign(depth + 1, 0.0);
    least_.assign(depth + 1, Eigen::VectorXd::Zero(rows));
    most_ = least_;
    for (std::size_t i = depth; i-- > 0;) {
      least_objective_[i] = least_objective_[i + 1] + sorted_[i].front().objective;
      Eigen::VectorXd least = sorted_[i].front().constraints, most = least;
      for (const LinearOption& option : sorted_[i]) {
        least = least.cwiseMin(option.constraints);
        most = most.cwiseMax(option.constraints);
      }
      least_[i] = least_[i + 1] + least;
      most_[i] = most_[i + 1] + most;
    }
  }

  bool is_hopeless(std::size_t depth, double objective, const Eigen::VectorXd& constraints) const {
    const bool is_full = found_.size() == count_;
    if (is_full && objective + least_objective_[depth] >= found_.back().objective) return true;
    return ((constraints + least_[depth]).array() > upper_.array()).any() ||
           ((constraints + most_[depth]).array() < lower_.array()).any();
  }

  void branch(std::size_t depth, double objective, const Eigen::VectorXd& constraints) {
    if (--nodes_ < 0 || is_hopeless(depth, objective, constraints)) return;
    if (depth == order_.size()) {
      add(objective);
      return;
    }
    for (const LinearOption& option : sorted_[depth]) {
      sizes_[order_[depth]] = option.size;
      branch(depth + 1, objective + option.objective, constraints + option.constraints);
    }
  }

  void add(double objective) {
    const auto place = std::ranges::upper_bound(found_, objective, {}, &PredictedChoice::objective);
    found_.insert(place, {sizes_, objective});
    if (found_.size() > count_) found_.pop_back();
  }

  const LinearChoiceModel& model_;
  std::size_t count_;
  long nodes_;
  Eigen::VectorXd lower_, upper_;
  std::vector<std::size_t> order_;                 ///< of the variables
  std::vector<std::vector<LinearOption>> sorted_;  ///< in that order, the lowest objective first
  std::vector<double> least_objective_;
  std::vector<Eigen::VectorXd> least_, most_;
  std::vector<int> sizes_;
  std::vector<PredictedChoice> found_;
};

}  // namespace

std::vector<PredictedChoice> best_choices(const LinearChoiceModel& model, std::size_t count,
                                          double allowed, long nodes) {
  return Branching(model, count, allowed, nodes).run();
}

namespace {

/// One-sided rows B x ≤ b with the limits that they are of; of the bounds −1.
struct OneSided {
  std::vector<Eigen::RowVectorXd> rows;
  std::vector<double> right;
  std::vector<int> owners;

  /// Rows have unit length. Those without a limit are none, and those without coefficients say what they say.
  void add(const Eigen::RowVectorXd& row, double limit, int owner) {
    if (!std::isfinite(limit)) return;
    const double length = row.norm() > 0.0 ? row.norm() : 1.0;
    rows.push_back(row / length);
    right.push_back(limit / length);
    owners.push_back(owner);
  }
};

}  // namespace

std::vector<std::size_t> linear_conflict(const LinearLimits& limits, const Eigen::VectorXd& lower,
                                         const Eigen::VectorXd& upper) {
  constexpr double round_off = 1e-9;
  // In t = (x − lower)/(upper − lower), so that all variables count alike.
  const Eigen::VectorXd range = upper - lower;
  const Eigen::MatrixXd scaled = limits.rows * range.asDiagonal();
  const Eigen::VectorXd begin = limits.rows * lower;
  OneSided all;
  for (int i = 0; i < static_cast<int>(scaled.rows()); ++i) {
    all.add(scaled.row(i), limits.upper(i) - begin(i), i);
    all.add(-scaled.row(i), begin(i) - limits.lower(i), i);
  }
  for (Eigen::Index i = 0; i < range.size(); ++i) {
    const Eigen::RowVectorXd unit = Eigen::RowVectorXd::Unit(range.size(), i);
    all.add(unit, 1.0, -1);
    all.add(-unit, 0.0, -1);
  }
  const Eigen::Index count = int_size(all.rows);
  Eigen::MatrixXd columns(range.size() + 1, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    columns.col(k).head(range.size()) = all.rows[k].transpose();
    columns(range.size(), k) = all.right[k];
  }
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(range.size() + 1);
  wanted(range.size()) = -1.0;
  const Eigen::VectorXd y = nonnegative_least_squares(columns, wanted);
  // Rows have unit length: with all limits wider by 1/Σy there is a point.
  if ((columns * y - wanted).norm() > round_off || y.sum() * round_off > 1.0) return {};
  std::set<std::size_t> owners;
  for (Eigen::Index k = 0; k < count; ++k) {
    if (y(k) > 0.0 && all.owners[k] >= 0) owners.insert(all.owners[k]);
  }
  return {owners.begin(), owners.end()};
}

}  // namespace pleuel
