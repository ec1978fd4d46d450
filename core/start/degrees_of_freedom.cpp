#include "core/start/degrees_of_freedom.hpp"

#include <cmath>
#include <map>
#include <vector>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/sparse_rows.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/start/assembly.hpp"

namespace pleuel {

namespace {

/// Of rows of length one.
constexpr double independent = 1e-8;
/// What is less out of line is not meant to block a motion.
constexpr double clearly_independent = 1e-4;
/// Motions of a large part that stand for all.
constexpr Eigen::Index few = 8;
/// Of the mechanism's size, or [rad].
constexpr double meets = 1e-6;

std::vector<int> rigid_coordinates(const Mechanism& mechanism) {
  std::vector<bool> is_elastic(mechanism.system->coordinates(), false);
  for (const int i : mechanism.elastic) is_elastic[i] = true;
  std::vector<int> rigid;
  for (int i = 0; i < mechanism.system->coordinates(); ++i) {
    if (!is_elastic[i]) rigid.push_back(i);
  }
  return rigid;
}

/// Φ_q with respect to rigid coordinates over their scale.
SparseRows rigid_jacobian(const Mechanism& mechanism, const State& state,
                          const std::vector<int>& rigid) {
  const System& system = *mechanism.system;
  System::Matrix matrix = system.make_matrix();
  projection_matrix(mechanism, state, matrix);
  std::vector<bool> is_left_out(system.multipliers(), false);
  for (const int row : system.left_out()) is_left_out[row] = true;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < rigid.size(); ++j) {
    for (System::Matrix::InnerIterator entry(matrix, rigid[j]); entry; ++entry) {
      const auto row = static_cast<int>(entry.row()) - system.coordinates();
      if (row < 0 || is_left_out[row]) continue;
      entries.emplace_back(row, j, mechanism.scale(rigid[j]) * entry.value());
    }
  }
  SparseRows jacobian(system.multipliers(), rigid.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return jacobian;
}

bool is_closed(const Mechanism& mechanism, const State& state) {
  Eigen::VectorXd residual;
  mechanism.system->residual(state, ConstraintLevel::position, residual);
  Eigen::VectorXd open = residual.tail(mechanism.system->multipliers());
  for (const int row : mechanism.system->left_out()) open(row) = 0.0;
  return open.lpNorm<Eigen::Infinity>() <= meets * mechanism.scale.maxCoeff();
}

/// Closes the constraints by rigid motion. @returns whether that succeeds
bool close(const Mechanism& mechanism, const std::vector<int>& rigid, State& state) {
  constexpr int most_iterations = 20;
  constexpr double closed = 1e-9;
  const int m = mechanism.system->multipliers();
  Eigen::VectorXd residual;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    mechanism.system->residual(state, ConstraintLevel::position, residual);
    Eigen::VectorXd open = residual.tail(m);
    for (const int row : mechanism.system->left_out()) open(row) = 0.0;
    if (open.lpNorm<Eigen::Infinity>() <= closed) return true;
    const Eigen::VectorXd step = least_norm_solution(rigid_jacobian(mechanism, state, rigid), open);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(state.q.size());
    for (std::size_t j = 0; j < rigid.size(); ++j) {
      change(rigid[j]) = -mechanism.scale(rigid[j]) * step(j);
    }
    const Eigen::VectorXd before = state.q;
    advance(mechanism.rotations, before, change, state.q);
    if (!state.q.allFinite()) return false;
  }
  return false;
}

}  // namespace

DegreesOfFreedom rigid_degrees_of_freedom(const Mechanism& mechanism, const State& state) {
  const std::vector<int> rigid = rigid_coordinates(mechanism);
  DegreesOfFreedom freedoms;
  freedoms.coordinates = int_size(rigid);
  if (rigid.empty() || mechanism.system->multipliers() == 0) return freedoms;
  freedoms.constraints =
      static_cast<int>(rank_of_rows(rigid_jacobian(mechanism, state, rigid), independent));
  return freedoms;
}

int blocked_drives(const Mechanism& mechanism, const State& state, const std::vector<int>& drives) {
  if (drives.empty()) return 0;
  const std::vector<int> rigid = rigid_coordinates(mechanism);
  const State& placed = is_closed(mechanism, mechanism.guess) ? mechanism.guess : state;
  SparseRows all = rigid_jacobian(mechanism, placed, rigid);
  SparseRows joints = all;
  for (const int row : drives) joints.row(row) *= 0.0;
  joints.prune(0.0);
  const Eigen::Index added = rank_of_rows(std::move(all), clearly_independent) -
                             rank_of_rows(std::move(joints), clearly_independent);
  return int_size(drives) - static_cast<int>(added);
}

FreeMotions::FreeMotions(const Mechanism& mechanism, const State& state)
    : rigid_(rigid_coordinates(mechanism)),
      jacobian_(mechanism.system->multipliers(), mechanism.system->coordinates()) {
  if (mechanism.system->multipliers() == 0) return;
  const SparseRows rows = rigid_jacobian(mechanism, state, rigid_);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) {
      entries.emplace_back(row, rigid_[entry.col()], entry.value());
    }
  }
  jacobian_.setFromTriplets(entries.begin(), entries.end());
}

/// Those that have entries.
SparseRows FreeMotions::rows_of(const std::vector<int>& coordinates) const {
  std::map<Eigen::Index, Eigen::Index> rows;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(jacobian_, coordinates[j]); entry;
         ++entry) {
      const auto row = rows.try_emplace(entry.row(), std::ssize(rows)).first->second;
      entries.emplace_back(row, j, entry.value());
    }
  }
  SparseRows selected(std::ssize(rows), std::ssize(coordinates));
  selected.setFromTriplets(entries.begin(), entries.end());
  return selected;
}

Eigen::Index FreeMotions::count(const std::vector<int>& coordinates) const {
  return std::ssize(coordinates) - rank_of_rows(rows_of(coordinates), independent);
}

Eigen::MatrixXd FreeMotions::some(const std::vector<int>& coordinates) const {
  const Eigen::MatrixXd basis = null_space_of_rows(rows_of(coordinates), independent, few);
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(jacobian_.cols(), basis.cols());
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    motions.row(coordinates[j]) = basis.row(j);
  }
  return motions;
}

Eigen::MatrixXd free_motions(const Mechanism& mechanism, const State& state) {
  const FreeMotions motions(mechanism, state);
  return motions.some(motions.rigid());
}

State generic_position(const Mechanism& mechanism, const State& state) {
  const std::vector<int> rigid = rigid_coordinates(mechanism);
  const Eigen::MatrixXd motions = free_motions(mechanism, state);
  Eigen::VectorXd way(motions.cols());
  for (Eigen::Index i = 0; i < way.size(); ++i) way(i) = std::sin(1.0 + 2.3 * double(i));
  for (const double distance : {0.1, 0.01}) {
    State moved = state;
    if (way.size() > 0) {
      const Eigen::VectorXd change =
          distance * mechanism.scale.cwiseProduct(motions * way.normalized());
      advance(mechanism.rotations, state.q, change, moved.q);
    }
    if (mechanism.system->multipliers() == 0 || close(mechanism, rigid, moved)) return moved;
  }
  return state;
}

}  // namespace pleuel
