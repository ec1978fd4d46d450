#include "core/mobility/rigid_constraints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

namespace {

/// Of Φ: what counts as closed.
constexpr double closed = 1e-9;
constexpr int most_iterations = 60;
/// Of z, in one step of the iteration.
constexpr double longest_move = 0.5;
/// In the least gap joints are apart in their points, as far as that can be.
constexpr double weight_of_angles = 10.0, weight_of_drives = 100.0;
constexpr double least_damping = 1e-14, most_damping = 1e4;

/// The size of the smaller body of a joint; the ground has none.
double length_of(const JointModel& joint, const Mechanism& mechanism) {
  double length = std::numeric_limits<double>::infinity();
  for (const Marker& marker : joint.topology.markers) {
    if (marker.frame.translations() == 0) continue;
    length = std::min(length, mechanism.scale(marker.frame.offset));
  }
  return std::isfinite(length) ? length : 1.0;
}

/// [ I  Jᵀ ; J  −μ I ]
LinearSolver::Matrix damped_matrix(const SparseRows& jacobian, double damping) {
  const auto n = static_cast<int>(jacobian.cols()), m = static_cast<int>(jacobian.rows());
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(n + m + 2 * jacobian.nonZeros());
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (int row = 0; row < m; ++row) {
    for (SparseRows::InnerIterator entry(jacobian, row); entry; ++entry) {
      const auto column = static_cast<int>(entry.col());
      entries.emplace_back(n + row, column, entry.value());
      entries.emplace_back(column, n + row, entry.value());
    }
    entries.emplace_back(n + row, n + row, -damping);
  }
  LinearSolver::Matrix matrix(n + m, n + m);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

RigidConstraints::RigidConstraints(const Model& model) : mechanism_(model.mechanism) {
  const System& system = *mechanism_.system;
  const int n = system.coordinates();
  column_of_.assign(n, 0);
  for (const int i : mechanism_.elastic) column_of_[i] = -1;
  for (int i = 0; i < n; ++i) {
    if (column_of_[i] < 0) continue;
    column_of_[i] = int_size(coordinates_);
    coordinates_.push_back(i);
  }
  row_of_.assign(system.multipliers(), 0);
  for (const int row : system.left_out()) row_of_[row] = -1;
  std::vector<double> scales, lengths;
  for (int number = 0; const JointModel& joint : model.joints) {
    const double length = length_of(joint, mechanism_);
    for (int i = 0; i < joint.equations(); ++i) {
      const int multiplier = joint.first_multiplier + i;
      if (row_of_[multiplier] < 0) continue;
      row_of_[multiplier] = int_size(multipliers_);
      multipliers_.push_back(multiplier);
      is_drive_.push_back(multiplier == joint.drive_row);
      is_angle_.push_back(traits_of(joint.topology.equations[i].kind).is_moment);
      joint_.push_back(number);
      scales.push_back(is_angle_.back() ? 1.0 : length);
      lengths.push_back(length);
    }
    ++number;
  }
  row_scale_ = Eigen::Map<const Eigen::VectorXd>(scales.data(), int_size(scales));
  length_ = Eigen::Map<const Eigen::VectorXd>(lengths.data(), int_size(lengths));
  for (Term* term : model.terms.joints) {
    EntryList entries;
    term->declare_entries(entries);
    parts_.push_back({term, std::move(entries)});
  }
}

Eigen::VectorXd RigidConstraints::values(const Eigen::VectorXd& q, double time) const {
  const System& system = *mechanism_.system;
  State state(system.coordinates(), system.multipliers());
  state.time = time;
  state.q = q;
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(system.size());
  for (const Part& part : parts_) {
    part.term->add_residual(state, ConstraintLevel::position, residual);
  }
  Eigen::VectorXd values(rows());
  for (int row = 0; row < rows(); ++row) {
    values(row) = residual(system.coordinates() + multipliers_[row]) / row_scale_(row);
  }
  return values;
}

void RigidConstraints::linearize(const Eigen::VectorXd& q, double time, Eigen::VectorXd& values,
                                 SparseRows& jacobian) const {
  const System& system = *mechanism_.system;
  const int n = system.coordinates();
  State state(n, system.multipliers());
  state.time = time;
  state.q = q;
  const Weights weights{.q = 1.0};
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(system.size());
  std::vector<Eigen::Triplet<double>> triplets;
  std::vector<double> written;
  for (const Part& part : parts_) {
    written.assign(part.entries.size(), 0.0);
    part.term->linearize(state, {&weights, 1}, ConstraintLevel::position, residual,
                         {written.data(), 0});
    for (std::size_t k = 0; k < written.size(); ++k) {
      const auto& [entry_row, entry_column] = part.entries[k];
      if (entry_row < n || entry_column >= n) continue;
      const int row = row_of_[entry_row - n], column = column_of_[entry_column];
      if (row < 0 || column < 0) continue;
      triplets.emplace_back(row, column,
                            written[k] * mechanism_.scale(entry_column) / row_scale_(row));
    }
  }
  values.resize(rows());
  for (int row = 0; row < rows(); ++row) {
    values(row) = residual(n + multipliers_[row]) / row_scale_(row);
  }
  jacobian.resize(rows(), coordinates());
  jacobian.setFromTriplets(triplets.begin(), triplets.end());
}

Eigen::VectorXd RigidConstraints::expand(const Eigen::VectorXd& change) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(mechanism_.system->coordinates());
  for (int i = 0; i < coordinates(); ++i) {
    all(coordinates_[i]) = mechanism_.scale(coordinates_[i]) * change(i);
  }
  return all;
}

Eigen::VectorXd RigidConstraints::advance(const Eigen::VectorXd& q,
                                          const Eigen::VectorXd& change) const {
  Eigen::VectorXd to = q;
  pleuel::advance(mechanism_.rotations, q, expand(change), to);
  return to;
}

Eigen::VectorXd RigidConstraints::difference(const Eigen::VectorXd& to,
                                             const Eigen::VectorXd& from) const {
  const Eigen::VectorXd all = pleuel::difference(mechanism_.rotations, to, from);
  Eigen::VectorXd change(coordinates());
  for (int i = 0; i < coordinates(); ++i) {
    change(i) = all(coordinates_[i]) / mechanism_.scale(coordinates_[i]);
  }
  return change;
}

RigidConstraints::Gap RigidConstraints::gap(const Eigen::VectorXd& values) const {
  std::map<int, std::pair<double, double>> squares;  // of each joint, and its length
  for (int row = 0; row < rows(); ++row) {
    auto& [square, length] = squares[joint_[row]];
    square += values(row) * values(row);
    length = length_(row);
  }
  Gap gap;
  for (const auto& [joint, apart] : squares) {
    gap.share += std::sqrt(apart.first);
    gap.distance += std::sqrt(apart.first) * apart.second;
  }
  return gap;
}

Eigen::VectorXd RigidConstraints::weight_of_gaps() const {
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(rows());
  for (int row = 0; row < rows(); ++row) {
    if (is_angle_[row]) weight(row) = weight_of_angles;
    if (is_drive_[row]) weight(row) = weight_of_drives;
  }
  return weight;
}

/// d of least |J d + Φ|² + μ |d|², from [ I  Jᵀ ; J  −μ I ] (d, y) = (0, −Φ).
bool RigidConstraints::solve_damped(const SparseRows& jacobian, const Eigen::VectorXd& values,
                                    double damping, Eigen::VectorXd& step) {
  const LinearSolver::Matrix matrix = damped_matrix(jacobian, damping);
  if (!solver_) solver_.emplace(matrix);
  if (!solver_->factorize(matrix)) return false;
  Eigen::VectorXd answer = Eigen::VectorXd::Zero(matrix.rows());
  answer.tail(rows()) = -values;
  solver_->solve(answer);
  step = answer.head(coordinates());
  return step.allFinite();
}

RigidConstraints::Closure RigidConstraints::close(const Eigen::VectorXd& q, double time) {
  return close(q, time, Eigen::VectorXd::Ones(rows()));
}

RigidConstraints::Closure RigidConstraints::close(const Eigen::VectorXd& q, double time,
                                                  const Eigen::VectorXd& weight) {
  Closure closure{q, Eigen::VectorXd::Zero(coordinates()), rows() == 0};
  if (rows() == 0 || coordinates() == 0) return closure;
  Eigen::VectorXd values, step;
  SparseRows jacobian;
  double damping = least_damping;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    ++iterations_;
    linearize(closure.q, time, values, jacobian);
    closure.is_closed = values.lpNorm<Eigen::Infinity>() <= closed;
    if (closure.is_closed) return closure;
    values = weight.cwiseProduct(values);
    for (int row = 0; row < rows(); ++row) jacobian.row(row) *= weight(row);
    const double before = values.squaredNorm();
    for (bool is_better = false; !is_better;) {
      if (solve_damped(jacobian, values, damping, step)) {
        const double length = step.lpNorm<Eigen::Infinity>();
        if (length > longest_move) step *= longest_move / length;
        const Eigen::VectorXd next = advance(closure.q, step);
        const double after = weight.cwiseProduct(this->values(next, time)).squaredNorm();
        is_better = after < before;
        if (is_better) {
          if (iteration == 0) closure.first = step;
          closure.q = next;
          damping = std::max(least_damping, 0.1 * damping);
          if (after > 0.999999 * before) return closure;
          continue;
        }
      }
      if (damping >= most_damping) return closure;
      damping = std::max(1e-8, 10.0 * damping);
    }
  }
  return closure;
}

}  // namespace pleuel
