#pragma once

#include <cstddef>

#include "core/system/system.hpp"

namespace pleuel {

/// out += A x + B y for two matrices of one pattern (their first x.rows() columns) and several
/// columns x, y. Columns are taken in groups that fill the vector registers, so that the matrices
/// are read once a group.
void add_products(const System::Matrix& a, const Eigen::MatrixXd& x, const System::Matrix& b,
                  const Eigen::MatrixXd& y, Eigen::MatrixXd& out);

/// of_a += Aᵀ y and of_b += Bᵀ y, likewise (the first of_a.rows() columns of the matrices).
void add_transposed_products(const System::Matrix& a, const System::Matrix& b,
                             const Eigen::MatrixXd& y, Columns of_a, Columns of_b);

/// Calls visit(k, row, column) for all entries of a pattern; k counts its values.
template <class Visit>
void for_each_entry(const System::Matrix& matrix, Visit visit) {
  for (int col = 0; col < matrix.cols(); ++col) {
    for (int k = matrix.outerIndexPtr()[col]; k < matrix.outerIndexPtr()[col + 1]; ++k) {
      visit(k, matrix.innerIndexPtr()[k], col);
    }
  }
}

}  // namespace pleuel
