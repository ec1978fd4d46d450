#include "core/integration/sparse_products.hpp"

#include <algorithm>
#include <cassert>

namespace pleuel {

namespace {

/// Some columns side by side; a vector where it is one.
template <int width>
using RowGroup =
    Eigen::Matrix<double, Eigen::Dynamic, width, width == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

/// Columns in groups of `width`.
template <int width>
void add_groups(const System::Matrix& a, const Eigen::MatrixXd& x, const System::Matrix& b,
                const Eigen::MatrixXd& y, Eigen::MatrixXd& out) {
  using Group = RowGroup<width>;
  thread_local Group packed_x, packed_y, sum;
  const Eigen::Index n = x.rows();
  packed_x.resize(n, width);
  packed_y.resize(n, width);
  for (Eigen::Index first = 0; first < out.cols(); first += width) {
    const Eigen::Index count = std::min<Eigen::Index>(width, out.cols() - first);
    packed_x.leftCols(count) = x.middleCols(first, count);
    packed_y.leftCols(count) = y.middleCols(first, count);
    packed_x.rightCols(width - count).setZero();
    packed_y.rightCols(width - count).setZero();
    sum.setZero(out.rows(), width);
    for (Eigen::Index col = 0; col < n; ++col) {
      const auto of_x = packed_x.row(col), of_y = packed_y.row(col);
      for (int k = a.outerIndexPtr()[col]; k < a.outerIndexPtr()[col + 1]; ++k) {
        sum.row(a.innerIndexPtr()[k]) += a.valuePtr()[k] * of_x + b.valuePtr()[k] * of_y;
      }
    }
    out.middleCols(first, count) += sum.leftCols(count);
  }
}

template <int width>
void add_transposed_groups(const System::Matrix& a, const System::Matrix& b,
                           const Eigen::MatrixXd& y, Columns of_a, Columns of_b) {
  using Group = RowGroup<width>;
  using Row = Eigen::Matrix<double, 1, width>;
  thread_local Group packed;
  packed.resize(y.rows(), width);
  for (Eigen::Index first = 0; first < y.cols(); first += width) {
    const Eigen::Index count = std::min<Eigen::Index>(width, y.cols() - first);
    packed.leftCols(count) = y.middleCols(first, count);
    packed.rightCols(width - count).setZero();
    for (Eigen::Index col = 0; col < of_a.rows(); ++col) {
      Row sum_a = Row::Zero(), sum_b = Row::Zero();
      for (int k = a.outerIndexPtr()[col]; k < a.outerIndexPtr()[col + 1]; ++k) {
        const auto of_y = packed.row(a.innerIndexPtr()[k]);
        sum_a += a.valuePtr()[k] * of_y;
        sum_b += b.valuePtr()[k] * of_y;
      }
      for (Eigen::Index i = 0; i < count; ++i) {
        of_a(col, first + i) += sum_a(i);
        of_b(col, first + i) += sum_b(i);
      }
    }
  }
}

}  // namespace

void add_products(const System::Matrix& a, const Eigen::MatrixXd& x, const System::Matrix& b,
                  const Eigen::MatrixXd& y, Eigen::MatrixXd& out) {
  assert(a.nonZeros() == b.nonZeros() && x.rows() == y.rows() && x.cols() == out.cols());
  if (out.cols() <= 4) {
    add_groups<4>(a, x, b, y, out);
  } else {
    add_groups<8>(a, x, b, y, out);
  }
}

void add_transposed_products(const System::Matrix& a, const System::Matrix& b,
                             const Eigen::MatrixXd& y, Columns of_a, Columns of_b) {
  assert(a.nonZeros() == b.nonZeros() && of_a.rows() == of_b.rows() && y.cols() == of_a.cols());
  if (y.cols() == 1) {
    add_transposed_groups<1>(a, b, y, of_a, of_b);
  } else if (y.cols() <= 4) {
    add_transposed_groups<4>(a, b, y, of_a, of_b);
  } else {
    add_transposed_groups<8>(a, b, y, of_a, of_b);
  }
}

}  // namespace pleuel
