#include "core/start/degrees_of_freedom.hpp"

#include <algorithm>
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

/// The scale of rigid coordinates, zero of elastic ones.
Eigen::VectorXd rigid_scale(const Mechanism& mechanism) {
  Eigen::VectorXd scale = mechanism.scale;
  for (const int i : mechanism.elastic) scale(i) = 0.0;
  return scale;
}

/// Φ_q with respect to rigid coordinates over their scale.
SparseRows rigid_jacobian(const Mechanism& mechanism, const State& state) {
  SparseRows rows = scaled_constraints(mechanism, state, rigid_scale(mechanism));
  for (const int row : mechanism.system->left_out()) rows.row(row) *= 0.0;
  return rows;
}

std::vector<int> kept_rows(const System& system) {
  std::vector<int> kept;
  for (int row = 0; row < system.multipliers(); ++row) {
    if (std::ranges::find(system.left_out(), row) == system.left_out().end()) kept.push_back(row);
  }
  return kept;
}

bool is_closed(const Mechanism& mechanism, const State& state) {
  Eigen::VectorXd residual;
  mechanism.system->residual(state, ConstraintLevel::position, residual);
  Eigen::VectorXd open = residual.tail(mechanism.system->multipliers());
  for (const int row : mechanism.system->left_out()) open(row) = 0.0;
  return open.lpNorm<Eigen::Infinity>() <= meets * mechanism.scale.maxCoeff();
}

}  // namespace

DegreesOfFreedom rigid_degrees_of_freedom(const Mechanism& mechanism, const State& state) {
  DegreesOfFreedom freedoms;
  freedoms.coordinates = int_size(rigid_coordinates(mechanism));
  if (freedoms.coordinates == 0 || mechanism.system->multipliers() == 0) return freedoms;
  freedoms.constraints =
      static_cast<int>(rank_of_rows(rigid_jacobian(mechanism, state), independent));
  return freedoms;
}

int blocked_drives(const Mechanism& mechanism, const State& state, const std::vector<int>& drives) {
  if (drives.empty()) return 0;
  const State& placed = is_closed(mechanism, mechanism.guess) ? mechanism.guess : state;
  const SparseRows rows = rigid_jacobian(mechanism, placed);
  return int_size(drives) - static_cast<int>(rank_added_by(drives, rows, clearly_independent));
}

FreeMotions::FreeMotions(const Mechanism& mechanism, const State& state)
    : rigid_(rigid_coordinates(mechanism)), jacobian_(rigid_jacobian(mechanism, state)) {}

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
  constexpr double closed = 1e-9;
  const Eigen::VectorXd scale = rigid_scale(mechanism);
  const std::vector<int> rows = kept_rows(*mechanism.system);
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
    if (close_constraints(mechanism, scale, rows, closed, moved)) return moved;
  }
  return state;
}

}  // namespace pleuel
