#include "core/integration/elastic_stability.hpp"

#include <algorithm>
#include <limits>

#include "core/base/dense_solvers.hpp"
#include "core/integration/axial_strains.hpp"

namespace pleuel {

namespace {

/// Rows that depend on others by less than this, relative to the largest, are no constraints.
constexpr double row_rank_tolerance = 1e-10;
/// Eigenvalues below this share of the largest are round-off.
constexpr double eigenvalue_round_off = 1e-13;
/// What of a matrix counts as not symmetric.
constexpr double asymmetry = 1e-7;

/// An orthonormal basis of {x : rows x = 0}.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& rows, Eigen::Index columns) {
  if (rows.rows() == 0) return Eigen::MatrixXd::Identity(columns, columns);
  return PivotedQr(rows.transpose(), row_rank_tolerance).normal_space();
}

/// S R_q S and Φ_q S, dense.
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

bool is_symmetric(const Eigen::MatrixXd& matrix) {
  return (matrix - matrix.transpose()).norm() <= asymmetry * matrix.norm();
}

/// Whether small motions in the given deformations grow:
///     det(s² M + s G + K) = 0 with an s of positive real part,
/// G the gyroscopic part of the forces of velocity. Forces that damp are left out: they only delay.
bool grows(const Mechanism& mechanism, const State& state, const Eigen::MatrixXd& deformations,
           const Eigen::MatrixXd& stiffness) {
  constexpr double round_off = 1e-7;
  const int n = mechanism.system->coordinates();
  const Eigen::Index size = deformations.cols();
  const auto reduced = [&](const Weights& weights) -> Eigen::MatrixXd {
    return deformations.transpose() * scaled_tangent(mechanism, state, weights).topRows(n) *
           deformations;
  };
  const Eigen::MatrixXd rates = reduced({.v = 1.0});
  const DenseLu mass(symmetric_part(reduced({.a = 1.0})));
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  companion.topRightCorner(size, size).setIdentity();
  companion.bottomLeftCorner(size, size) = -mass.solve(stiffness);
  companion.bottomRightCorner(size, size) = -mass.solve(0.5 * (rates - rates.transpose()));
  const Eigen::VectorXcd roots = eigenvalues_of(companion);
  return roots.real().maxCoeff() > round_off * roots.cwiseAbs().maxCoeff();
}

/// What the largest entry of a deformation belongs to.
std::string owner(const Mechanism& mechanism, const Eigen::VectorXd& deformation) {
  Eigen::Index largest = 0;
  deformation.cwiseAbs().maxCoeff(&largest);
  return largest < std::ssize(mechanism.equation_names) ? mechanism.equation_names[largest]
                                                        : "a member";
}

int count_negative(const Eigen::VectorXcd& eigenvalues) {
  const double limit = eigenvalue_round_off * eigenvalues.cwiseAbs().maxCoeff();
  return static_cast<int>(
      std::count_if(eigenvalues.begin(), eigenvalues.end(), [limit](const auto& value) {
        return value.real() < -limit && std::abs(value.imag()) <= limit;
      }));
}

}  // namespace

Eigen::MatrixXd free_deformations(const Mechanism& mechanism, const State& state) {
  const System& system = *mechanism.system;
  const Eigen::Index n = system.coordinates();
  Eigen::MatrixXd phi =
      scaled_tangent(mechanism, state, {.q = 1.0}).bottomRows(system.multipliers());
  for (int i : system.left_out()) phi.row(i).setZero();
  // Rows normalised: of lengths, directions and angles none counts more.
  for (Eigen::Index i = 0; i < phi.rows(); ++i) {
    if (phi.row(i).norm() > 0.0) phi.row(i).normalize();
  }
  std::vector<bool> is_elastic(n, false);
  for (int i : mechanism.elastic) is_elastic[i] = true;
  std::vector<Eigen::Index> rigid;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!is_elastic[i]) rigid.push_back(i);
  }
  const Eigen::MatrixXd motions = null_space(phi(Eigen::all, rigid), rigid.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(phi.rows() + motions.cols(), n);
  rows.topRows(phi.rows()) = phi;
  rows.bottomRows(motions.cols())(Eigen::all, rigid) = motions.transpose();
  return null_space(rows, n);
}

Eigen::MatrixXd deformation_stiffness(const Mechanism& mechanism, const State& state,
                                      const Eigen::MatrixXd& deformations) {
  const int n = mechanism.system->coordinates();
  const Eigen::MatrixXd half =
      scaled_tangent(mechanism, state, {.q = 1.0}).topRows(n) * deformations;
  return deformations.transpose() * half;
}

ElasticStability elastic_stability(const Mechanism& mechanism, const State& state) {
  const Eigen::MatrixXd z = free_deformations(mechanism, state);
  if (z.cols() == 0) return {};
  const Eigen::MatrixXd stiffness = deformation_stiffness(mechanism, state, z);
  const Eigen::MatrixXd symmetric = symmetric_part(stiffness);
  if (is_positive_definite(symmetric)) return {};
  const SymmetricModes modes = symmetric_modes(symmetric);
  ElasticStability result;
  const bool is_conservative = is_symmetric(stiffness);
  result.negative = is_conservative ? count_negative(modes.values.cast<std::complex<double>>())
                                    : count_negative(eigenvalues_of(stiffness));
  const double round_off = eigenvalue_round_off * modes.values.cwiseAbs().maxCoeff();
  const Eigen::Index lowest = (modes.values.array() < -round_off).count();
  const Eigen::MatrixXd shapes = modes.vectors.leftCols(lowest);
  const bool may_be_held = result.negative % 2 == 0 && (!is_conservative || !state.v.isZero(0.0));
  result.is_stable =
      result.negative == 0 || (may_be_held && !grows(mechanism, state, z * shapes,
                                                     shapes.transpose() * stiffness * shapes));
  if (!result.is_stable) result.where = owner(mechanism, z * modes.vectors.col(0));
  return result;
}

double buckling_load_factor(const Mechanism& mechanism, const State& unloaded, const State& loaded,
                            double share) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd z = free_deformations(mechanism, unloaded);
  if (z.cols() == 0) return none;
  const AxialStrains strains(*mechanism.system);
  const Eigen::Index n = unloaded.q.size();
  const auto stiffness = [&](const State& state) -> Eigen::MatrixXd {
    std::vector<Eigen::Triplet<double>> entries;
    strains.add_coupling(state.q, entries);
    Eigen::SparseMatrix<double> coupling(n, n);
    coupling.setFromTriplets(entries.begin(), entries.end());
    const Eigen::MatrixXd scaled = mechanism.scale.asDiagonal() * z;
    return symmetric_part(deformation_stiffness(mechanism, state, z)) -
           scaled.transpose() * (coupling * scaled);
  };
  const Eigen::MatrixXd elastic = stiffness(unloaded);
  if (!is_positive_definite(elastic)) return none;
  // −ΔK φ = μ K₀ φ, s = 1/μ
  const Eigen::MatrixXd change = (elastic - stiffness(loaded)) / share;
  const double largest = symmetric_eigenvalues(change, elastic).maxCoeff();
  return largest > 0.0 ? 1.0 / largest : none;
}

}  // namespace pleuel
