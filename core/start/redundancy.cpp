#include "core/start/redundancy.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/sparse_rows.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/start/assembly.hpp"

namespace pleuel {

namespace {

/// What is left of a direction is round-off below this.
constexpr double no_direction = 1e-8;
/// The small motion, in scales of the coordinates and in seconds.
constexpr double small = 1e-3;
/// The independent constraints are closed to a tenth of this. One that is independent at its end
/// is off by small².
constexpr double closed = 1e-10;
/// What opens by more, of the way that is moved, does not follow from the others but from a drive.
constexpr double most_misaligned = 3e-2;

/// A mechanism that is moved while some of its constraints are kept.
class MovedMechanism {
 public:
  MovedMechanism(const Mechanism& mechanism, State state, Eigen::VectorXd scale)
      : mechanism_(mechanism),
        system_(*mechanism.system),
        state_(std::move(state)),
        start_(state_.q),
        scale_(std::move(scale)) {}

  Eigen::VectorXd constraints() {
    system_.residual(state_, ConstraintLevel::position, residual_);
    return residual_.tail(system_.multipliers());
  }

  /// Φ_q with respect to coordinates over their scale, m × n.
  SparseRows jacobian() const { return scaled_constraints(mechanism_, state_, scale_); }

  /// A motion that the kept constraints leave free, of length one in each of the parts of the
  /// mechanism that no constraint connects; zero if they leave none.
  Eigen::VectorXd free_motion(const std::vector<int>& kept) {
    const SparseRows all = jacobian(), rows = select_rows(all, kept);
    // A direction of no meaning, the same at every call; its free part is what is left of it.
    Eigen::VectorXd direction(rows.cols());
    for (Eigen::Index i = 0; i < direction.size(); ++i)
      direction(i) = std::sin(1.0 + 2.3 * double(i));
    direction -= least_norm_solution(rows, rows * direction);
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(direction.size());
    for (const RowBlock& block : connected_blocks(all)) {
      const Eigen::VectorXd part = direction(block.columns);
      if (part.norm() > no_direction) motion(block.columns) = part.normalized();
    }
    return motion;
  }

  /// How far the part of each constraint has been moved, in scales of the coordinates.
  Eigen::VectorXd ways() {
    const Eigen::VectorXd moved =
        difference(mechanism_.rotations, state_.q, start_).cwiseQuotient(scale_);
    Eigen::VectorXd ways = Eigen::VectorXd::Zero(system_.multipliers());
    for (const RowBlock& block : connected_blocks(jacobian())) {
      ways(block.rows).setConstant(Eigen::VectorXd(moved(block.columns)).norm());
    }
    return ways;
  }

  /// Moves and closes the kept constraints. @returns whether they close
  bool move(const Eigen::VectorXd& scaled, double time, const std::vector<int>& kept) {
    const Eigen::VectorXd before = state_.q;
    advance(mechanism_.rotations, before, scale_.cwiseProduct(scaled), state_.q);
    state_.time += time;
    return close_constraints(mechanism_, scale_, kept, 0.1 * closed, state_);
  }

 private:
  const Mechanism& mechanism_;
  System& system_;
  State state_;
  Eigen::VectorXd start_;  ///< q
  Eigen::VectorXd scale_;
  Eigen::VectorXd residual_;
};

std::vector<int> first_rows(const RankedRows& ranked, std::size_t count) {
  return {ranked.order.begin(), ranked.order.begin() + static_cast<std::ptrdiff_t>(count)};
}

/// What is left of a row without its share of others.
Eigen::VectorXd part_across(const SparseRows& jacobian, int row, const std::vector<int>& others) {
  const SparseRows rows = select_rows(jacobian, others);
  const Eigen::VectorXd whole = jacobian.row(row).transpose();
  return whole - least_norm_solution(rows, rows * whole);
}

/// The rows of which a row is made, after the largest factor.
std::vector<int> rows_that_make(const SparseRows& jacobian, int row,
                                const std::vector<int>& others) {
  constexpr double counts = 0.05;
  const Eigen::VectorXd factors =
      factors_of_rows(select_rows(jacobian, others), jacobian.row(row).transpose());
  std::vector<int> found;
  if (factors.size() == 0) return found;
  const double largest = factors.lpNorm<Eigen::Infinity>();
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (std::abs(factors(i)) > counts * largest) found.push_back(others[i]);
  }
  return found;
}

int row_of(const RowBlock& block, int local) {
  return block.rows[local];
}

std::vector<int> rows_of(const RowBlock& block, const std::vector<int>& local) {
  std::vector<int> rows;
  for (const int i : local) rows.push_back(row_of(block, i));
  return rows;
}

/// Elastic coordinates in units that are as large as those of frames.
Eigen::VectorXd generous_scale(const Mechanism& mechanism) {
  constexpr double elastic = 1e3;
  Eigen::VectorXd scale = mechanism.scale;
  for (const int i : mechanism.elastic) scale(i) *= elastic;
  return scale;
}

/// In a large part of the mechanism, and in one of several parts, every coordinate counts alike: the
/// whole may be so much larger than its bodies that, in its size, their turning would count for
/// nothing.
Eigen::VectorXd local_scale(const Mechanism& mechanism, const State& state, Eigen::VectorXd scale) {
  const SparseRows jacobian = scaled_constraints(mechanism, state, scale);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(scale.size());
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    for (SparseRows::InnerIterator entry(jacobian, row); entry; ++entry) {
      squares(entry.col()) += entry.value() * entry.value();
    }
  }
  const std::vector<RowBlock> blocks = connected_blocks(jacobian);
  for (const RowBlock& block : blocks) {
    if (blocks.size() == 1 && !is_large(block)) continue;
    for (const int column : block.columns) {
      if (squares(column) > 0.0) scale(column) /= std::sqrt(squares(column));
    }
  }
  return scale;
}

/// Takes out what opens a little when drives are let go.
void erase_misaligned(const Mechanism& mechanism, const std::vector<int>& drives,
                      std::vector<int> kept, std::vector<int>& candidates) {
  const auto is_drive = [&](int row) { return std::ranges::find(drives, row) != drives.end(); };
  if (std::erase_if(kept, is_drive) == 0) return;
  MovedMechanism moved(mechanism, mechanism.guess,
                       local_scale(mechanism, mechanism.guess, mechanism.scale));
  const Eigen::VectorXd motion = moved.free_motion(kept);
  if (motion.isZero(0.0) || !moved.move(small * motion, 0.0, kept)) return;
  const Eigen::VectorXd open = moved.constraints().cwiseAbs();
  std::erase_if(candidates, [&](int row) {
    return !is_drive(row) && open(row) > closed + alignment_tolerance * small &&
           open(row) < most_misaligned * small;
  });
}

}  // namespace

std::vector<int> redundant_constraints(Mechanism& mechanism, const std::vector<int>& drives) {
  if (mechanism.system->multipliers() == 0) return {};
  MovedMechanism moved(mechanism, mechanism.guess,
                       local_scale(mechanism, mechanism.guess, mechanism.scale));
  const RankedRows ranked = rank_rows(moved.jacobian(), alignment_tolerance);
  const std::size_t independent = (ranked.pivots.array() > alignment_tolerance).count();
  std::vector<int> kept = first_rows(ranked, independent);
  std::vector<int> candidates(ranked.order.begin() + static_cast<std::ptrdiff_t>(independent),
                              ranked.order.end());
  if (candidates.empty() || !moved.move(small * moved.free_motion(kept), small, kept)) return {};
  const Eigen::VectorXd ways = moved.ways().cwiseMax(small);
  const Eigen::VectorXd open = moved.constraints().cwiseAbs();
  std::erase_if(candidates,
                [&](int row) { return !(open(row) <= closed + alignment_tolerance * ways(row)); });
  erase_misaligned(mechanism, drives, std::move(kept), candidates);
  std::ranges::sort(candidates);
  return candidates;
}

std::vector<NearRedundancy> nearly_redundant_constraints(const Mechanism& mechanism,
                                                         const State& state,
                                                         const std::vector<int>& drives,
                                                         double largest) {
  const System& system = *mechanism.system;
  if (system.multipliers() == 0) return {};
  const Eigen::VectorXd scale = local_scale(mechanism, state, generous_scale(mechanism));
  SparseRows jacobian = scaled_constraints(mechanism, state, scale);
  for (const int row : system.left_out()) jacobian.row(row) *= 0.0;
  for (const int row : drives) jacobian.row(row) *= 0.0;
  std::vector<NearRedundancy> found;
  for (const RowBlock& block : connected_blocks(jacobian)) {
    // Its rows among all columns.
    const SparseRows rows = select_rows(jacobian, block.rows);
    const RankedRows ranked = rank_rows(rows, largest);
    for (std::size_t i = 1; i < ranked.order.size(); ++i) {
      if (ranked.pivots(i) > largest) continue;
      const int local = ranked.order[i];
      const double length = rows.row(local).norm();
      if (length == 0.0) continue;
      const std::vector<int> others = first_rows(ranked, i);
      const Eigen::VectorXd blocked = part_across(rows, local, others);
      const double misalignment = blocked.norm() / length;
      if (misalignment > largest || misalignment < no_direction * alignment_tolerance) continue;
      MovedMechanism moved(mechanism, state, scale);
      const int row = row_of(block, local);
      const double before = moved.constraints()(row);
      const double way = std::clamp(10.0 * misalignment, small, 100.0 * small);
      if (!moved.move(way * blocked.normalized(), 0.0, rows_of(block, others))) continue;
      const double opened = std::abs(moved.constraints()(row) - before) / length;
      if (opened > 2.0 * misalignment * way + closed) continue;
      found.push_back({row, rows_of(block, rows_that_make(rows, local, others)), misalignment,
                       blocked.normalized()});
    }
  }
  return found;
}

LeastNorm::LeastNorm(const Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      matrix_(system_.make_matrix()),
      solver_(matrix_, mechanism.elastic),
      position_(system_.coordinates(), system_.multipliers()),
      forceless_(system_.multipliers(), system_.left_out().size()) {}

// With S the weights of the assembly, S p + Φ_qᵀ c = φ and Φ_q p = 0 have p = 0 for a row φ that
// follows from the others. The rows of those that are left out say c_i = 0; their columns are φ_i.
void LeastNorm::set(const State& state) {
  if (is_set_ && position_.time == state.time && position_.q == state.q) return;
  is_set_ = false;
  const int n = system_.coordinates(), m = system_.multipliers();
  position_.time = state.time;
  position_.q = state.q;
  projection_matrix(mechanism_, position_, matrix_);
  if (!solver_.factorize(matrix_)) {
    throw SimulationError(fmt::format(
        "the reactions of least norm are not determined at t = {:.6g} s: the mechanism is in a "
        "singular position",
        state.time));
  }
  const std::vector<int>& left_out = system_.left_out();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n + m, forceless_.cols());
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    rows.col(i).head(n) = Eigen::VectorXd(matrix_.col(n + left_out[i])).head(n);
  }
  solver_.solve(rows);
  forceless_ = -rows.bottomRows(m);
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    forceless_(left_out[i], i) = 1.0;
  }
  weights_ =
      Cholesky(forceless_.transpose() * mechanism_.reaction_weight.asDiagonal() * forceless_);
  is_set_ = true;
}

Eigen::VectorXd LeastNorm::share(const Eigen::VectorXd& b) const {
  return forceless_ * weights_.solve(forceless_.transpose() * b);
}

Eigen::VectorXd LeastNorm::apply(const Eigen::VectorXd& multipliers) const {
  return multipliers - share(mechanism_.reaction_weight.cwiseProduct(multipliers));
}

Eigen::VectorXd LeastNorm::motion(const Eigen::VectorXd& b) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n + m);
  x.tail(m) = b;
  for (int i : system_.left_out()) x(n + i) = 0.0;
  solver_.solve(x);
  return x.head(n);
}

LeastNorm::Slope LeastNorm::slope(const Eigen::VectorXd& multipliers, const Eigen::VectorXd& g) {
  const Eigen::VectorXd& weight = mechanism_.reaction_weight;
  const Eigen::VectorXd lambda = apply(multipliers);
  Slope slope;
  slope.beta = share(g);
  slope.lambda = g - weight.cwiseProduct(slope.beta);
  slope.alpha = motion(slope.lambda);
  slope.y = motion(weight.cwiseProduct(lambda));
  slope.left = multipliers - lambda;
  return slope;
}

}  // namespace pleuel
