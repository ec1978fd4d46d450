#include "core/integration/sparse_products.hpp"

#include <algorithm>
#include <cassert>

namespace pleuel {

namespace {

/// Columns in groups of `width`.
template <int width>
void add_groups(const System::Matrix& a, const Eigen::MatrixXd& x, const System::Matrix& b,
                const Eigen::MatrixXd& y, Eigen::MatrixXd& out) {
  using Group = Eigen::Matrix<double, Eigen::Dynamic, width, Eigen::RowMajor>;
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

}  // namespace pleuel
