#include "core/integration/fast_vibration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/mechanism/linear_solver.hpp"

namespace pleuel {

namespace {

constexpr int most_vectors = 12;
/// What is new in a vector, of all: below it errors of solutions would break constraints.
constexpr double exhausted = 1e-4;
/// Of all energy: modes that do not count.
constexpr double small_energy = 1e-4;

/// The equations about a state, linearized: products, and solutions with one of two matrices.
class LinearizedEquations {
 public:
  using Matrix = System::Matrix;

  LinearizedEquations(const Mechanism& mechanism, const State& state, double shift)
      : system_(*mechanism.system),
        state_(state),
        n_(system_.coordinates()),
        mass_(tangent({.a = 1.0}, ConstraintLevel::position)),
        stiffness_(tangent({.q = 1.0}, ConstraintLevel::position)),
        accelerating_(tangent({.a = 1.0}, ConstraintLevel::acceleration)),
        displacing_(tangent({.q = 1.0, .a = shift * shift}, ConstraintLevel::position)),
        at_once_(accelerating_, mechanism.elastic),
        shifted_(displacing_, mechanism.elastic) {
    is_regular_ = at_once_.factorize(accelerating_) && shifted_.factorize(displacing_);
  }

  bool is_regular() const { return is_regular_; }

  /// M a + Φ_qᵀ μ = f, Φ_q a = γ.
  Eigen::VectorXd accelerated(Eigen::VectorXd forces) {
    at_once_.solve(forces);
    return forces;
  }
  /// (σ² M + K) y + Φ_qᵀ μ = f, Φ_q y = γ.
  Eigen::VectorXd displaced(Eigen::VectorXd forces) {
    shifted_.solve(forces);
    return forces;
  }
  /// Forces on the coordinates as a right-hand side; those of the constraints are zero.
  Eigen::VectorXd with_constraints(const Eigen::VectorXd& forces) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(system_.size());
    all.head(n_) = forces;
    return all;
  }

  Eigen::VectorXd mass(const Eigen::VectorXd& x) const { return product(mass_, x); }
  Eigen::VectorXd stiffness(const Eigen::VectorXd& x) const { return product(stiffness_, x); }

 private:
  Matrix tangent(const Weights& weights, ConstraintLevel level) const {
    Matrix matrix = system_.make_matrix();
    system_.tangent(state_, weights, level, matrix);
    return matrix;
  }
  Eigen::VectorXd product(const Matrix& matrix, const Eigen::VectorXd& x) const {
    return (matrix.leftCols(n_) * x).head(n_);
  }

  System& system_;
  const State& state_;
  int n_;
  Matrix mass_, stiffness_;
  Matrix accelerating_, displacing_;  ///< which the solvers look at
  LinearSolver at_once_, shifted_;
  bool is_regular_ = false;
};

/// Vectors with Xᵀ M X = 1 that begin with a deformation; each next one is what the inertia of the
/// last deforms.
Eigen::MatrixXd ritz_vectors(LinearizedEquations& equations, Eigen::VectorXd x) {
  const auto norm = [&](const Eigen::VectorXd& y) {
    return std::sqrt(std::max(0.0, y.dot(equations.mass(y))));
  };
  Eigen::MatrixXd vectors(x.size(), 0), inertia(x.size(), 0);
  for (int k = 0; k < most_vectors; ++k) {
    const double all = norm(x);
    for (int i = 0; i < 2; ++i) x -= vectors * (inertia.transpose() * x);
    const double added = norm(x);
    if (!(added > exhausted * all)) break;
    vectors.conservativeResize(Eigen::NoChange, k + 1);
    inertia.conservativeResize(Eigen::NoChange, k + 1);
    vectors.col(k) = x / added;
    inertia.col(k) = equations.mass(vectors.col(k));
    x = equations.displaced(equations.with_constraints(inertia.col(k))).head(x.size());
    if (!x.allFinite()) break;
  }
  return vectors;
}

}  // namespace

FastVibration::FastVibration(const Mechanism& mechanism, const State& behind,
                             const Eigen::VectorXd& change, double slowest) {
  const int n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  a_ = Eigen::VectorXd::Zero(n);
  lambda_ = Eigen::VectorXd::Zero(m);
  if (change.isZero(0.0)) return;
  LinearizedEquations equations(mechanism, behind, slowest);
  if (!equations.is_regular()) return;
  const Eigen::VectorXd at_once = equations.accelerated(-change);
  // σ² y is what the slow modes and the motions as rigid bodies are accelerated by.
  Eigen::VectorXd forces = -change;
  forces.tail(m) /= slowest * slowest;
  const Eigen::VectorXd y = equations.displaced(forces).head(n);
  if (!at_once.allFinite() || !y.allFinite()) return;
  a_ = at_once.head(n);
  lambda_ = at_once.tail(m);
  const Eigen::VectorXd fast = equations.mass(a_ - slowest * slowest * y);
  const Eigen::MatrixXd X =
      ritz_vectors(equations, equations.displaced(equations.with_constraints(fast)).head(n));
  if (X.cols() == 0) return;
  Eigen::MatrixXd KX(n, X.cols());
  for (Eigen::Index k = 0; k < X.cols(); ++k) KX.col(k) = equations.stiffness(X.col(k));
  const Eigen::MatrixXd reduced = X.transpose() * KX;
  const SymmetricModes ritz = symmetric_modes(0.5 * (reduced + reduced.transpose()));
  for (Eigen::Index k = 0; k < X.cols(); ++k) {
    const double square = ritz.values(k);
    if (!(square >= slowest * slowest)) continue;
    const Eigen::VectorXd shape = X * ritz.vectors.col(k);
    // Of the force on the mode, ω²/(σ² + ω²) is in the fast accelerations.
    const double force = shape.dot(fast) * (slowest * slowest + square) / square;
    Mode mode;
    mode.frequency = std::sqrt(square);
    mode.energy = 0.5 * force * force / square;
    mode.q = force / square * shape;
    const Eigen::VectorXd at_q =
        equations.accelerated(equations.with_constraints(-equations.stiffness(mode.q)));
    mode.a = at_q.head(n);
    mode.lambda = at_q.tail(m);
    if (mode.energy > 0.0 && at_q.allFinite()) modes_.push_back(std::move(mode));
  }
  std::ranges::stable_sort(modes_,
                           [](const Mode& a, const Mode& b) { return a.energy > b.energy; });
}

double FastVibration::main_period() const {
  return 2.0 * std::numbers::pi / modes_.front().frequency;
}

double FastVibration::shortest_period() const {
  double highest = 0.0;
  for (const Mode& mode : modes_) {
    if (mode.energy >= small_energy * modes_.front().energy) {
      highest = std::max(highest, mode.frequency);
    }
  }
  return 2.0 * std::numbers::pi / highest;
}

double FastVibration::longest_period() const {
  double lowest = modes_.front().frequency;
  for (const Mode& mode : modes_) {
    if (mode.energy >= small_energy * modes_.front().energy) {
      lowest = std::min(lowest, mode.frequency);
    }
  }
  return 2.0 * std::numbers::pi / lowest;
}

void FastVibration::add(const Mode& mode, double way, double rate, State& state) {
  state.q += way * mode.q;
  state.v += rate * mode.q;
  state.a += way * mode.a;
  state.lambda += way * mode.lambda;
}

void FastVibration::add(double time, State& state) const {
  state.a += a_;
  state.lambda += lambda_;
  for (const Mode& mode : modes_) {
    const double angle = mode.frequency * time;
    add(mode, 1.0 - std::cos(angle), mode.frequency * std::sin(angle), state);
  }
}

void FastVibration::add_swing(double time, State& state) const {
  for (const Mode& mode : modes_) {
    const double angle = mode.frequency * time;
    add(mode, -std::cos(angle), mode.frequency * std::sin(angle), state);
  }
}

}  // namespace pleuel
