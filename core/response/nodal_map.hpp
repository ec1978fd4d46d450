#pragma once

#include "core/model/model.hpp"

namespace pleuel {

/// From rows that act on nodal coordinates of a beam to rows that act on the elastic coordinates of
/// its body: the same, or those of its basis. The body must outlive it.
class NodalMap {
 public:
  explicit NodalMap(const BodyModel& body) : body_(body) {}

  int nodal_size() const { return body_.coordinates->size(); }

  /// Puts columns of the twelve coordinates of an element where they belong.
  Eigen::MatrixXd scatter(int element, const Eigen::MatrixXd& columns) const;

  Eigen::MatrixXd reduce(const Eigen::MatrixXd& rows) const;

  /// @param k  of the basis: in the order of BodyModel::basis_x
  Eigen::MatrixXd reduce_derivative(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& rows_x,
                                    std::size_t k) const;

 private:
  const BodyModel& body_;
};

}  // namespace pleuel
