#include "core/integration/equilibrium.hpp"

#include <cassert>

#include <Eigen/SparseLU>
#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/integration/configuration.hpp"

namespace pleuel {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int max_iterations = 30;
/// Newton's method ends at this change of scaled coordinates.
constexpr double tolerance = 1e-13;

/// A block of the Jacobian: some rows and columns of a tangent of the system.
struct Block {
  int from_row, rows, from_col, cols;  ///< in the tangent
  int to_row, to_col;                  ///< in the Jacobian
};

void add_block(const System::Matrix& matrix, const Block& block, Triplets& entries) {
  for (int col = block.from_col; col < block.from_col + block.cols; ++col) {
    for (System::Matrix::InnerIterator it(matrix, col); it; ++it) {
      const int row = static_cast<int>(it.row()) - block.from_row;
      if (row < 0 || row >= block.rows) continue;
      entries.emplace_back(block.to_row + row, block.to_col + col - block.from_col, it.value());
    }
  }
}

/// Multipliers μ of an assembly in place of λ: R then holds Φ_qᵀ μ.
State with_multipliers(State state, const Eigen::VectorXd& multipliers) {
  state.v.setZero();
  state.a.setZero();
  state.lambda = multipliers;
  return state;
}

}  // namespace

Equilibrium::Equilibrium(Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      n_(system_.coordinates()),
      m_(system_.multipliers()) {}

// Rows: motion n, Φ̈ m, position n (a_e = 0 for elastic coordinates), Φ m, velocity n, Φ̇ m. Rows of
// constraints that are left out say λ_i = μ_i = ν_i = 0.
// Columns: q n, v n, a n, λ m, μ m, ν m.

Eigen::VectorXd Equilibrium::residual(const InitialState& at) const {
  const State& state = at.state;
  const Eigen::VectorXd& weight = mechanism_.assembly_weight;
  Eigen::VectorXd all(3 * n_ + 3 * m_), part, with, without;
  system_.residual(state, ConstraintLevel::acceleration, part);
  all.head(n_ + m_) = part;
  const auto forces = [&](const Eigen::VectorXd& multipliers) -> Eigen::VectorXd {
    State moved = with_multipliers(state, multipliers);
    system_.residual(moved, ConstraintLevel::position, with);
    moved.lambda.setZero();
    system_.residual(moved, ConstraintLevel::position, without);
    return (with - without).head(n_);
  };
  const Eigen::VectorXd d = difference(mechanism_.rotations, state.q, mechanism_.guess.q);
  Eigen::VectorXd position = weight.cwiseProduct(d) + forces(at.position_multipliers);
  for (int i : mechanism_.elastic) position(i) = state.a(i);
  all.segment(n_ + m_, n_) = position;
  system_.residual(state, ConstraintLevel::position, part);
  all.segment(2 * n_ + m_, m_) = part.tail(m_);
  all.segment(2 * n_ + 2 * m_, n_) =
      weight.cwiseProduct(state.v - mechanism_.guess.v) + forces(at.velocity_multipliers);
  system_.residual(state, ConstraintLevel::velocity, part);
  all.tail(m_) = part.tail(m_);
  for (int i : system_.left_out()) {
    all(2 * n_ + m_ + i) = at.position_multipliers(i);
    all(3 * n_ + 2 * m_ + i) = at.velocity_multipliers(i);
  }
  return all;
}

Eigen::SparseMatrix<double> Equilibrium::jacobian(const InitialState& at) const {
  const State& state = at.state;
  const int n = n_, m = m_, lambda = 3 * n, mu = lambda + m, nu = mu + m;
  const int position = n + m, velocity = 2 * n + 2 * m;
  Triplets entries;
  System::Matrix matrix = system_.make_matrix(), without = system_.make_matrix();
  const auto add = [&](const Weights& weights, ConstraintLevel level, const Block& block) {
    system_.tangent(state, weights, level, matrix);
    add_block(matrix, block, entries);
  };
  const auto acceleration = ConstraintLevel::acceleration;
  add({.q = 1.0}, acceleration, {0, n + m, 0, n, 0, 0});
  add({.v = 1.0}, acceleration, {0, n + m, 0, n, 0, n});
  add({.a = 1.0}, acceleration, {0, n + m, 0, n, 0, 2 * n});
  add({.a = 1.0}, acceleration, {0, n, n, m, 0, lambda});
  add({.q = 1.0}, ConstraintLevel::position, {n, m, 0, n, position + n, 0});
  add({.q = 1.0}, ConstraintLevel::velocity, {n, m, 0, n, velocity + n, 0});
  add({.q = 1.0}, ConstraintLevel::position, {n, m, 0, n, velocity + n, n});  // Φ̇_v = Φ_q

  // Φ_qᵀ μ, Φ_qᵀ ν and their derivatives
  const auto add_forces = [&](const Eigen::VectorXd& multipliers, int row, int column) {
    State moved = with_multipliers(state, multipliers);
    system_.tangent(moved, {.q = 1.0}, ConstraintLevel::position, matrix);
    moved.lambda.setZero();
    system_.tangent(moved, {.q = 1.0}, ConstraintLevel::position, without);
    add_block(matrix, {0, n, n, m, row, column}, entries);
    matrix -= without;
    add_block(matrix, {0, n, 0, n, row, 0}, entries);
  };
  add_forces(at.position_multipliers, position, mu);
  add_forces(at.velocity_multipliers, velocity, nu);
  for (int i : system_.left_out()) {
    entries.emplace_back(n + i, lambda + i, 1.0);
    entries.emplace_back(position + n + i, mu + i, 1.0);
    entries.emplace_back(velocity + n + i, nu + i, 1.0);
  }
  const Eigen::VectorXd& weight = mechanism_.assembly_weight;
  for (int i = 0; i < n; ++i) entries.emplace_back(velocity + i, n + i, weight(i));

  // W δ(q ⊖ q̂)
  const Eigen::VectorXd d = difference(mechanism_.rotations, state.q, mechanism_.guess.q);
  std::vector<bool> is_plain(static_cast<std::size_t>(n), true);
  for (int i : mechanism_.rotations) {
    const Eigen::Matrix3d pull = inverse_tangent_operator(d.segment<3>(i));
    for (int row = 0; row < 3; ++row) {
      is_plain[static_cast<std::size_t>(i + row)] = false;
      for (int col = 0; col < 3; ++col) {
        entries.emplace_back(position + i + row, i + col, weight(i + row) * pull(row, col));
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    if (is_plain[static_cast<std::size_t>(i)]) entries.emplace_back(position + i, i, weight(i));
  }

  // Elastic rows say a_e = 0 instead.
  std::vector<bool> is_elastic(static_cast<std::size_t>(n), false);
  for (int i : mechanism_.elastic) is_elastic[static_cast<std::size_t>(i)] = true;
  std::erase_if(entries, [&](const auto& entry) {
    const int row = entry.row() - position;
    return row >= 0 && row < n && is_elastic[static_cast<std::size_t>(row)];
  });
  for (int i : mechanism_.elastic) entries.emplace_back(position + i, 2 * n + i, 1.0);

  Eigen::SparseMatrix<double> result(3 * n + 3 * m, 3 * n + 3 * m);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::MatrixXd Equilibrium::design_derivative(const InitialState& at) const {
  const State& state = at.state;
  const int n = n_, m = m_, position = n + m, velocity = 2 * n + 2 * m;
  Eigen::MatrixXd all(3 * n + 3 * m, system_.variables()), part, without;
  system_.design_derivative(state, ConstraintLevel::acceleration, part);
  all.topRows(n + m) = part;
  system_.design_derivative(state, ConstraintLevel::position, part);
  all.middleRows(position + n, m) = part.bottomRows(m);
  system_.design_derivative(state, ConstraintLevel::velocity, part);
  all.bottomRows(m) = part.bottomRows(m);
  const auto forces = [&](const Eigen::VectorXd& multipliers) -> Eigen::MatrixXd {
    State moved = with_multipliers(state, multipliers);
    system_.design_derivative(moved, ConstraintLevel::position, part);
    moved.lambda.setZero();
    system_.design_derivative(moved, ConstraintLevel::position, without);
    return (part - without).topRows(n);
  };
  const Eigen::VectorXd d = difference(mechanism_.rotations, state.q, mechanism_.guess.q);
  Eigen::MatrixXd guess_x = mechanism_.guess_q_x;
  pull_back(mechanism_.rotations, d, guess_x);
  const auto weight = mechanism_.assembly_weight.asDiagonal();
  all.middleRows(position, n) = forces(at.position_multipliers) - weight * guess_x;
  for (int i : mechanism_.elastic) all.row(position + i).setZero();
  all.middleRows(velocity, n) = forces(at.velocity_multipliers) - weight * mechanism_.guess_v_x;
  return all;
}

void Equilibrium::advance_by(const Eigen::VectorXd& step, InitialState& at) const {
  State& state = at.state;
  const Eigen::VectorXd before = state.q;
  advance(mechanism_.rotations, before, step.head(n_), state.q);
  state.v += step.segment(n_, n_);
  state.a += step.segment(2 * n_, n_);
  state.lambda += step.segment(3 * n_, m_);
  at.position_multipliers += step.segment(3 * n_ + m_, m_);
  at.velocity_multipliers += step.tail(m_);
}

InitialState Equilibrium::solve(InitialState start) {
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors;
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Eigen::SparseMatrix<double> matrix = jacobian(start);
    if (iteration == 0) factors.analyzePattern(matrix);
    factors.factorize(matrix);
    if (factors.info() != Eigen::Success) break;
    const Eigen::VectorXd step = -factors.solve(residual(start));
    if (!step.allFinite()) break;
    advance_by(step, start);
    const double size = step.head(n_).cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>();
    if (size < tolerance || (size < 1e-9 && size > 0.3 * previous)) return start;
    previous = size;
  }
  throw SimulationError(
      "no elastic equilibrium was found to start from (/simulation/initial_state is "
      "\"quasi-static\"): a member may buckle under the loads at t = 0");
}

Equilibrium::Derivatives Equilibrium::differentiate(const InitialState& solution) {
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(jacobian(solution));
  if (factors.info() != Eigen::Success) {
    throw SimulationError("the derivatives of the elastic equilibrium are singular");
  }
  const Eigen::MatrixXd z = -factors.solve(design_derivative(solution));
  return {z.topRows(n_), z.middleRows(n_, n_), z.middleRows(2 * n_, n_), z.middleRows(3 * n_, m_)};
}

}  // namespace pleuel
