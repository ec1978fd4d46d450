#include "reduction/interface.hpp"

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/base/skew.hpp"

namespace pleuel {

Eigen::MatrixXd rigid_rows(const InterfaceSet& set, const Eigen::Matrix3Xd& positions) {
  Eigen::MatrixXd rows(3 * int_size(set.nodes), 6);
  for (int i = 0; i < int_size(set.nodes); ++i) {
    const Eigen::Vector3d arm = set.at - positions.col(set.nodes[i]);
    rows.block<3, 3>(3 * i, 0).setIdentity();
    rows.block<3, 3>(3 * i, 3) = skew(arm);
  }
  return rows;
}

Eigen::MatrixXd mean_rows(const InterfaceSet& set, const Eigen::Matrix3Xd& positions) {
  const Eigen::MatrixXd rigid = rigid_rows(set, positions);
  const PivotedQr columns(rigid, 1e-9);
  if (columns.rank() < 6) {
    throw InputError(
        fmt::format("the {} nodes of \"{}\" are on one line: they have no mean "
                    "rotation; choose more nodes",
                    set.nodes.size(), set.name));
  }
  return Cholesky(rigid.transpose() * rigid).solve(rigid.transpose());
}

Eigen::MatrixXd mean_motion(const InterfaceSet& set, const Eigen::Matrix3Xd& positions,
                            const Eigen::MatrixXd& shape) {
  const Eigen::MatrixXd rows = mean_rows(set, positions);
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(6, shape.cols());
  for (int i = 0; i < int_size(set.nodes); ++i) {
    motion += rows.middleCols<3>(3 * i) * shape.middleRows<3>(3 * set.nodes[i]);
  }
  return motion;
}

Eigen::Vector3d centroid_of(const std::vector<int>& nodes, const Eigen::Matrix3Xd& positions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int node : nodes) sum += positions.col(node);
  return sum / double(nodes.size());
}

}  // namespace pleuel
