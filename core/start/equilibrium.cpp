#include "core/start/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/free_deformations.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int max_newton_steps = 25;
/// Newton's method ends at this change of scaled coordinates.
constexpr double newton_tolerance = 1e-13;
/// Or where it gets no further, at this share of the largest deformation.
constexpr double stuck_share = 1e-9;
/// Or where it gets no further and each equation is met to this share of its terms. Stiff elements
/// leave such changes of the coordinates as round-off makes of it, some n⁴ of it for n elements.
constexpr double balance_round_off = 1e-12;
/// Or where it has not come nearer so many times, at this share of the largest deformation: elements
/// that are much shorter than others leave more round-off than an even mesh does.
constexpr int most_stuck_steps = 3;
constexpr double long_stuck_share = 1e-6;
/// Where the whole load is too much for Newton's method it comes in parts, down to this one.
constexpr double smallest_part = 1.0 / 1024;
/// Where members turn far there are other equilibria, to which loads that grow slowly do not lead.
constexpr double slow_part = 1.0 / 32;
/// That is half of a length, or of a radian; the scale of elastic coordinates is a thousandth.
constexpr double far_deformed = 500.0;  ///< of the scale
/// The share of the loads from which their effect on the stiffness is taken.
constexpr double small_load = 1e-3;
/// Rows of Φ_q of the frames that depend on the others by less than this are closed by deformation.
constexpr double frame_rank_tolerance = 1e-9;

/// A block of the Jacobian: some rows and columns of a tangent of the system.
struct PlacedBlock {
  int from_row, rows, from_col, cols;  ///< in the tangent
  int to_row, to_col;                  ///< in the Jacobian
};

/// @param keeps  of a row and a column of the block, whether the entry there belongs to it
template <class Keeps>
void add_block(const System::Matrix& matrix, const PlacedBlock& block, const Keeps& keeps,
               Triplets& entries) {
  for (int col = block.from_col; col < block.from_col + block.cols; ++col) {
    for (System::Matrix::InnerIterator it(matrix, col); it; ++it) {
      const int row = static_cast<int>(it.row()) - block.from_row;
      if (row < 0 || row >= block.rows || !keeps(row, col - block.from_col)) continue;
      entries.emplace_back(block.to_row + row, block.to_col + col - block.from_col, it.value());
    }
  }
}

void add_block(const System::Matrix& matrix, const PlacedBlock& block, Triplets& entries) {
  add_block(
      matrix, block, [](int, int) { return true; }, entries);
}

/// Constraints that the frames alone cannot meet, as others hold them: combinations y of the rows
/// of Φ_q in which the coordinates of the frames cancel. For each, one of its constraints, that on
/// which the elastic coordinates act most.
/// @returns one for each of them, zero for all others (m)
Eigen::VectorXd closed_by_deformation(Mechanism& mechanism) {
  const System& system = *mechanism.system;
  const int m = system.multipliers();
  Eigen::VectorXd is_closed = Eigen::VectorXd::Zero(m);
  if (m == 0) return is_closed;
  const Eigen::MatrixXd phi(scaled_constraints(mechanism, mechanism.guess, mechanism.scale));
  std::vector<bool> is_left_out(m, false);
  for (int i : system.left_out()) is_left_out[i] = true;
  std::vector<int> rows;
  for (int i = 0; i < m; ++i) {
    if (!is_left_out[i]) rows.push_back(i);
  }
  Eigen::MatrixXd of_frames = phi(rows, Eigen::all);
  const Eigen::VectorXd elastic = of_frames(Eigen::all, mechanism.elastic).rowwise().norm();
  of_frames(Eigen::all, mechanism.elastic).setZero();
  const PivotedQr qr(of_frames, frame_rank_tolerance);
  if (qr.rank() == of_frames.rows()) return is_closed;
  const PivotedQr choice(qr.normal_space().transpose() * elastic.asDiagonal());
  const std::vector<int> order = choice.order();
  for (Eigen::Index i = 0; i < choice.rank(); ++i) {
    is_closed(rows[order[i]]) = 1.0;
  }
  return is_closed;
}

/// The largest |r_i| / Σ_j |J_ij x_j|: how well equations are met against their terms (Oettli &
/// Prager 1964). Equations whose terms are all next to nothing, as those of accelerations that
/// vanish, hold nothing but round-off.
double backward_error(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& unknowns,
                      const Eigen::VectorXd& residual) {
  const Eigen::VectorXd terms = matrix.cwiseAbs() * unknowns.cwiseAbs();
  constexpr double nothing = 1e-18;
  const double least = nothing * terms.maxCoeff();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (residual(i) == 0.0) continue;
    worst = std::max(worst, std::abs(residual(i)) / std::max(terms(i), least));
  }
  return worst;
}

}  // namespace

Equilibrium::Equilibrium(Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      n_(system_.coordinates()),
      m_(system_.multipliers()),
      strains_(system_),
      closed_by_deformation_(closed_by_deformation(mechanism)) {}

// Rows: motion n, Φ̈ m, position n (that of elastic coordinates), Φ m, velocity n, Φ̇ m. Rows of
// constraints that are left out say λ_i = μ_i = ν_i = 0.
// Columns: q n, v n, a n, λ m, μ m, ν m.

Eigen::VectorXd Equilibrium::residual(const InitialState& at) const {
  const State& state = at.state;
  const Eigen::VectorXd& weight = mechanism_.assembly_weight;
  Eigen::VectorXd all(3 * n_ + 3 * m_), part;
  system_.residual(state, ConstraintLevel::acceleration, part);
  all.head(n_ + m_) = part;
  LinearForces constraints(system_);
  const auto forces = [&](const Eigen::VectorXd& multipliers) -> Eigen::VectorXd {
    constraints.set(state, multipliers);
    return constraints.residual().head(n_);
  };
  const Eigen::VectorXd d = difference(mechanism_.rotations, state.q, mechanism_.guess.q);
  Eigen::VectorXd position = weight.cwiseProduct(d) + forces(of_frames(at.position_multipliers));
  const Eigen::VectorXd needed = forces(of_deformation(at.position_multipliers));
  for (int i : mechanism_.elastic) position(i) = state.a(i) + needed(i);
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
  System::Matrix matrix = system_.make_matrix();
  const auto add = [&](const Weights& weights, ConstraintLevel level, const PlacedBlock& block) {
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

  // The derivatives of Φ_qᵀ μ and Φ_qᵀ ν
  LinearForces constraints(system_);
  constraints.set(state, at.velocity_multipliers);
  constraints.tangent(matrix);
  add_block(matrix, {0, n, n, m, velocity, nu}, entries);
  add_block(matrix, {0, n, 0, n, velocity, 0}, entries);
  for (int i : system_.left_out()) {
    entries.emplace_back(n + i, lambda + i, 1.0);
    entries.emplace_back(position + n + i, mu + i, 1.0);
    entries.emplace_back(velocity + n + i, nu + i, 1.0);
  }
  const Eigen::VectorXd& weight = mechanism_.assembly_weight;
  for (int i = 0; i < n; ++i) entries.emplace_back(velocity + i, n + i, weight(i));

  // W δ(q ⊖ q̂) of the frames
  const Eigen::VectorXd d = difference(mechanism_.rotations, state.q, mechanism_.guess.q);
  std::vector<bool> is_plain(n, true), is_elastic(n, false);
  for (int i : mechanism_.elastic) is_elastic[i] = true;
  for (int i : mechanism_.rotations) {
    const Eigen::Matrix3d pull = inverse_tangent_operator(d.segment<3>(i));
    for (int row = 0; row < 3; ++row) {
      is_plain[i + row] = false;
      for (int col = 0; col < 3; ++col) {
        entries.emplace_back(position + i + row, i + col, weight(i + row) * pull(row, col));
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    if (is_plain[i] && !is_elastic[i]) entries.emplace_back(position + i, i, weight(i));
  }

  // Φ_qᵀ μ: in the rows of frames that of the constraints which frames meet, in those of elastic
  // coordinates, which say a_e + Φ_qᵀ μ = 0 instead, that of the others.
  const auto add_forces = [&](const Eigen::VectorXd& multipliers, bool elastic) {
    constraints.set(state, multipliers);
    constraints.tangent(matrix);
    const auto keeps_row = [&](int row, int) { return is_elastic[row] == elastic; };
    const auto keeps_both = [&](int row, int column) {
      return is_elastic[row] == elastic && (closed_by_deformation_(column) == 1.0) == elastic;
    };
    add_block(matrix, {0, n, n, m, position, mu}, keeps_both, entries);
    add_block(matrix, {0, n, 0, n, position, 0}, keeps_row, entries);
  };
  add_forces(of_frames(at.position_multipliers), false);
  add_forces(of_deformation(at.position_multipliers), true);
  for (int i : mechanism_.elastic) entries.emplace_back(position + i, 2 * n + i, 1.0);

  Eigen::SparseMatrix<double> result(3 * n + 3 * m, 3 * n + 3 * m);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::MatrixXd Equilibrium::design_derivative(const InitialState& at) const {
  const State& state = at.state;
  const int n = n_, m = m_, position = n + m, velocity = 2 * n + 2 * m;
  Eigen::MatrixXd all(3 * n + 3 * m, system_.variables()), part;
  system_.design_derivative(state, ConstraintLevel::acceleration, part);
  all.topRows(n + m) = part;
  system_.design_derivative(state, ConstraintLevel::position, part);
  all.middleRows(position + n, m) = part.bottomRows(m);
  system_.design_derivative(state, ConstraintLevel::velocity, part);
  all.bottomRows(m) = part.bottomRows(m);
  LinearForces constraints(system_);
  const auto forces = [&](const Eigen::VectorXd& multipliers) -> Eigen::MatrixXd {
    constraints.set(state, multipliers);
    return constraints.design_derivative().topRows(n);
  };
  const Eigen::VectorXd d = difference(mechanism_.rotations, state.q, mechanism_.guess.q);
  Eigen::MatrixXd guess_x = mechanism_.guess_q_x;
  pull_back(mechanism_.rotations, d, guess_x);
  const auto weight = mechanism_.assembly_weight.asDiagonal();
  all.middleRows(position, n) = forces(of_frames(at.position_multipliers)) - weight * guess_x;
  const Eigen::MatrixXd needed = forces(of_deformation(at.position_multipliers));
  for (int i : mechanism_.elastic) all.row(position + i) = needed.row(i);
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

Eigen::VectorXd Equilibrium::unknowns(const InitialState& at) const {
  Eigen::VectorXd all(3 * n_ + 3 * m_);
  all << at.state.q, at.state.v, at.state.a, at.state.lambda, at.position_multipliers,
      at.velocity_multipliers;
  return all;
}

Eigen::SparseMatrix<double> Equilibrium::mixed_jacobian(const InitialState& at,
                                                        const Eigen::VectorXd& strains) const {
  Eigen::SparseMatrix<double> matrix = jacobian(at);
  if (strains_.are_none()) return matrix;
  Triplets entries;
  strains_.add_stress_stiffness(strains - strains_.at(at.state.q), entries);
  Eigen::SparseMatrix<double> change(matrix.rows(), matrix.cols());
  change.setFromTriplets(entries.begin(), entries.end());
  return matrix + change;
}

bool Equilibrium::solve_from(const Eigen::VectorXd& target, InitialState& at) {
  Eigen::VectorXd strains = strains_.at(at.state.q);
  double previous = std::numeric_limits<double>::infinity(), least = previous;
  int stuck_steps = 0;
  std::optional<LinearSolver> solver;
  for (int iteration = 0; iteration < max_newton_steps; ++iteration) {
    const Eigen::SparseMatrix<double> matrix = mixed_jacobian(at, strains);
    if (!solver) solver.emplace(matrix);
    if (!solver->factorize(matrix)) return false;
    const Eigen::VectorXd left = target - residual(at);
    Eigen::VectorXd step = left;
    solver->solve(step);
    if (!step.allFinite()) return false;
    const double size = step.head(n_).cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>();
    const bool is_stuck = size > 0.3 * previous;
    const bool is_met = is_stuck && backward_error(matrix, unknowns(at), left) < balance_round_off;
    strains = strains_.predicted(at.state.q, step.head(n_));
    advance_by(step, at);
    stuck_steps = size > 0.3 * least ? stuck_steps + 1 : 0;
    least = std::min(least, size);
    const double deformed = std::max(1.0, deformation(at.state));
    const bool is_round_off = stuck_steps < most_stuck_steps
                                  ? is_stuck && size < stuck_share * deformed
                                  : size < long_stuck_share * deformed;
    if (size < newton_tolerance || is_round_off || is_met) return true;
    previous = size;
  }
  return false;
}

Equilibrium::Found Equilibrium::look_for(const InitialState& start) {
  InitialState reached = follow(start, 1.0);
  if (is_plausible(start, reached)) return {std::move(reached), true};
  try {
    return {follow(start, slow_part), false};
  } catch (const SimulationError&) {  // what was found at once is judged
    return {std::move(reached), false};
  }
}

bool Equilibrium::is_plausible(const InitialState& start, const InitialState& found) const {
  return deformation(found.state) < far_deformed && !is_dead_point(start, found) &&
         elastic_stability(mechanism_, found.state).is_stable;
}

std::optional<InitialState> Equilibrium::look_beside(const InitialState& start,
                                                     const State& similar) {
  if (similar.q.size() != n_ || similar.lambda.size() != m_) return std::nullopt;
  InitialState near = start;
  near.state = similar;
  near.state.time = start.state.time;
  if (!solve_from(Eigen::VectorXd::Zero(3 * n_ + 3 * m_), near) || !is_plausible(start, near)) {
    return std::nullopt;
  }
  return near;
}

InitialState Equilibrium::find(InitialState start) {
  start.position_multipliers = of_frames(start.position_multipliers);
  start.is_equilibrium = true;
  return look_for(start).state;
}

InitialState Equilibrium::solve(InitialState start, const State* similar) {
  start.position_multipliers = of_frames(start.position_multipliers);
  start.is_equilibrium = true;
  if (similar) {
    if (std::optional<InitialState> beside = look_beside(start, *similar)) return *beside;
  }
  auto [reached, is_plausible] = look_for(start);
  if (is_plausible) return reached;
  if (is_dead_point(start, reached)) {
    throw UnstableEquilibrium(
        "the loads at t = 0 press the mechanism into a dead point, where its joints leave a motion "
        "free that they hold before: it snaps through (/simulation/initial_state is "
        "\"quasi-static\")");
  }
  refuse_unstable(start, reached);
  return reached;
}

bool Equilibrium::is_dead_point(const InitialState& start, const InitialState& found) const {
  const auto free_motions = [&](const State& state) {
    return rigid_motions(mechanism_, constraint_rows(mechanism_, state)).cols();
  };
  return free_motions(found.state) > free_motions(start.state);
}

InitialState Equilibrium::follow(const InitialState& start, double largest_part) {
  const Eigen::VectorXd unloaded = residual(start);
  InitialState reached = start;
  double share = 0.0, part = largest_part;
  while (share < 1.0) {
    const double next = std::min(1.0, share + part);
    InitialState trial = reached;
    if (solve_from((1.0 - next) * unloaded, trial)) {
      reached = std::move(trial);
      share = next;
      part = std::min(2.0 * part, largest_part);
    } else {
      part /= 2.0;
      if (part < smallest_part) fail(start, share);
    }
  }
  return reached;
}

double Equilibrium::deformation(const State& state) const {
  return state.q(mechanism_.elastic)
      .cwiseQuotient(mechanism_.scale(mechanism_.elastic))
      .lpNorm<Eigen::Infinity>();
}

double Equilibrium::load_factor(const InitialState& start) {
  InitialState loaded = start;
  const Eigen::VectorXd unloaded = residual(start);
  if (!solve_from((1.0 - small_load) * unloaded, loaded)) return std::nan("");
  return buckling_load_factor({mechanism_, start.state}, {mechanism_, loaded.state}, small_load);
}

void Equilibrium::fail(const InitialState& start, double share) {
  const double factor = load_factor(start);
  const std::string why =
      factor < 1.0 ? fmt::format("members buckle at some {:.3g} of these loads", factor)
                   : "the deformation may be too large, or the mechanism at a dead point";
  throw SimulationError(
      fmt::format("no elastic equilibrium was found to start from (/simulation/initial_state is "
                  "\"quasi-static\"), only up to {:.3g} of the loads at t = 0: {}",
                  share, why));
}

void Equilibrium::refuse_unstable(const InitialState& start, const InitialState& found) {
  const ElasticStability stability = elastic_stability(mechanism_, found.state);
  if (stability.is_stable) return;
  const double factor = load_factor(start);
  const std::string at =
      factor <= 1.0 ? fmt::format(", at some {:.3g} of these loads", factor) : "";
  throw UnstableEquilibrium(
      fmt::format("the elastic equilibrium under the loads at t = 0 is unstable "
                  "(/simulation/initial_state is \"quasi-static\"): {} {}{}",
                  stability.where, stability.how, at));
}

Equilibrium::Derivatives Equilibrium::differentiate(const InitialState& solution) {
  const LinearSolver::Matrix matrix = jacobian(solution);
  LinearSolver solver(matrix);
  if (!solver.factorize(matrix)) {
    throw SimulationError("the derivatives of the elastic equilibrium are singular");
  }
  Eigen::MatrixXd z = -design_derivative(solution);
  solver.solve(z);
  return {z.topRows(n_), z.middleRows(n_, n_), z.middleRows(2 * n_, n_), z.middleRows(3 * n_, m_)};
}

}  // namespace pleuel
