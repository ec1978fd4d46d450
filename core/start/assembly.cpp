#include "core/start/assembly.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

namespace {

constexpr int max_assembly_steps = 50;

/// Names of the two terms whose constraints pull hardest in an assembly: they fight each other.
std::string hardest_joints(Mechanism& mechanism, const Eigen::VectorXd& multipliers) {
  const int n = mechanism.system->coordinates();
  std::vector<std::pair<double, std::string>> pulls;
  for (const auto& term : mechanism.system->terms()) {
    EntryList entries;
    term->declare_entries(entries);
    double largest = 0.0;
    for (const auto& [row, col] : entries) {
      if (row >= n) largest = std::max(largest, std::abs(multipliers(row - n)));
    }
    pulls.emplace_back(largest, term->name());
  }
  std::ranges::stable_sort(pulls, [](const auto& a, const auto& b) { return a.first > b.first; });
  if (pulls.size() < 2) return pulls.front().second + " pulls";
  return pulls[0].second + " and " + pulls[1].second + " pull";
}

/// Assembly moves bodies; if it must deform them by more than a hundredth, the joints do not fit.
void check_strain(Mechanism& mechanism, const Eigen::VectorXd& q,
                  const Eigen::VectorXd& multipliers) {
  // The scale of elastic coordinates is a thousandth of the mechanism's size.
  const double moved =
      (q - mechanism.guess.q).cwiseQuotient(mechanism.scale).lpNorm<Eigen::Infinity>();
  if (moved <= 10.0) return;
  throw SimulationError(fmt::format(
      "the mechanism cannot be assembled without straining its bodies: {} hardest; check the "
      "points of the joints, the start of the drives and the lengths of the bodies",
      hardest_joints(mechanism, multipliers)));
}

/// Names of the terms whose constraints are not met, worst first, with their violations.
std::string open_joints(Mechanism& mechanism, const State& at) {
  System& system = *mechanism.system;
  struct Open {
    double violation;
    std::string name;
  };
  std::vector<Open> open;
  for (const auto& term : system.terms()) {
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(system.size());
    term->add_residual(at, ConstraintLevel::position, residual);
    const double violation = system.multipliers() > 0
                                 ? residual.tail(system.multipliers()).lpNorm<Eigen::Infinity>()
                                 : 0.0;
    if (!(violation <= 1e-8)) open.push_back({violation, term->name()});
  }
  std::ranges::sort(open, [](const Open& a, const Open& b) { return a.violation > b.violation; });
  if (open.empty()) return "its joints";
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(open.size(), 4); ++i) {
    text += fmt::format("{}{} (off by {:.2g})", i > 0 ? ", " : "", open[i].name, open[i].violation);
  }
  return open.size() > 4 ? text + ", …" : text;
}

void assemble_positions(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix,
                        InitialState& initial) {
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  Eigen::VectorXd residual;
  State at = initial.state;
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_assembly_steps; ++iteration) {
    system.residual(at, ConstraintLevel::position, residual);
    const double violation = m > 0 ? residual.tail(m).lpNorm<Eigen::Infinity>() : 0.0;
    assembly_matrix(mechanism, at, matrix);
    factorize_for_start(solver, matrix, "positions");
    Eigen::VectorXd step(n + m);
    step.head(n) =
        -assembly_forces(mechanism, difference(mechanism.rotations, at.q, mechanism.guess.q));
    step.tail(m) = -residual.tail(m);
    solver.solve(step);
    const Eigen::VectorXd before = at.q;
    advance(mechanism.rotations, before, step.head(n), at.q);
    if (!at.q.allFinite()) break;
    const double correction = step.head(n).cwiseQuotient(mechanism.scale).lpNorm<Eigen::Infinity>();
    // The projection converges linearly where the guess is loose: on, down to round-off.
    const bool is_at_rest = correction < 1e-15 || correction > 0.3 * previous;
    previous = correction;
    if (violation < 1e-10 && correction < 1e-10 && is_at_rest) {
      check_strain(mechanism, at.q, step.tail(m));
      initial.state.q = at.q;
      initial.position_multipliers = step.tail(m);
      return;
    }
  }
  throw SimulationError(fmt::format(
      "the mechanism cannot be assembled: {} cannot be closed near the given positions; check the "
      "points of the joints and the lengths of the bodies",
      open_joints(mechanism, at)));
}

void project_velocities(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix,
                        InitialState& initial) {
  State& state = initial.state;
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  Eigen::VectorXd residual;
  system.residual(state, ConstraintLevel::velocity, residual);
  assembly_matrix(mechanism, state, matrix);
  factorize_for_start(solver, matrix, "velocities");
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n + m);
  step.tail(m) = -residual.tail(m);
  solver.solve(step);
  state.v += step.head(n);
  initial.velocity_multipliers = step.tail(m);
}

}  // namespace

void factorize_for_start(LinearSolver& solver, const System::Matrix& matrix, const char* what) {
  if (solver.factorize(matrix)) return;
  throw SimulationError(fmt::format(
      "the mechanism cannot be started: the equations of its initial {} are singular. Perhaps it "
      "stands at a dead centre (members in line, which a drive cannot move, or which may go two "
      "ways: begin beside it), joints constrain the same motion twice, or nothing holds a body "
      "that has no inertia",
      what));
}

Eigen::MatrixXd assembly_forces(const Mechanism& mechanism, const Eigen::MatrixXd& changes) {
  Eigen::MatrixXd forces = mechanism.assembly_weight.asDiagonal() * changes;
  for (const BentStart& bent : mechanism.bent_starts) {
    const Eigen::Index size = bent.weight.cols();
    forces.middleRows(bent.offset, size) = bent.weight * changes.middleRows(bent.offset, size);
  }
  return forces;
}

void projection_matrix(const Mechanism& mechanism, const State& state, System::Matrix& matrix) {
  const int n = mechanism.system->coordinates();
  mechanism.system->tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
  clear_dynamic_block(n, matrix);
  for (int i = 0; i < n; ++i) matrix.coeffRef(i, i) = mechanism.assembly_weight(i);
}

void assembly_matrix(const Mechanism& mechanism, const State& state, System::Matrix& matrix) {
  projection_matrix(mechanism, state, matrix);
  for (const BentStart& bent : mechanism.bent_starts) {
    for (int col = 0; col < bent.weight.outerSize(); ++col) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(bent.weight, col); entry; ++entry) {
        matrix.coeffRef(bent.offset + entry.row(), bent.offset + col) = entry.value();
      }
    }
  }
}

SparseRows scaled_constraints(const Mechanism& mechanism, const State& state,
                              const Eigen::VectorXd& scale) {
  System& system = *mechanism.system;
  const int n = system.coordinates();
  System::Matrix matrix = system.make_matrix();
  system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < n; ++column) {
    if (scale(column) == 0.0) continue;
    for (System::Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
      if (entry.row() < n) continue;
      entries.emplace_back(entry.row() - n, column, scale(column) * entry.value());
    }
  }
  SparseRows rows(system.multipliers(), n);
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

bool close_constraints(const Mechanism& mechanism, const Eigen::VectorXd& scale,
                       const std::vector<int>& rows, double tolerance, State& state) {
  constexpr int most_iterations = 20;
  Eigen::VectorXd residual;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    mechanism.system->residual(state, ConstraintLevel::position, residual);
    const Eigen::VectorXd all = residual.tail(mechanism.system->multipliers()), open = all(rows);
    if (open.size() == 0 || open.lpNorm<Eigen::Infinity>() <= tolerance) return true;
    const SparseRows kept = select_rows(scaled_constraints(mechanism, state, scale), rows);
    const Eigen::VectorXd step = least_norm_solution(kept, open), before = state.q;
    advance(mechanism.rotations, before, -scale.cwiseProduct(step), state.q);
    if (!state.q.allFinite()) return false;
  }
  return false;
}

InitialState assemble(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix) {
  InitialState initial;
  initial.state = mechanism.guess;
  initial.state.a.setZero();
  initial.state.lambda.setZero();
  assemble_positions(mechanism, solver, matrix, initial);
  project_velocities(mechanism, solver, matrix, initial);
  return initial;
}

}  // namespace pleuel
