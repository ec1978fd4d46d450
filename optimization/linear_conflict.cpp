#include "optimization/linear_conflict.hpp"

#include <cmath>
#include <set>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "optimization/nonnegative_least_squares.hpp"

namespace pleuel {

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
