#include "core/linear/free_deformations.hpp"

#include <cmath>
#include <utility>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/sparse_rows.hpp"

namespace pleuel {

namespace {

/// Rows of which less than this is left across others are no constraints.
constexpr double row_rank_tolerance = 1e-10;

/// An orthonormal basis of {x : rows x = 0}.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& rows) {
  return null_space_of_rows(rows.sparseView(), row_rank_tolerance);
}

/// S R_q S of one term.
Eigen::SparseMatrix<double> scaled_stiffness(Term& term, const Mechanism& mechanism,
                                             const State& state) {
  const int n = mechanism.system->coordinates();
  EntryList places;
  term.declare_entries(places);
  std::vector<double> values(places.size());
  term.write_tangent(state, {.q = 1.0}, ConstraintLevel::position, values.data());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto [row, col] = places[k];
    if (row >= n || col >= n) continue;
    entries.emplace_back(row, col, mechanism.scale(row) * values[k] * mechanism.scale(col));
  }
  Eigen::SparseMatrix<double> stiffness(n, n);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

/// The span of the modes of a symmetric matrix with eigenvalues above round-off, and the rest.
std::pair<Eigen::MatrixXd, Eigen::MatrixXd> positive_modes(const Eigen::MatrixXd& matrix,
                                                           double round_off) {
  if (matrix.cols() == 0) return {matrix, matrix};
  const SymmetricModes modes = symmetric_modes(matrix);
  const Eigen::Index count = (modes.values.array() > round_off).count();
  return {modes.vectors.rightCols(count), modes.vectors.leftCols(matrix.cols() - count)};
}

/// Of directions that springs hold, those in which the mechanism falls all the same: loads turn it faster
/// than the springs turn it back, and it is on its way. Where it is not, since it stands in
/// equilibrium, the motion does not show that this is unstable.
/// @param directions  orthonormal columns, in coordinates relative to the scale
Eigen::MatrixXd falling_motions(const Mechanism& mechanism, const State& state,
                                const Eigen::MatrixXd& directions) {
  constexpr double hardly = 0.01;  // of a length or a radian, while the fall grows e-fold
  const int n = mechanism.system->coordinates();
  const SymmetricModes modes =
      symmetric_modes(symmetric_part(deformation_stiffness(mechanism, state, directions)));
  const double limit = -eigenvalue_round_off * modes.values.cwiseAbs().maxCoeff();
  const Eigen::MatrixXd masses = scaled_tangent(mechanism, state, {.a = 1.0}).topRows(n);
  const Eigen::MatrixXd stiffness = scaled_tangent(mechanism, state, {.q = 1.0}).topRows(n);
  std::vector<Eigen::Index> falling;
  for (Eigen::Index i = 0; i < modes.values.size() && modes.values(i) < limit; ++i) {
    const Eigen::VectorXd shape = directions * modes.vectors.col(i);
    const double square = -modes.values(i) / shape.dot(masses * shape);  // of the rate of growth
    // By the forces that rates change: a balanced wheel that a drive turns changes none.
    const Eigen::VectorXd force = stiffness.transpose() * shape / modes.values(i);
    const auto part = [&](const Eigen::VectorXd& rates) {
      return std::abs(force.dot(rates.cwiseQuotient(mechanism.scale))) *
             shape.cwiseAbs().maxCoeff();
    };
    const double way = part(state.v) / std::sqrt(square) + part(state.a) / square;
    if (!(way <= hardly)) falling.push_back(i);
  }
  return directions * modes.vectors(Eigen::all, falling);
}

/// Of motions of the mechanism as rigid bodies, those that springs do not hold. What springs hold
/// belongs to the deformations: a column buckles with the spring that it stands on.
/// @param motions  orthonormal columns, in coordinates relative to the scale
Eigen::MatrixXd motions_without_springs(const Mechanism& mechanism, const State& state,
                                        const Eigen::MatrixXd& motions) {
  if (mechanism.springs.empty() || motions.cols() == 0) return motions;
  const auto [held, loose] = parted_by_springs(resistance_of_springs(mechanism, state), motions);
  if (held.cols() == 0) return motions;
  const Eigen::MatrixXd falling = falling_motions(mechanism, state, held);
  Eigen::MatrixXd others(motions.rows(), loose.cols() + falling.cols());
  others << loose, falling;
  return others;
}

}  // namespace

Eigen::MatrixXd scaled_tangent(const Mechanism& mechanism, const State& state,
                               const Weights& weights) {
  System& system = *mechanism.system;
  System::Matrix matrix = system.make_matrix();
  system.tangent(state, weights, ConstraintLevel::position, matrix);
  const int n = system.coordinates();
  Eigen::MatrixXd dense = Eigen::MatrixXd(matrix).leftCols(n) * mechanism.scale.asDiagonal();
  dense.topRows(n) = mechanism.scale.asDiagonal() * dense.topRows(n).eval();
  return dense;
}

Eigen::MatrixXd symmetric_part(const Eigen::MatrixXd& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

bool is_symmetric(const Eigen::MatrixXd& matrix, double asymmetry) {
  return (matrix - matrix.transpose()).norm() <= asymmetry * matrix.norm();
}

void normalize_rows(const Mechanism& mechanism, Eigen::MatrixXd& phi) {
  for (int i : mechanism.system->left_out()) phi.row(i).setZero();
  for (Eigen::Index i = 0; i < phi.rows(); ++i) {
    if (phi.row(i).norm() > 0.0) phi.row(i).normalize();
  }
}

Eigen::MatrixXd constraint_rows(const Mechanism& mechanism, const State& state) {
  const int m = mechanism.system->multipliers();
  Eigen::MatrixXd phi = scaled_tangent(mechanism, state, {.q = 1.0}).bottomRows(m);
  normalize_rows(mechanism, phi);
  return phi;
}

Eigen::MatrixXd with_fixed(const Eigen::MatrixXd& phi, const std::vector<int>& fixed) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(phi.rows() + fixed.size(), phi.cols());
  rows.topRows(phi.rows()) = phi;
  for (std::size_t i = 0; i < fixed.size(); ++i) rows(phi.rows() + i, fixed[i]) = 1.0;
  return rows;
}

Eigen::MatrixXd rigid_motions(const Mechanism& mechanism, const Eigen::MatrixXd& phi) {
  std::vector<bool> is_elastic(phi.cols(), false);
  for (int i : mechanism.elastic) is_elastic[i] = true;
  std::vector<Eigen::Index> rigid;
  for (Eigen::Index i = 0; i < phi.cols(); ++i) {
    if (!is_elastic[i]) rigid.push_back(i);
  }
  const Eigen::MatrixXd of_frames = null_space(phi(Eigen::all, rigid));
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(phi.cols(), of_frames.cols());
  motions(rigid, Eigen::all) = of_frames;
  return motions;
}

Eigen::MatrixXd deformations_beside(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& motions) {
  Eigen::MatrixXd rows(phi.rows() + motions.cols(), phi.cols());
  rows << phi, motions.transpose();
  return null_space(rows);
}

Eigen::MatrixXd resistance_of_springs(const Mechanism& mechanism, const State& state) {
  const int n = mechanism.system->coordinates();
  Eigen::MatrixXd resistance = Eigen::MatrixXd::Zero(n, n);
  for (Term* term : mechanism.springs) {
    const Eigen::SparseMatrix<double> all = scaled_stiffness(*term, mechanism, state);
    std::vector<int> own;
    for (int col = 0; col < n; ++col) {
      if (all.col(col).nonZeros() > 0) own.push_back(col);
    }
    if (own.empty()) continue;
    const SymmetricModes modes = symmetric_modes(symmetric_part(Eigen::MatrixXd(all)(own, own)));
    resistance(own, own) +=
        modes.vectors * modes.values.cwiseMax(0.0).asDiagonal() * modes.vectors.transpose();
  }
  return resistance;
}

Eigen::MatrixXd stiffness_of_loads(const Mechanism& mechanism, const State& state) {
  const int n = mechanism.system->coordinates();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (Term* term : mechanism.loads) sum += scaled_stiffness(*term, mechanism, state);
  return sum;
}

std::pair<Eigen::MatrixXd, Eigen::MatrixXd> parted_by_springs(const Eigen::MatrixXd& resistance,
                                                              const Eigen::MatrixXd& motions) {
  constexpr double round_off = 1e-12;
  const auto [held, loose] =
      positive_modes(symmetric_part(motions.transpose() * resistance * motions),
                     round_off * resistance.cwiseAbs().maxCoeff());
  return {motions * held, motions * loose};
}

Eigen::MatrixXd deformation_stiffness(const Mechanism& mechanism, const State& state,
                                      const Eigen::MatrixXd& deformations) {
  const int n = mechanism.system->coordinates();
  const Eigen::MatrixXd half =
      scaled_tangent(mechanism, state, {.q = 1.0}).topRows(n) * deformations;
  return deformations.transpose() * half;
}

Eigen::MatrixXd free_deformations(const Mechanism& mechanism, const State& state,
                                  const std::vector<int>& fixed) {
  const Eigen::MatrixXd phi = with_fixed(constraint_rows(mechanism, state), fixed);
  return deformations_beside(
      phi, motions_without_springs(mechanism, state, rigid_motions(mechanism, phi)));
}

Eigen::MatrixXd regular_mass(Eigen::MatrixXd mass) {
  constexpr double round_off = 1e-12;
  if (mass.size() > 0) mass.diagonal().array() += round_off * mass.diagonal().maxCoeff();
  return mass;
}

std::string owner_of(const Mechanism& mechanism, const Eigen::VectorXd& deformation) {
  Eigen::Index largest = 0;
  deformation.cwiseAbs().maxCoeff(&largest);
  return largest < std::ssize(mechanism.equation_names) ? mechanism.equation_names[largest]
                                                        : "a member";
}

}  // namespace pleuel
