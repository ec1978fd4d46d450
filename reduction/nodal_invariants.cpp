#include "reduction/nodal_invariants.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

/// M_s, nodes × nodes.
SolidMatrix scalar_mass(const SolidMatrix& mass) {
  Entries entries;
  double largest = 0.0, off = 0.0;
  for (int column = 0; column < mass.outerSize(); ++column) {
    for (SolidMatrix::InnerIterator entry(mass, column); entry; ++entry) {
      const int row = static_cast<int>(entry.row()), direction = column % 3;
      largest = std::max(largest, std::abs(entry.value()));
      if (row % 3 != direction) {
        off = std::max(off, std::abs(entry.value()));
        continue;
      }
      if (direction == 0) entries.emplace_back(row / 3, column / 3, entry.value());
      const double first = mass.coeff(row - direction, column - direction);
      off = std::max(off, std::abs(entry.value() - first));
    }
  }
  if (off > 1e-9 * largest) {
    throw InputError(fmt::format(
        "the mass matrix must be the same in x, y and z, as that of solid elements is, but entries "
        "differ by {:.1e} of the largest one: take out shells, beams, mass elements and local axes",
        off / largest));
  }
  SolidMatrix scalar(mass.rows() / 3, mass.cols() / 3);
  scalar.setFromTriplets(entries.begin(), entries.end());
  return scalar;
}

/// Rows of one direction.
Eigen::MatrixXd rows_of(const Eigen::MatrixXd& shape, int direction) {
  return shape(Eigen::seq(direction, Eigen::last, Eigen::fix<3>), Eigen::all);
}

Eigen::MatrixXd symmetric_part(const Eigen::MatrixXd& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

}  // namespace

SparseMatrix sparse_of(const Eigen::MatrixXd& matrix) {
  return matrix.sparseView(matrix.size() == 0 ? 0.0 : matrix.cwiseAbs().maxCoeff(), 1e-15);
}

BodyConstants nodal_invariants(const SolidMatrices& matrices, const Eigen::Matrix3Xd& positions,
                               const Eigen::MatrixXd& shape) {
  const SolidMatrix mass = scalar_mass(matrices.mass);
  const Eigen::MatrixXd x = positions.transpose();
  const Eigen::MatrixXd mx = mass * x;
  const Eigen::VectorXd m = mass * Eigen::VectorXd::Ones(mass.rows());
  std::array<Eigen::MatrixXd, 3> psi, m_psi;
  Eigen::MatrixXd mean(3, shape.cols()), mixed(9, shape.cols());
  for (int k = 0; k < 3; ++k) {
    psi[k] = rows_of(shape, k);
    m_psi[k] = mass * psi[k];
    mean.row(k) = m.transpose() * psi[k];
  }
  for (int row = 0; row < 9; ++row) mixed.row(row) = mx.col(row / 3).transpose() * psi[row % 3];
  BodyConstants constants;
  constants.mass = m.sum();
  constants.first_moment = x.transpose() * m;
  constants.second_moment = symmetric_part(x.transpose() * mx);
  constants.shape = sparse_of(mean);
  constants.mixed = sparse_of(mixed);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(shape.cols(), shape.cols());
  for (std::size_t i = 0; i < moment_pairs.size(); ++i) {
    const auto [k, l] = moment_pairs[i];
    const Eigen::MatrixXd moment = psi[k].transpose() * m_psi[l];
    if (k == l) sum += symmetric_part(moment);
    constants.moments[i] = sparse_of(k == l ? symmetric_part(moment) : moment);
  }
  constants.mass_matrix = sparse_of(sum);
  const Eigen::MatrixXd k_psi = matrices.stiffness * shape;
  constants.stiffness = sparse_of(symmetric_part(shape.transpose() * k_psi));
  constants.damping.resize(shape.cols(), shape.cols());
  return constants;
}

namespace {

/// What is left of a vector that has nothing new, relative.
constexpr double nothing_new = 1e-8;

/// Without its parts in the columns before it, and with the mean square 1. Twice is enough (Parlett, The
/// Symmetric Eigenvalue Problem, §6.9).
void make_orthogonal(Eigen::MatrixXd& vectors, Eigen::Index column) {
  Eigen::VectorXd x = vectors.col(column);
  const double size = std::sqrt(double(x.size())), before = x.norm();
  const auto others = vectors.leftCols(column);
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::VectorXd parts = others.transpose() * x / (size * size);
    x -= others * parts;
  }
  if (!(x.norm() > nothing_new * before)) {
    throw InputError(
        "/modes/inertia_responses has a generation that says nothing new; ask for fewer");
  }
  vectors.col(column) = x * (size / x.norm());
}

}  // namespace

LowestModes inertia_responses(const StaticSolution& solve, const SolidMatrix& stiffness,
                              const SolidMatrix& mass, const Eigen::MatrixXd& rigid,
                              int generations) {
  const Eigen::Index each = rigid.cols();
  LowestModes found;
  found.shapes.resize(rigid.rows(), generations * each);
  Eigen::MatrixXd last = rigid;
  for (int g = 0; g < generations; ++g) {
    last = solve(mass * last);
    found.shapes.middleCols(g * each, each) = last;
    for (Eigen::Index i = g * each; i < (g + 1) * each; ++i) {
      make_orthogonal(found.shapes, i);
    }
    last = found.shapes.middleCols(g * each, each);
  }
  found.squares = (found.shapes.transpose() * (stiffness * found.shapes)).diagonal();
  const Eigen::VectorXd inertia = (found.shapes.transpose() * (mass * found.shapes)).diagonal();
  found.squares = found.squares.cwiseQuotient(inertia);
  return found;
}

}  // namespace pleuel
