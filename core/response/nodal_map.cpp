#include "core/response/nodal_map.hpp"

namespace pleuel {

using Eigen::MatrixXd;

MatrixXd NodalMap::scatter(int element, const MatrixXd& columns) const {
  MatrixXd nodal = MatrixXd::Zero(columns.rows(), nodal_size());
  for (int i = 0; i < 12; ++i) {
    const int index = body_.coordinates->index(element + i / 6, i % 6);
    if (index >= 0) nodal.col(index) += columns.col(i);
  }
  return nodal;
}

MatrixXd NodalMap::reduce(const MatrixXd& rows) const {
  return body_.basis ? MatrixXd(rows * *body_.basis) : rows;
}

MatrixXd NodalMap::reduce_derivative(const MatrixXd& rows, const MatrixXd& rows_x,
                                     std::size_t k) const {
  if (!body_.basis) return rows_x;
  return rows_x * *body_.basis + rows * body_.basis_x[k].data;
}

}  // namespace pleuel
