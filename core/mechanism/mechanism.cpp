#include "core/mechanism/mechanism.hpp"

#include <cassert>

#include "core/base/rotation_vector.hpp"

namespace pleuel {

void advance(const Rotations& rotations, const Eigen::VectorXd& start,
             const Eigen::VectorXd& increment, Eigen::VectorXd& q) {
  assert(&q != &start);
  q = start + increment;
  for (int i : rotations) {
    q.segment<3>(i) = compose(start.segment<3>(i), increment.segment<3>(i));
  }
}

Eigen::VectorXd difference(const Rotations& rotations, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& start) {
  Eigen::VectorXd result = q - start;
  for (int i : rotations) {
    result.segment<3>(i) = compose(-start.segment<3>(i), q.segment<3>(i));
  }
  return result;
}

void add_increment_tangent(const Rotations& rotations, const Eigen::VectorXd& increment,
                           const System::Matrix& R_q, double q_weight, System::Matrix& matrix) {
  for (int i : rotations) {
    const Eigen::Vector3d delta = increment.segment<3>(i);
    const Eigen::Matrix3d change =
        q_weight * (tangent_operator(delta) - Eigen::Matrix3d::Identity());
    // The three columns of a rotation have one pattern: terms couple frames as a whole.
    const int* starts = matrix.outerIndexPtr();
    const int count = starts[i + 1] - starts[i];
    assert(starts[i + 2] - starts[i + 1] == count && starts[i + 3] - starts[i + 2] == count);
    for (int k = 0; k < count; ++k) {
      Eigen::RowVector3d row;
      for (int c = 0; c < 3; ++c) row(c) = R_q.valuePtr()[starts[i + c] + k];
      const Eigen::RowVector3d added = row * change;
      for (int c = 0; c < 3; ++c) matrix.valuePtr()[starts[i + c] + k] += added(c);
    }
  }
}

void pull_back(const Rotations& rotations, const Eigen::VectorXd& increment, Eigen::MatrixXd& s) {
  for (int i : rotations) {
    const Eigen::Vector3d delta = increment.segment<3>(i);
    s.middleRows<3>(i) = (inverse_tangent_operator(delta).transpose() * s.middleRows<3>(i)).eval();
  }
}

void push_forward(const Rotations& rotations, const Eigen::VectorXd& increment,
                  Eigen::MatrixXd& s) {
  for (int i : rotations) {
    const Eigen::Vector3d delta = increment.segment<3>(i);
    s.middleRows<3>(i) = (tangent_operator(delta) * s.middleRows<3>(i)).eval();
  }
}

void pull_back_transposed(const Rotations& rotations, const Eigen::VectorXd& increment, Columns s) {
  for (int i : rotations) {
    const Eigen::Vector3d delta = increment.segment<3>(i);
    s.middleRows<3>(i) = (inverse_tangent_operator(delta) * s.middleRows<3>(i)).eval();
  }
}

void push_forward_transposed(const Rotations& rotations, const Eigen::VectorXd& increment,
                             Columns s) {
  for (int i : rotations) {
    const Eigen::Vector3d delta = increment.segment<3>(i);
    s.middleRows<3>(i) = (tangent_operator(delta).transpose() * s.middleRows<3>(i)).eval();
  }
}

}  // namespace pleuel
