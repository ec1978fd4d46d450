#include "optimization/nonnegative_least_squares.hpp"

#include <limits>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// Part of ‖b‖ below which the correlation of a unit column with the residual is rounding.
constexpr double slope_rounding = 1e-13;

class LawsonHanson {
 public:
  LawsonHanson(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right)
      : matrix_(matrix), right_(right), z_(Eigen::VectorXd::Zero(matrix.cols())) {}

  Eigen::VectorXd solve() {
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

}  // namespace pleuel
