#include "core/integration/fast_vibration.hpp"

#include <cmath>
#include <numbers>

#include "core/integration/linear_solver.hpp"

namespace pleuel {

namespace {

/// The equations about a state, linearized: sparse matrices and their solutions.
class LinearizedEquations {
 public:
  LinearizedEquations(const Mechanism& mechanism, const State& state)
      : mechanism_(mechanism), system_(*mechanism.system), state_(state) {}

  /// @returns whether there is one
  bool solve(const Weights& weights, ConstraintLevel level, Eigen::VectorXd& rhs) const {
    const System::Matrix matrix = tangent(weights, level);
    LinearSolver solver(matrix, mechanism_.elastic);
    if (!solver.factorize(matrix)) return false;
    solver.solve(rhs);
    return rhs.allFinite();
  }

  /// (w.q R_q + w.v R_v + w.a R_a) y of the coordinates.
  Eigen::VectorXd product(const Weights& weights, const Eigen::VectorXd& y) const {
    const System::Matrix matrix = tangent(weights, ConstraintLevel::position);
    return matrix.topLeftCorner(y.size(), y.size()) * y;
  }

 private:
  System::Matrix tangent(const Weights& weights, ConstraintLevel level) const {
    System::Matrix matrix = system_.make_matrix();
    system_.tangent(state_, weights, level, matrix);
    return matrix;
  }

  const Mechanism& mechanism_;
  System& system_;
  const State& state_;
};

}  // namespace

double FastVibration::overshoot() const {
  if (damping_ratio >= 1.0) return 0.0;
  return std::exp(-std::numbers::pi * damping_ratio /
                  std::sqrt(1.0 - damping_ratio * damping_ratio));
}

FastVibration fast_vibration(const Mechanism& mechanism, const State& state,
                             const Eigen::VectorXd& change, double sigma) {
  const int n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  const LinearizedEquations equations(mechanism, state);
  const Weights slow{.q = 1.0, .a = sigma * sigma};
  FastVibration found;
  found.settled_q = found.settled_a = Eigen::VectorXd::Zero(n);
  found.settled_lambda = Eigen::VectorXd::Zero(m);

  // M a₀ + Φ_qᵀ μ₀ = f
  Eigen::VectorXd at_once = -change;
  if (!equations.solve({.a = 1.0}, ConstraintLevel::acceleration, at_once)) return found;
  found.a = at_once.head(n);
  found.lambda = at_once.tail(m);

  // (σ² M + K) y + Φ_qᵀ μ = f: σ² y is what the slow modes and the rigid motions are accelerated by.
  Eigen::VectorXd y = -change;
  y.tail(m) /= sigma * sigma;
  if (!equations.solve(slow, ConstraintLevel::position, y)) return found;
  const Eigen::VectorXd fast = found.a - sigma * sigma * y.head(n);

  // The same of the forces that accelerate the fast modes. Their statics: K z + Φ_qᵀ μ = M a.
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n + m);
  z.head(n) = equations.product({.a = 1.0}, fast);
  if (!equations.solve(slow, ConstraintLevel::position, z)) return found;
  found.settled_q = z.head(n);
  found.settled_a = sigma * sigma * z.head(n) - fast;
  found.settled_lambda = z.tail(m);

  const double stiffness = found.settled_q.dot(equations.product({.q = 1.0}, found.settled_q));
  const double mass = found.settled_q.dot(equations.product({.a = 1.0}, found.settled_q));
  const double damping = found.settled_q.dot(equations.product({.v = 1.0}, found.settled_q));
  if (!(stiffness > 0.0) || !(mass > 0.0)) return found;
  found.frequency = std::sqrt(stiffness / mass);
  found.damping_ratio = damping / (2.0 * std::sqrt(stiffness * mass));
  return found;
}

}  // namespace pleuel
