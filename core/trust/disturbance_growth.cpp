#include "core/trust/disturbance_growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/integration/step_differentiation.hpp"
#include "core/integration/trajectory.hpp"
#include "core/linear/axial_strains.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/free_deformations.hpp"
#include "core/linear/linearization.hpp"
#include "core/linear/modes.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/trust/critical_instants.hpp"

namespace pleuel {

namespace {

/// Of each kind: lowest in frequency, and those that loads soften most.
constexpr Eigen::Index modes_of_a_kind = 4;
/// Of a motion: stretches after which disturbances that have not grown begin anew, of each of three groups: those
/// that begin often see what comes late, those that begin once what grows slowly.
constexpr int stretches = 16;
constexpr std::array<int, 3> renewals = {1, 4, 16};
/// At how many instants of a motion their sizes are looked at.
constexpr int looks = 500;
constexpr double followed_growth = 1e6;
/// What turns or moves bodies by so many times as much as it deforms them is no deformation.
constexpr double rigid_ratio = 10.0;
/// What a motion that does not go along a disturbance moves that way while it grows e-fold, of a length or a
/// radian.
constexpr double hardly = 0.01;

/// The largest growth of disturbances that deform bodies, and of those that move them against springs.
struct LargestGrowth {
  DisturbanceGrowth of_members, of_springs;

  double factor() const { return std::max(of_members.factor, of_springs.factor); }
  /// That of members, unless that of springs alone does harm.
  const DisturbanceGrowth& worst() const {
    if (of_members.factor > harmful_growth) return of_members;
    return of_springs.factor > of_members.factor ? of_springs : of_members;
  }
};

/// Disturbances of a mechanism, one a column, and how large they are.
class Disturbances {
 public:
  explicit Disturbances(const Mechanism& mechanism)
      : mechanism_(mechanism), strains_(*mechanism.system) {}

  /// New ones at a state: each displaced along a mode, without velocity.
  StateSensitivity at_rest(const State& at) {
    stiffness_ = elastic_stiffness(mechanism_, at);
    const Eigen::MatrixXd z = free_deformations(mechanism_, at);
    const int n = mechanism_.system->coordinates();
    const Eigen::MatrixXd mass = scaled_tangent(mechanism_, at, {.a = 1.0}).topRows(n);
    const Eigen::MatrixXd loaded = symmetric_part(deformation_stiffness(mechanism_, at, z)),
                          inertia = regular_mass(symmetric_part(z.transpose() * mass * z)),
                          unloaded = symmetric_part(z.transpose() * stiffness_ * z);
    Eigen::MatrixXd shapes = lowest(loaded, inertia);
    if (Cholesky(unloaded).is_positive_definite()) {
      const Eigen::MatrixXd soft = lowest(loaded, unloaded);
      Eigen::MatrixXd both(z.cols(), shapes.cols() + soft.cols());
      both << shapes, soft;
      shapes = both;
    }
    return displaced(at, z * shapes);
  }

  /// The root of the elastic energy in each, of springs, too. Where members are bent, bending stretches them
  /// (axial_strains.hpp).
  Eigen::VectorXd sizes(const State& at, const StateSensitivity& disturbance) const {
    const Eigen::SparseMatrix<double> coupling = strains_.coupling(at.q);
    const Eigen::MatrixXd x = mechanism_.scale.cwiseInverse().asDiagonal() * disturbance.q;
    const Eigen::MatrixXd forces = stiffness_ * x;
    Eigen::VectorXd energies(x.cols());
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Eigen::VectorXd q = disturbance.q.col(i);
      energies(i) = x.col(i).dot(forces.col(i)) + q.dot(coupling * q);
    }
    return energies.cwiseMax(0.0).cwiseSqrt();
  }

  bool is_rigid(const StateSensitivity& disturbance, Eigen::Index column) const {
    Eigen::VectorXd frames = relative(disturbance, column);
    const double deformed = Eigen::VectorXd(frames(mechanism_.elastic)).lpNorm<Eigen::Infinity>();
    frames(mechanism_.elastic).setZero();
    return frames.lpNorm<Eigen::Infinity>() > rigid_ratio * deformed;
  }

  /// Of one in coordinates relative to their scales.
  Eigen::VectorXd relative(const StateSensitivity& disturbance, Eigen::Index column) const {
    return mechanism_.scale.cwiseInverse().asDiagonal() * disturbance.q.col(column);
  }

  double energy(const Eigen::VectorXd& x) const { return x.dot(stiffness_ * x); }

  /// What one deforms most, or moves most if bodies are rigid.
  std::string owner(const StateSensitivity& disturbance, Eigen::Index column) const {
    const Eigen::VectorXd x = relative(disturbance, column);
    if (is_rigid(disturbance, column)) return owner_of(mechanism_, x);
    Eigen::VectorXd deformed = Eigen::VectorXd::Zero(x.size());
    deformed(mechanism_.elastic) = x(mechanism_.elastic);
    return owner_of(mechanism_, deformed);
  }

 private:
  static Eigen::MatrixXd lowest(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& beside) {
    const SymmetricModes modes = symmetric_modes(stiffness, beside);
    return modes.vectors.leftCols(std::min(modes_of_a_kind, modes.vectors.cols()));
  }

  /// Of unit size. Accelerations follow from the first step: those of modes that it does not resolve
  /// would be taken for much too long.
  StateSensitivity displaced(const State& at, const Eigen::MatrixXd& shapes) const {
    StateSensitivity start;
    start.q = mechanism_.scale.asDiagonal() * shapes;
    const Eigen::VectorXd size = sizes(at, start).cwiseMax(1e-300);
    start.q = start.q * size.cwiseInverse().asDiagonal();
    start.v = start.a = start.w = Eigen::MatrixXd::Zero(start.q.rows(), start.q.cols());
    start.lambda = Eigen::MatrixXd::Zero(mechanism_.system->multipliers(), start.q.cols());
    return start;
  }

  const Mechanism& mechanism_;
  AxialStrains strains_;
  Eigen::MatrixXd
      stiffness_;  ///< of coordinates relative to their scales, where the last ones began
};

/// What springs hold at a state, so that it is a member of the mechanism as an elastic body is.
class HeldBySprings {
 public:
  HeldBySprings(const Mechanism& mechanism, const State& at)
      : resistance_(resistance_of_springs(mechanism, at)),
        v_(at.v.cwiseQuotient(mechanism.scale)),
        a_(at.a.cwiseQuotient(mechanism.scale)) {
    const int n = mechanism.system->coordinates();
    mass_ = scaled_tangent(mechanism, at, {.a = 1.0}).topLeftCorner(n, n);
  }

  /// Whether most of the energy of a disturbance is that of springs, and the motion itself hardly goes that way
  /// while it grows e-fold: else, as in a pendulum with a spring, the motion shows it.
  /// @param x       relative to the scales of coordinates
  /// @param energy  of all that is elastic
  /// @param rate    of its growth [1/s]
  bool holds(const Eigen::VectorXd& x, double energy, double rate) const {
    if (x.dot(resistance_ * x) < energy / 2.0) return false;
    const Eigen::VectorXd momentum = mass_.transpose() * x;
    const double size = x.lpNorm<Eigen::Infinity>() / momentum.dot(x);
    const double way =
        std::abs(momentum.dot(v_)) / rate + std::abs(momentum.dot(a_)) / (rate * rate);
    return size * way <= hardly;
  }

 private:
  Eigen::MatrixXd resistance_, mass_;
  Eigen::VectorXd v_, a_;  ///< relative to the scales of coordinates
};

/// The groups of disturbances while they are propagated.
struct Groups {
  Eigen::Index size;          ///< of each
  std::vector<double> begun;  ///< one a column [s]

  Groups(const StateSensitivity& first, double now)
      : size(first.q.cols()),
        begun(renewals.size() * static_cast<std::size_t>(first.q.cols()), now) {}

  StateSensitivity all(const StateSensitivity& one) const {
    const auto groups = static_cast<Eigen::Index>(renewals.size());
    return {one.q.replicate(1, groups), one.v.replicate(1, groups), one.a.replicate(1, groups),
            one.w.replicate(1, groups), one.lambda.replicate(1, groups)};
  }

  /// New ones in place of those that have not grown, in the groups whose turn it is.
  void renew(int stretch, double now, const Eigen::VectorXd& sizes, const StateSensitivity& fresh,
             StateSensitivity& columns) {
    for (std::size_t group = 0; group < renewals.size(); ++group) {
      if (stretch % renewals[group] != 0) continue;
      for (Eigen::Index i = 0; i < std::min(size, fresh.q.cols()); ++i) {
        const Eigen::Index column = static_cast<Eigen::Index>(group) * size + i;
        if (sizes(column) > 1.0) continue;
        begun[static_cast<std::size_t>(column)] = now;
        for (const auto part : {&StateSensitivity::q, &StateSensitivity::v, &StateSensitivity::a,
                                &StateSensitivity::w, &StateSensitivity::lambda}) {
          (columns.*part).col(column) = (fresh.*part).col(i);
        }
      }
    }
  }
};

/// Disturbances that are propagated along a motion, and the largest growth that was seen.
class PropagatedDisturbances {
 public:
  PropagatedDisturbances(const Mechanism& mechanism, const State& at)
      : mechanism_(mechanism),
        disturbances_(mechanism),
        first_(disturbances_.at_rest(at)),
        groups_(first_, at.time),
        growth_{{0.0, at.time, at.time, ""}, {0.0, at.time, at.time, ""}} {}

  bool is_empty() const { return first_.q.cols() == 0; }
  StateSensitivity first() const { return groups_.all(first_); }
  const LargestGrowth& growth() const { return growth_; }

  void look(const State& at, const StateSensitivity& now) {
    sizes_ = disturbances_.sizes(at, now);
    std::optional<HeldBySprings> springs;
    for (Eigen::Index i = 0; i < sizes_.size(); ++i) {
      const bool is_rigid = disturbances_.is_rigid(now, i);
      DisturbanceGrowth& largest = is_rigid ? growth_.of_springs : growth_.of_members;
      if (sizes_(i) <= largest.factor) continue;
      const double begun = groups_.begun[static_cast<std::size_t>(i)];
      if (is_rigid) {
        if (mechanism_.springs.empty()) continue;
        if (!springs) springs.emplace(mechanism_, at);
        const Eigen::VectorXd x = disturbances_.relative(now, i);
        const double rate = std::log(sizes_(i)) / (at.time - begun);
        if (!springs->holds(x, disturbances_.energy(x), rate)) continue;
      }
      largest = {sizes_(i), begun, at.time, disturbances_.owner(now, i)};
    }
  }

  /// After a look.
  void renew(int stretch, const State& at, StateSensitivity& now) {
    groups_.renew(stretch, at.time, sizes_, disturbances_.at_rest(at), now);
  }

 private:
  const Mechanism& mechanism_;
  Disturbances disturbances_;
  StateSensitivity first_;
  Groups groups_;
  LargestGrowth growth_;
  Eigen::VectorXd sizes_;
};

}  // namespace

DisturbanceGrowth disturbance_growth(const Mechanism& mechanism, const Trajectory& trajectory) {
  PropagatedDisturbances disturbances(mechanism, trajectory.state_at(0));
  if (disturbances.is_empty()) return disturbances.growth().worst();
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::old_state);
  motion.begin(disturbances.first());
  const int stretch = std::max(1, trajectory.steps() / stretches);
  const int between = std::max(1, trajectory.steps() / looks);
  while (disturbances.growth().factor() < followed_growth && motion.advance()) {
    const bool is_last = motion.step() == trajectory.steps();
    const bool renews = motion.step() % stretch == 0 && !is_last;
    if (!renews && !is_last && motion.step() % between != 0) continue;
    StateSensitivity now = motion.sensitivity();
    disturbances.look(motion.state(), now);
    if (!renews) continue;
    disturbances.renew(motion.step() / stretch, motion.state(), now);
    motion.begin(std::move(now), motion.step());
  }
  return disturbances.growth().worst();
}

}  // namespace pleuel
