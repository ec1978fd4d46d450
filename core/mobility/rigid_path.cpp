#include "core/mobility/rigid_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/linear_solver.hpp"

namespace pleuel {

namespace {

// Relative to the scales of positions, or in radians:

/// What drives may ask for in a step.
constexpr double largest_demand = 0.2;
/// Drives that ask for less stand still.
constexpr double smallest_demand = 1e-4;
/// How far positions may be from where the tangent points to.
constexpr double largest_curvature = 0.05;
/// What bodies may move in a step.
constexpr double largest_change = 0.5;
/// How far beyond a position that cannot be left other branches are looked for, and from where.
constexpr double look_ahead = 3e-4;
constexpr double departures[] = {0.03, 0.1, 0.3};
/// Pivots of rows that count as dependent where a branch may begin.
constexpr double singular = 1e-2;
/// Rows out of line by less count as dependent.
constexpr double clearly_independent = 1e-4;
/// The longest step, in those of the simulation: laws are looked at four times in it.
constexpr double longest_step = 16.0;
/// Drives that ask for much within so little jump.
constexpr double shortest_step = 1e-9;
/// What drives ask for in the first step in which a gap is looked at.
constexpr double first_gap = 5e-4;
/// Of the lengths: a gap that is closed again, and one that dimensions of machines leave.
constexpr double no_gap = 1e-8, small_gap = 5e-5;
/// Drives that have gone less far have had no motion of their own.
constexpr double first_motion = 2e-3;
/// Steps of close() that are made beside twice as many as the simulation has.
constexpr int first_iterations = 6000;

class Follower {
 public:
  Follower(RigidConstraints& constraints, double end, double step, const PathObserver& observer)
      : constraints_(constraints), end_(end), step_(step), observer_(observer) {}

  RigidPath follow(const Eigen::VectorXd& start) {
    RigidPath path;
    path.q = start;
    if (constraints_.rows() == 0 || constraints_.coordinates() == 0) return path;
    const RigidConstraints::Closure first = constraints_.close(start, 0.0);
    if (!first.is_closed) {
      path.end = RigidPath::End::bends;
      return path;
    }
    path.q = first.q;
    complete_rows(path.q);
    int sign = orientation(path.q, 0.0);
    double step = step_;
    std::vector<Eigen::VectorXd> before;
    const auto arrive = [&] {
      before.push_back(path.q);
      if (observer_) observer_(path.time, path.q);
    };
    arrive();
    const int most_iterations = static_cast<int>(2.0 * end_ / step_) + first_iterations;
    while (path.time < end_ && constraints_.iterations() < most_iterations) {
      step = std::min({step, longest_step * step_, end_ - path.time});
      Demand asked = demand(path.q, path.time, step);
      for (; asked.size > largest_demand && step >= shortest_step * step_;
           asked = demand(path.q, path.time, step))
        step *= 0.5;
      if (step < shortest_step * step_) return path;  // the drive jumps
      const bool is_small = asked.size <= smallest_demand;
      if (!is_small) step *= asked.share;  // to where drives turn that return within it
      const double next = end_ - path.time - step < 1e-9 * step_ ? end_ : path.time + step;
      const RigidConstraints::Closure closure = constraints_.close(path.q, next);
      const int next_sign = closure.is_closed ? orientation(closure.q, next) : 0;
      if (is_near(path.q, closure) && (is_small || next_sign == sign)) {
        path.q = closure.q;
        path.time = next;
        path.travel = std::max(path.travel, drive_values(before.front(), next));
        sign = next_sign;
        arrive();
        step *= 2.0;
      } else if (!is_small) {
        step *= 0.25;
      } else if (take_other_branch(path) || pass_small_gap(path)) {
        sign = orientation(path.q, path.time);
        arrive();
        step = step_;
      } else {
        describe_end(before, path);
        return path;
      }
    }
    return path;
  }

 private:
  /// The largest of the equations of drives.
  double drive_values(const Eigen::VectorXd& q, double time) const {
    const Eigen::VectorXd values = constraints_.values(q, time);
    double largest = 0.0;
    for (int row = 0; row < constraints_.rows(); ++row) {
      if (constraints_.is_drive()[row]) largest = std::max(largest, std::abs(values(row)));
    }
    return largest;
  }

  struct Demand {
    double size = 0.0;
    double share = 1.0;  ///< of the step, when it is largest
  };

  /// What the drives ask for within a step from positions where they are met.
  Demand demand(const Eigen::VectorXd& q, double time, double step) const {
    Demand largest;
    for (const double share : {1.0, 0.75, 0.5, 0.25}) {
      const double size = drive_values(q, time + share * step);
      if (size > largest.size) largest = {size, share};
    }
    return largest;
  }

  bool is_near(const Eigen::VectorXd& q, const RigidConstraints::Closure& closure) const {
    if (!closure.is_closed) return false;
    const Eigen::VectorXd change = constraints_.difference(closure.q, q);
    return change.lpNorm<Eigen::Infinity>() <= largest_change &&
           (change - closure.first).lpNorm<Eigen::Infinity>() <= largest_curvature;
  }

  /// Rows that make Φ_z square, as far as that is needed: the motions that are free at the start
  /// stand still. Of dependent rows some are enough.
  void complete_rows(const Eigen::VectorXd& q) {
    const SparseRows jacobian = jacobian_at(q, 0.0);
    const RankedRows ranked = rank_rows(jacobian, clearly_independent);
    for (Eigen::Index i = 0; i < ranked.pivots.size(); ++i) {
      if (ranked.pivots(i) > clearly_independent) independent_.push_back(ranked.order[i]);
    }
    std::ranges::sort(independent_);
    free_ = null_space_of_rows(jacobian, clearly_independent);
  }

  /// The sign of det Φ_z, so completed; 0 where it is singular or cannot be completed.
  int orientation(const Eigen::VectorXd& q, double time) {
    const auto rows = static_cast<Eigen::Index>(independent_.size());
    const Eigen::Index n = constraints_.coordinates();
    if (rows + free_.cols() != n) return 0;
    const SparseRows jacobian = jacobian_at(q, time);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (SparseRows::InnerIterator entry(jacobian, independent_[i]); entry; ++entry) {
        entries.emplace_back(i, entry.col(), entry.value());
      }
    }
    for (Eigen::Index k = 0; k < free_.cols(); ++k) {
      for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(rows + k, i, free_(i, k));
    }
    LinearSolver::Matrix square(n, n);
    square.setFromTriplets(entries.begin(), entries.end());
    if (!solver_) solver_.emplace(square);
    return solver_->factorize(square) ? solver_->determinant_sign() : 0;
  }

  SparseRows jacobian_at(const Eigen::VectorXd& q, double time) const {
    Eigen::VectorXd values;
    SparseRows jacobian;
    constraints_.linearize(q, time, values, jacobian);
    return jacobian;
  }

  /// Where a position is left along a motion that drives do not ask for, as from a dead centre.
  bool take_other_branch(RigidPath& path) const {
    const std::optional<double> next = time_of_demand(path.q, path.time, look_ahead);
    if (!next) {  // drives ask for nothing any more
      path.time = end_;
      return true;
    }
    const Eigen::MatrixXd motions = null_space_of_rows(jacobian_at(path.q, path.time), singular);
    for (const double length : departures) {
      for (Eigen::Index k = 0; k < motions.cols(); ++k) {
        for (const double sense : {1.0, -1.0}) {
          const Eigen::VectorXd change = sense * length * motions.col(k);
          const RigidConstraints::Closure closure =
              constraints_.close(constraints_.advance(path.q, change), *next);
          if (!closure.is_closed ||
              constraints_.difference(closure.q, path.q).lpNorm<Eigen::Infinity>() >
                  2.0 * largest_change) {
            continue;
          }
          path.q = closure.q;
          path.time = *next;
          return true;
        }
      }
    }
    return false;
  }

  /// When drives will have asked for so much.
  std::optional<double> time_of_demand(const Eigen::VectorXd& q, double time, double much) const {
    double step = 1e-6 * step_;
    while (demand(q, time, step).size < much) {
      if (time + step >= end_) return std::nullopt;
      step = std::min(1.5 * step, end_ - time);
    }
    return time + step;
  }

  void describe_end(const std::vector<Eigen::VectorXd>& before, RigidPath& path) {
    if (drives_move_nothing(before[before.size() / 2]) || path.travel <= first_motion) {
      path.end = RigidPath::End::bends;
      return;
    }
    path.end = RigidPath::End::locks;
    // Beside drives that hardly move, the last bit of the way.
    path.still_moves = constraints_.difference(path.q, before[before.size() - 2]);
    Eigen::VectorXd q;
    double time;
    path.gap = march(path, q, time).distance;
  }

  /// Whether joints, or other drives, hold already what some drives would move.
  bool drives_move_nothing(const Eigen::VectorXd& q) const {
    std::vector<int> drives;
    for (int row = 0; row < constraints_.rows(); ++row) {
      if (constraints_.is_drive()[row]) drives.push_back(row);
    }
    return rank_added_by(drives, jacobian_at(q, 0.0), clearly_independent) < std::ssize(drives);
  }

  /// Goes on where joints are hardly apart, as of dimensions that are rounded.
  bool pass_small_gap(RigidPath& path) {
    Eigen::VectorXd q;
    double time;
    if (march(path, q, time).share > small_gap) return false;
    path.q = q;
    path.time = time;
    return true;
  }

  /// Lets joints come apart as little as drives ask for, until they close again or the motion ends.
  /// @param q, time  where that is
  /// @returns the largest gap on the way
  RigidConstraints::Gap march(const RigidPath& path, Eigen::VectorXd& q, double& time) {
    constexpr int most_steps = 150;
    RigidConstraints::Gap largest;
    double asked = first_gap;
    q = path.q;
    time = path.time;
    for (int i = 0; i < most_steps && time < end_; ++i) {
      time = time_of_demand(q, time, asked).value_or(end_);
      asked = std::min(1.25 * asked, 0.5 * largest_demand);
      q = constraints_.close(q, time, constraints_.weight_of_gaps()).q;
      const RigidConstraints::Gap gap = constraints_.gap(constraints_.values(q, time));
      if (largest.share > 0.0 && gap.share <= no_gap) break;
      if (gap.share > largest.share) largest = gap;
    }
    return largest;
  }

  RigidConstraints& constraints_;
  double end_, step_;
  const PathObserver& observer_;
  std::vector<int> independent_;
  Eigen::MatrixXd free_;
  std::optional<LinearSolver> solver_;  ///< of Φ_z, completed
};

}  // namespace

RigidPath follow_drives(RigidConstraints& constraints, const Eigen::VectorXd& start, double end,
                        double step, const PathObserver& observer) {
  return Follower(constraints, end, step, observer).follow(start);
}

}  // namespace pleuel
