#include "core/trust/disturbance_growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/integration/step_differentiation.hpp"
#include "core/linear/axial_strains.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/free_deformations.hpp"

namespace pleuel {

namespace {

/// Of each kind: lowest in frequency, and those that loads soften most.
constexpr Eigen::Index modes_of_a_kind = 4;
/// Of a motion: stretches after which disturbances that have not grown begin anew, of each of three groups: those
/// that begin often see what comes late, those that begin once what grows slowly.
constexpr int stretches = 16;
constexpr std::array<int, 3> renewals = {1, 4, 16};
constexpr double followed_growth = 1e6;
/// What turns or moves bodies by so many times as much as it deforms them is no matter of elasticity.
constexpr double rigid_ratio = 10.0;

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
    const Eigen::VectorXd x =
        mechanism_.scale.cwiseInverse().asDiagonal() * disturbance.q.col(column);
    Eigen::VectorXd frames = x;
    frames(mechanism_.elastic).setZero();
    const double deformed = Eigen::VectorXd(x(mechanism_.elastic)).lpNorm<Eigen::Infinity>();
    return frames.lpNorm<Eigen::Infinity>() > rigid_ratio * deformed;
  }

  /// What one deforms most.
  std::string owner(const StateSensitivity& disturbance, Eigen::Index column) const {
    const Eigen::VectorXd x =
        mechanism_.scale.cwiseInverse().asDiagonal() * disturbance.q.col(column);
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

}  // namespace

DisturbanceGrowth disturbance_growth(const Mechanism& mechanism, const Trajectory& trajectory) {
  State at;
  trajectory.states->load(0, at);
  Disturbances disturbances(mechanism);
  const StateSensitivity first = disturbances.at_rest(at);
  Groups groups(first, at.time);
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::old_state);
  motion.begin(groups.all(first));
  const int stretch = std::max(1, trajectory.steps() / stretches);
  DisturbanceGrowth growth{0.0, at.time, at.time, ""};
  while (first.q.cols() > 0 && growth.factor < followed_growth && motion.advance()) {
    StateSensitivity now = motion.sensitivity();
    const Eigen::VectorXd sizes = disturbances.sizes(motion.state(), now);
    for (Eigen::Index i = 0; i < sizes.size(); ++i) {
      if (sizes(i) <= growth.factor || disturbances.is_rigid(now, i)) continue;
      growth = {sizes(i), groups.begun[static_cast<std::size_t>(i)], motion.state().time,
                disturbances.owner(now, i)};
    }
    if (motion.step() % stretch != 0 || motion.step() == trajectory.steps()) continue;
    const State here = motion.state();
    groups.renew(motion.step() / stretch, here.time, sizes, disturbances.at_rest(here), now);
    motion.begin(std::move(now), motion.step());
  }
  return growth;
}

}  // namespace pleuel
