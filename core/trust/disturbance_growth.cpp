#include "core/trust/disturbance_growth.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/integration/step_differentiation.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/free_deformations.hpp"

namespace pleuel {

namespace {

constexpr Eigen::Index most_disturbances = 8;
constexpr double followed_growth = 1e6;

/// Disturbances of elastic coordinates, one a column, and how large they are.
class Disturbances {
 public:
  Disturbances(const Mechanism& mechanism, const State& at) : mechanism_(mechanism) {
    const Eigen::MatrixXd all = elastic_stiffness(mechanism, at);
    stiffness_ = all(mechanism.elastic, mechanism.elastic);
  }

  /// Each displaced along one of the lowest modes, and accelerated as its vibration would be.
  StateSensitivity at_rest(const State& at) const {
    const Eigen::MatrixXd z = free_deformations(mechanism_, at);
    const int n = mechanism_.system->coordinates();
    const Eigen::MatrixXd mass = scaled_tangent(mechanism_, at, {.a = 1.0}).topRows(n);
    const SymmetricModes modes =
        symmetric_modes(symmetric_part(deformation_stiffness(mechanism_, at, z)),
                        symmetric_part(z.transpose() * mass * z));
    const Eigen::Index count = std::min(most_disturbances, modes.vectors.cols());
    StateSensitivity start;
    start.q = mechanism_.scale.asDiagonal() * (z * modes.vectors.leftCols(count));
    const Eigen::VectorXd size = sizes(start).cwiseMax(1e-300);
    start.q = start.q * size.cwiseInverse().asDiagonal();
    start.v = Eigen::MatrixXd::Zero(n, count);
    start.a = start.q * (-modes.values.head(count)).asDiagonal();
    start.w = start.a;
    start.lambda = Eigen::MatrixXd::Zero(mechanism_.system->multipliers(), count);
    return start;
  }

  Eigen::VectorXd sizes(const StateSensitivity& disturbance) const {
    const Eigen::MatrixXd scaled = scaled_elastic(disturbance);
    const Eigen::MatrixXd forces = stiffness_ * scaled;
    Eigen::VectorXd energies(scaled.cols());
    for (Eigen::Index i = 0; i < scaled.cols(); ++i) energies(i) = scaled.col(i).dot(forces.col(i));
    return energies.cwiseMax(0.0).cwiseSqrt();
  }

  /// What one moves most.
  std::string owner(const StateSensitivity& disturbance, Eigen::Index column) const {
    Eigen::Index largest = 0;
    scaled_elastic(disturbance).col(column).cwiseAbs().maxCoeff(&largest);
    const int coordinate = mechanism_.elastic[largest];
    const auto& names = mechanism_.equation_names;
    return coordinate < std::ssize(names) ? names[coordinate] : "a member";
  }

 private:
  Eigen::MatrixXd scaled_elastic(const StateSensitivity& disturbance) const {
    const Eigen::VectorXd scale = mechanism_.scale(mechanism_.elastic);
    return scale.cwiseInverse().asDiagonal() * disturbance.q(mechanism_.elastic, Eigen::all).eval();
  }

  const Mechanism& mechanism_;
  Eigen::MatrixXd stiffness_;  ///< of elastic coordinates relative to their scales
};

}  // namespace

DisturbanceGrowth disturbance_growth(const Mechanism& mechanism, const Trajectory& trajectory,
                                     int from) {
  State at;
  trajectory.states->load(from, at);
  const Disturbances disturbances(mechanism, at);
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::old_state);
  motion.begin(disturbances.at_rest(at), from);
  DisturbanceGrowth growth{0.0, at.time, at.time, ""};
  while (growth.factor < followed_growth && motion.advance()) {
    Eigen::Index column = 0;
    const Eigen::VectorXd sizes = disturbances.sizes(motion.sensitivity());
    if (sizes.size() == 0 || !(sizes.maxCoeff(&column) > growth.factor)) continue;
    growth.factor = sizes(column);
    growth.largest = motion.state().time;
    growth.where = disturbances.owner(motion.sensitivity(), column);
  }
  return growth;
}

}  // namespace pleuel
