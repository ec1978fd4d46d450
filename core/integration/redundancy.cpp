#include "core/integration/redundancy.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "core/integration/configuration.hpp"

namespace pleuel {

namespace {

/// Pivots below this, relative to the largest, are zero.
constexpr double rank_tolerance = 1e-8;
/// The small motion, in scales of the coordinates and in seconds.
constexpr double small = 1e-3;
/// A constraint holds after it up to this; one that is independent at its end is off by small².
constexpr double closed = 1e-10;
constexpr int max_iterations = 20;

class RedundancyTest {
 public:
  explicit RedundancyTest(Mechanism& mechanism)
      : mechanism_(mechanism),
        system_(*mechanism.system),
        state_(mechanism.guess),
        matrix_(system_.make_matrix()) {}

  std::vector<int> run() {
    if (system_.multipliers() == 0) return {};
    std::vector<int> candidates = split();
    if (candidates.empty() || !move()) return {};
    const Eigen::VectorXd open = constraints().cwiseAbs();
    std::erase_if(candidates, [&](int row) { return !(open(row) <= closed); });
    std::sort(candidates.begin(), candidates.end());
    return candidates;
  }

 private:
  Eigen::VectorXd constraints() {
    system_.residual(state_, ConstraintLevel::position, residual_);
    return residual_.tail(system_.multipliers());
  }

  /// Φ_q with respect to coordinates over their scale, m × n.
  Eigen::MatrixXd jacobian() {
    system_.tangent(state_, {.q = 1.0}, ConstraintLevel::position, matrix_);
    const Eigen::MatrixXd rows = matrix_.bottomRows(system_.multipliers());
    return rows.leftCols(system_.coordinates()) * mechanism_.scale.asDiagonal();
  }

  /// Sets the independent rows and returns the others.
  std::vector<int> split() {
    const Eigen::MatrixXd rows = jacobian().rowwise().normalized();
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows.transpose());
    qr.setThreshold(rank_tolerance);
    const auto& order = qr.colsPermutation().indices();
    independent_.assign(order.begin(), order.begin() + qr.rank());
    return {order.begin() + qr.rank(), order.end()};
  }

  /// Moves along what the independent constraints leave free, and closes these.
  bool move() {
    Eigen::MatrixXd rows = jacobian()(independent_, Eigen::all);
    // A direction of no meaning, the same at every call; its free part is what is left of it.
    Eigen::VectorXd direction(rows.cols());
    for (Eigen::Index i = 0; i < direction.size(); ++i)
      direction(i) = std::sin(1.0 + 2.3 * double(i));
    direction -= least_norm(rows, rows * direction);
    if (direction.norm() > rank_tolerance) add(small * direction.normalized());
    state_.time += small;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      const Eigen::VectorXd open = constraints()(independent_);
      if (open.lpNorm<Eigen::Infinity>() <= 0.1 * closed) return true;
      rows = jacobian()(independent_, Eigen::all);
      add(-least_norm(rows, open));
    }
    return false;
  }

  static Eigen::VectorXd least_norm(const Eigen::MatrixXd& rows, const Eigen::VectorXd& rhs) {
    return rows.completeOrthogonalDecomposition().solve(rhs);
  }

  void add(const Eigen::VectorXd& scaled) {
    const Eigen::VectorXd start = state_.q;
    advance(mechanism_.rotations, start, mechanism_.scale.cwiseProduct(scaled), state_.q);
  }

  Mechanism& mechanism_;
  System& system_;
  State state_;
  System::Matrix matrix_;
  Eigen::VectorXd residual_;
  std::vector<int> independent_;
};

}  // namespace

std::vector<int> redundant_constraints(Mechanism& mechanism) {
  return RedundancyTest(mechanism).run();
}

}  // namespace pleuel
