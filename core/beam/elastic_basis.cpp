#include "core/beam/elastic_basis.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Relative distance below which two eigenvalues are one.
constexpr double cluster_gap = 1e-6;

std::vector<int> interior_of(Eigen::Index size, const std::vector<int>& boundary) {
  std::vector<int> interior;
  for (int i = 0; i < static_cast<int>(size); ++i) {
    if (!std::ranges::binary_search(boundary, i)) interior.push_back(i);
  }
  return interior;
}

/// All modes of a family, mass-normalised, λ ascending.
NaturalModes modes_of(const NodalMatrices& matrices, const std::vector<int>& family) {
  return natural_modes(matrices.stiffness(family, family), matrices.mass(family, family));
}

/// Change of the span of the first modes: only towards the modes that are left out,
///     dφᵢ = Σ_{j left out} φⱼ φⱼᵀ (dK − λᵢ dM) φᵢ / (λᵢ − λⱼ)
MatrixXd differentiate_modes(const MatrixXd& modes, const VectorXd& lambda, Eigen::Index kept,
                             const MatrixXd& d_mass, const MatrixXd& d_stiffness) {
  const Eigen::Index left_out = modes.cols() - kept;
  const MatrixXd outer = modes.rightCols(left_out), inner = modes.leftCols(kept);
  MatrixXd shares = outer.transpose() * d_stiffness * inner -
                    outer.transpose() * d_mass * inner * lambda.head(kept).asDiagonal();
  for (Eigen::Index i = 0; i < kept; ++i) {
    for (Eigen::Index j = 0; j < left_out; ++j) shares(j, i) /= lambda(i) - lambda(kept + j);
  }
  return outer * shares;
}

/// Writes the kept modes of a family, and their derivatives, from column `first` on.
void add_modes(const NodalMatrices& matrices, const std::vector<NodalMatrices>& derivatives,
               const ModeFamily& family, Eigen::Index first, BasisWithDerivatives& result) {
  if (family.modes == 0) return;
  const std::vector<int>& rows = family.coordinates;
  const NaturalModes solved = modes_of(matrices, rows);
  const Eigen::Index modes = family.modes;
  const auto columns = Eigen::seqN(first, modes);
  const VectorXd scale =
      solved.shapes.leftCols(modes).cwiseAbs().colwise().maxCoeff().cwiseInverse();
  result.basis(rows, columns) = solved.shapes.leftCols(modes) * scale.asDiagonal();
  for (std::size_t k = 0; k < derivatives.size(); ++k) {
    const NodalMatrices& d = derivatives[k];
    result.derivatives[k](rows, columns) =
        differentiate_modes(solved.shapes, solved.lambda, modes, MatrixXd(d.mass(rows, rows)),
                            MatrixXd(d.stiffness(rows, rows))) *
        scale.asDiagonal();
  }
}

}  // namespace

BasisWithDerivatives craig_bampton_basis(const NodalMatrices& matrices,
                                         const std::vector<NodalMatrices>& derivatives,
                                         const KeptCoordinates& kept) {
  const std::vector<int>& b = kept.boundary;
  const std::vector<int> i = interior_of(matrices.mass.rows(), b);
  const Eigen::Index boundary = b.size();
  Eigen::Index size = boundary;
  for (const ModeFamily& family : kept.families) size += family.modes;
  const Cholesky factors(matrices.stiffness(i, i));
  const MatrixXd constraint = -factors.solve(MatrixXd(matrices.stiffness(i, b)));
  BasisWithDerivatives result;
  result.basis.setZero(matrices.mass.rows(), size);
  for (Eigen::Index k = 0; k < boundary; ++k) result.basis(b[k], k) = 1.0;
  result.basis(i, Eigen::seqN(0, boundary)) = constraint;
  for (const NodalMatrices& d : derivatives) {
    MatrixXd change = MatrixXd::Zero(result.basis.rows(), result.basis.cols());
    change(i, Eigen::seqN(0, boundary)) = -factors.solve(
        MatrixXd(MatrixXd(d.stiffness(i, b)) + MatrixXd(d.stiffness(i, i)) * constraint));
    result.derivatives.push_back(std::move(change));
  }
  Eigen::Index first = boundary;
  for (const ModeFamily& family : kept.families) {
    add_modes(matrices, derivatives, family, first, result);
    first += family.modes;
  }
  return result;
}

int complete_modes(const NodalMatrices& matrices, const std::vector<int>& family, int modes) {
  const int all = int_size(family);
  if (modes <= 0 || modes >= all) return std::clamp(modes, 0, all);
  const VectorXd lambda = modes_of(matrices, family).lambda;
  while (modes < all && lambda(modes) - lambda(modes - 1) < cluster_gap * lambda(modes)) ++modes;
  return modes;
}

int count_fixed_interface_modes(const NodalMatrices& matrices, const std::vector<int>& family,
                                double frequency) {
  if (family.empty()) return 0;
  const VectorXd lambda = modes_of(matrices, family).lambda;
  const auto below = (lambda.array() < frequency * frequency).count();
  return complete_modes(matrices, family, static_cast<int>(below));
}

BasisWithDerivatives mean_axis_basis(const NodalMatrices& matrices,
                                     const std::vector<NodalMatrices>& derivatives,
                                     const BasisWithDerivatives& deformations,
                                     const std::vector<int>& active) {
  const auto all = Eigen::all;
  const MatrixXd c = matrices.momentum(active, all), r = matrices.rigid(all, active);
  const MatrixXd& d = deformations.basis;
  const DenseLu inertia(c * r);
  const MatrixXd motion = inertia.solve(c * d);
  BasisWithDerivatives result;
  result.basis = d - r * motion;
  for (std::size_t k = 0; k < derivatives.size(); ++k) {
    const MatrixXd dc = derivatives[k].momentum(active, all),
                   dr = derivatives[k].rigid(all, active);
    const MatrixXd& dd = deformations.derivatives[k];
    const MatrixXd d_motion = inertia.solve(dc * d + c * dd - (dc * r + c * dr) * motion);
    result.derivatives.push_back(dd - dr * motion - r * d_motion);
  }
  return result;
}

MatrixXd dense_matrix(const ElasticPattern& pattern, const VectorXd& entries) {
  MatrixXd matrix = MatrixXd::Zero(pattern.size, pattern.size);
  for (int row = 0; row < pattern.size; ++row) {
    for (int i = pattern.row_start[row]; i < pattern.row_start[static_cast<std::size_t>(row) + 1];
         ++i) {
      matrix(row, pattern.column[i]) = entries(i);
    }
  }
  return matrix;
}

namespace {

ElasticPattern dense_pattern(Eigen::Index size) {
  std::vector<int> all(size);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return pattern_of_groups(static_cast<int>(size), {all});
}

/// Row-major entries of a full matrix.
VectorXd entries_of(const MatrixXd& matrix) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
  return Eigen::Map<const VectorXd>(rows.data(), rows.size());
}

/// Applies a bilinear rule to each matrix of the invariants.
template <class Linear, class Bilinear>
Invariants<double> transform(const Invariants<double>& nodal, Eigen::Index size,
                             const Linear& linear, const Bilinear& bilinear) {
  Invariants<double> result;
  result.pattern = dense_pattern(size);
  result.pairs = nodal.pairs;
  result.shape = linear(&Invariants<double>::shape);
  result.mixed = linear(&Invariants<double>::mixed);
  const auto matrix = [&](auto entries) { return entries_of(bilinear(entries)); };
  result.moments.resize(result.pattern.nonzeros(), int_size(nodal.pairs));
  for (std::size_t p = 0; p < nodal.pairs.size(); ++p) {
    result.moments.col(p) =
        matrix([p](const Invariants<double>& i) { return VectorXd(i.moments.col(p)); });
  }
  result.mass_matrix = matrix([](const Invariants<double>& i) { return i.mass_matrix; });
  result.stiffness = matrix([](const Invariants<double>& i) { return i.stiffness; });
  result.damping = matrix([](const Invariants<double>& i) { return i.damping; });
  return result;
}

}  // namespace

Invariants<double> project_invariants(const Invariants<double>& nodal, const MatrixXd& z) {
  Invariants<double> result = transform(
      nodal, z.cols(), [&](auto member) { return MatrixXd(nodal.*member * z); },
      [&](auto entries) {
        return MatrixXd(z.transpose() * dense_matrix(nodal.pattern, entries(nodal)) * z);
      });
  result.mass = nodal.mass;
  result.first_moment = nodal.first_moment;
  result.second_moment = nodal.second_moment;
  return result;
}

Invariants<double> project_derivative(const Invariants<double>& nodal,
                                      const Invariants<double>& nodal_derivative, const MatrixXd& z,
                                      const MatrixXd& dz) {
  Invariants<double> result = transform(
      nodal, z.cols(),
      [&](auto member) { return MatrixXd(nodal_derivative.*member * z + nodal.*member * dz); },
      [&](auto entries) {
        const MatrixXd value = dense_matrix(nodal.pattern, entries(nodal));
        const MatrixXd change = dense_matrix(nodal.pattern, entries(nodal_derivative));
        return MatrixXd(z.transpose() * change * z + dz.transpose() * value * z +
                        z.transpose() * value * dz);
      });
  result.mass = nodal_derivative.mass;
  result.first_moment = nodal_derivative.first_moment;
  result.second_moment = nodal_derivative.second_moment;
  return result;
}

ModalDamping modal_damping(const DampedMatrices& matrices,
                           const std::vector<DampedMatrices>& derivatives) {
  // In mass-normalised modes D̂ = 2ζ Ω; with X = (M⁻¹K)^½ differentiating X X = M⁻¹ K gives
  //     (dX̂)ᵢⱼ (ωᵢ + ωⱼ) = (k̂ − m̂ Ω²)ᵢⱼ,   dD̂ = 2 dζ Ω + 2ζ (m̂ Ω + dX̂),
  // k̂ = Φᵀ dK Φ, m̂ = Φᵀ dM Φ, and D = M Φ D̂ Φᵀ M.
  const NaturalModes modes = natural_modes(matrices.stiffness, matrices.mass);
  const VectorXd omega = modes.lambda.cwiseMax(0.0).cwiseSqrt();
  const MatrixXd& phi = modes.shapes;
  const MatrixXd back = matrices.mass * phi;  // Φ⁻ᵀ
  ModalDamping result;
  result.damping = back * (2.0 * matrices.ratio * omega).asDiagonal() * back.transpose();
  for (const DampedMatrices& d : derivatives) {
    const MatrixXd k = phi.transpose() * d.stiffness * phi, m = phi.transpose() * d.mass * phi;
    MatrixXd x = k - m * omega.cwiseAbs2().asDiagonal();
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      for (Eigen::Index j = 0; j < x.cols(); ++j) x(i, j) /= omega(i) + omega(j);
    }
    MatrixXd hat = 2.0 * matrices.ratio * (m * omega.asDiagonal() + x);
    hat.diagonal() += 2.0 * d.ratio * omega;
    result.derivatives.push_back(back * hat * back.transpose());
  }
  return result;
}

MatrixXd rigid_displacements(const ElasticCoordinates& coordinates, const std::vector<double>& x,
                             double translation) {
  MatrixXd rigid = MatrixXd::Zero(coordinates.size(), 6);
  for (int node = 0; node < coordinates.node_count(); ++node) {
    const auto set = [&](int displacement, int motion, double value) {
      const int row = coordinates.index(node, displacement);
      if (row >= 0) rigid(row, motion) = value;
    };
    for (int i = 0; i < 6; ++i) set(i, i, translation);
    const double place = x[node];
    set(1, 5, place);   // about z: v = x
    set(2, 4, -place);  // about y: w = −x
  }
  return rigid;
}

NaturalModes natural_modes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  SymmetricModes modes = symmetric_modes(stiffness, mass);
  return {std::move(modes.values), std::move(modes.vectors)};
}

}  // namespace pleuel
