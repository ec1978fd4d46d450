#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "core/base/eager_matrices.hpp"
#include "tests/core/section/section_references.hpp"

namespace pleuel::test {
namespace {

/// Numbers of the unknowns: −1 where φ = 0, one for all nodes of the hole.
Eigen::MatrixXi number_nodes(Eigen::Index rows, Eigen::Index columns, const auto& fill_of_cell) {
  Eigen::MatrixXi number = Eigen::MatrixXi::Constant(rows, columns, 1);
  number.row(rows - 1).setConstant(-1);
  number.col(columns - 1).setConstant(-1);
  for (Eigen::Index i = 0; i + 1 < rows; ++i) {
    for (Eigen::Index j = 0; j + 1 < columns; ++j) {
      const Fill fill = fill_of_cell(i, j);
      if (fill == Fill::nothing) number.block<2, 2>(i, j).setConstant(-1);
      if (fill == Fill::hole) number.block<2, 2>(i, j).setZero();
    }
  }
  int next = 1;
  for (Eigen::Index k = 0; k < number.size(); ++k) {
    if (number(k) > 0) number(k) = next++;
  }
  return number;
}

/// ∫∇N∇Nᵀ of a bilinear rectangle with nodes (0,0), (1,0), (0,1), (1,1).
Eigen::Matrix4d element_stiffness(double a, double b) {
  Eigen::Matrix2d stretch, mass;
  stretch << 1, -1, -1, 1;
  mass << 2, 1, 1, 2;
  Eigen::Matrix4d stiffness;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      stiffness(i, j) = stretch(i % 2, j % 2) / a * mass(i / 2, j / 2) * b / 6 +
                        stretch(i / 2, j / 2) / b * mass(i % 2, j % 2) * a / 6;
    }
  }
  return stiffness;
}

}  // namespace

SaintVenant::SaintVenant(std::vector<double> y, std::vector<double> z,
                         const std::function<Fill(double, double)>& fill)
    : y_(std::move(y)), z_(std::move(z)) {
  const auto rows = static_cast<Eigen::Index>(y_.size());
  const auto columns = static_cast<Eigen::Index>(z_.size());
  const auto at = [](const std::vector<double>& lines, Eigen::Index i) { return lines[i]; };
  const auto fill_of_cell = [&](Eigen::Index i, Eigen::Index j) {
    return fill((at(y_, i) + at(y_, i + 1)) / 2, (at(z_, j) + at(z_, j + 1)) / 2);
  };
  const Eigen::MatrixXi number = number_nodes(rows, columns, fill_of_cell);
  const int size = number.maxCoeff() + 1;
  std::vector<Eigen::Triplet<double>> entries = {{0, 0, 1e-30}};  // there may be no hole
  Eigen::VectorXd load = Eigen::VectorXd::Zero(size);
  for (Eigen::Index i = 0; i + 1 < rows; ++i) {
    for (Eigen::Index j = 0; j + 1 < columns; ++j) {
      if (fill_of_cell(i, j) == Fill::nothing) continue;
      const double a = at(y_, i + 1) - at(y_, i), b = at(z_, j + 1) - at(z_, j);
      const Eigen::Matrix4d stiffness = element_stiffness(a, b);
      for (int k = 0; k < 4; ++k) {
        const int row = number(i + k % 2, j + k / 2);
        if (row < 0) continue;
        load(row) += 2 * a * b / 4;
        for (int l = 0; l < 4; ++l) {
          const int column = number(i + l % 2, j + l / 2);
          if (column >= 0) entries.emplace_back(row, column, stiffness(k, l));
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  assert(solver.info() == Eigen::Success);
  const Eigen::VectorXd solution = solver.solve(load);
  constant_ = 4 * load.dot(solution);
  phi_ = Eigen::MatrixXd::Zero(rows, columns);
  for (Eigen::Index k = 0; k < number.size(); ++k) {
    if (number(k) >= 0) phi_(k) = solution(number(k));
  }
}

double SaintVenant::shear_at_top(double z) const {
  const Eigen::Index j = nearest(z_, z), i = phi_.rows() - 1;
  const double step = y_.back() - y_[y_.size() - 2];
  return (4 * phi_(i - 1, j) - phi_(i - 2, j)) / (2 * step) / constant_;
}

double SaintVenant::shear_at_side(double y) const {
  const Eigen::Index i = nearest(y_, y), j = phi_.cols() - 1;
  const double step = z_.back() - z_[z_.size() - 2];
  return (4 * phi_(i, j - 1) - phi_(i, j - 2)) / (2 * step) / constant_;
}

Eigen::Index SaintVenant::nearest(const std::vector<double>& lines, double place) {
  const auto distance = [place](double a, double b) {
    return std::abs(a - place) < std::abs(b - place);
  };
  return std::min_element(lines.begin(), lines.end(), distance) - lines.begin();
}

std::vector<double> grid_lines(const std::vector<GridStretch>& stretches) {
  std::vector<double> lines = {0.0};
  for (const auto& [end, cells] : stretches) {
    const double start = lines.back();
    for (int i = 1; i <= cells; ++i) lines.push_back(start + (end - start) * i / cells);
  }
  return lines;
}

double extrapolated(double coarse, double middle, double fine) {
  const double ratio = (fine - middle) / (middle - coarse);
  return fine + (fine - middle) * ratio / (1 - ratio);
}

}  // namespace pleuel::test
