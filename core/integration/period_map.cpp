#include "core/integration/period_map.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/integration/step_differentiation.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

namespace {

/// Rows of the history that depend on others up to this.
constexpr double dependent_rows = 1e-12;

/// An orthonormal basis of the rows of the history, for states without units.
Eigen::MatrixXd row_basis(const Scheme& scheme) {
  const double h = scheme.step;
  const Eigen::Vector4d power(1.0, h, h * h, h * h);
  const Eigen::Matrix4d history =
      power.asDiagonal() * scheme.history * power.cwiseInverse().asDiagonal();
  const SymmetricModes modes = symmetric_modes(history.transpose() * history);
  Eigen::Index rank = 0;
  while (rank < 4 && modes.values(3 - rank) > dependent_rows * modes.values(3)) ++rank;
  return modes.vectors.rightCols(rank);
}

Eigen::VectorXd first_increment(const Mechanism& mechanism, const Trajectory& trajectory) {
  const State start = trajectory.state_at(0), end = trajectory.state_at(1);
  return difference(mechanism.rotations, end.q, start.q);
}

Eigen::MatrixXd one_minus(const Eigen::MatrixXd& matrix) {
  return Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()) - matrix;
}

/// Brings the largest entry of each row and column near one (Ruiz 2001): the condition of 1 − M then
/// says nothing of how accelerations are counted.
std::pair<Eigen::VectorXd, Eigen::VectorXd> balance(Eigen::MatrixXd& matrix) {
  constexpr int passes = 8;
  Eigen::VectorXd rows = Eigen::VectorXd::Ones(matrix.rows()), columns = rows;
  const auto inverse_root = [](double x) { return x > 0.0 ? 1.0 / std::sqrt(x) : 1.0; };
  for (int pass = 0; pass < passes; ++pass) {
    const Eigen::VectorXd row = matrix.cwiseAbs().rowwise().maxCoeff().unaryExpr(inverse_root);
    const Eigen::VectorXd column =
        matrix.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(inverse_root);
    matrix = row.asDiagonal() * matrix * column.asDiagonal();
    rows.array() *= row.array();
    columns.array() *= column.array();
  }
  return {rows, columns};
}

}  // namespace

PeriodMap::PeriodMap(Mechanism& mechanism, const Trajectory& trajectory, int steps)
    : n_(mechanism.system->coordinates()),
      rotations_(mechanism.rotations),
      states_(mechanism, trajectory.step_size(1)),
      increment_(first_increment(mechanism, trajectory)),
      basis_(row_basis(trajectory.scheme_of(1))),
      map_(differentiate(mechanism, trajectory, steps)),
      reduced_(project(map_)) {
  Eigen::MatrixXd rest = one_minus(reduced_);
  std::tie(row_scale_, column_scale_) = balance(rest);
  rest_.emplace(rest);
}

Eigen::MatrixXd PeriodMap::solve_rest(const Eigen::MatrixXd& b) const {
  return column_scale_.asDiagonal() * rest_->solve(row_scale_.asDiagonal() * b);
}

Eigen::MatrixXd PeriodMap::differentiate(Mechanism& mechanism, const Trajectory& trajectory,
                                         int steps) {
  const Eigen::Index columns = basis_.cols() * n_;
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::old_state);
  motion.begin(states_.unstack(unproject(Eigen::MatrixXd::Identity(columns, columns))));
  while (motion.step() < steps) motion.advance();
  return states_.stack(motion.sensitivity());
}

Eigen::MatrixXd PeriodMap::project(Eigen::MatrixXd columns) const {
  Eigen::MatrixXd q = columns.topRows(n_);
  pull_back(rotations_, increment_, q);
  columns.topRows(n_) = q;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(basis_.cols() * n_, columns.cols());
  for (Eigen::Index k = 0; k < basis_.cols(); ++k) {
    for (Eigen::Index i = 0; i < 4; ++i) {
      result.middleRows(k * n_, n_) += basis_(i, k) * columns.middleRows(i * n_, n_);
    }
  }
  return result;
}

Eigen::MatrixXd PeriodMap::combine(const Eigen::MatrixXd& reduced) const {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(4 * n_, reduced.cols());
  for (Eigen::Index k = 0; k < basis_.cols(); ++k) {
    for (Eigen::Index i = 0; i < 4; ++i) {
      columns.middleRows(i * n_, n_) += basis_(i, k) * reduced.middleRows(k * n_, n_);
    }
  }
  return columns;
}

Eigen::MatrixXd PeriodMap::unproject(const Eigen::MatrixXd& reduced) const {
  Eigen::MatrixXd columns = combine(reduced);
  push_forward_transposed(rotations_, increment_, columns.topRows(n_));
  return columns;
}

Eigen::MatrixXd PeriodMap::solve(const Eigen::MatrixXd& columns) const {
  return columns + map_ * solve_rest(project(columns));
}

Eigen::MatrixXd PeriodMap::solve_transposed(const Eigen::MatrixXd& columns) const {
  // What project() does, transposed.
  const Eigen::MatrixXd scaled = column_scale_.asDiagonal() * (map_.transpose() * columns);
  Eigen::MatrixXd back = combine(row_scale_.asDiagonal() * rest_->solve_transposed(scaled));
  pull_back_transposed(rotations_, increment_, back.topRows(n_));
  return columns + back;
}

double PeriodMap::growth() const {
  return reduced_.size() == 0 ? 0.0 : eigenvalues_of(reduced_).cwiseAbs().maxCoeff();
}

Eigen::Index PeriodMap::freest_coordinate() const {
  Eigen::MatrixXd z = Eigen::VectorXd::Ones(reduced_.rows());
  for (int i = 0; i < 3; ++i) {  // inverse iteration
    z = solve_rest(z);
    z /= z.norm();
  }
  Eigen::Index freest = 0;
  (map_ * z).topRows(n_).col(0).cwiseAbs().maxCoeff(&freest);
  return freest;
}

}  // namespace pleuel
