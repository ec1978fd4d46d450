#include "core/effects/planar_constants.hpp"

namespace pleuel {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using Row = PlanarProducts::Row;

/// Σ a_kl S_kl of each non-zero.
Eigen::RowVectorXd moment_sum(const Invariants<double>& body, const Matrix3d& a) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(body.pattern.nonzeros());
  for (std::size_t p = 0; p < body.pairs.size(); ++p) {
    sum += a(body.pairs[p].first, body.pairs[p].second) * body.moments.col(p).transpose();
  }
  return sum;
}

}  // namespace

PlanarConstants::PlanarConstants(const BodyFrame& frame, const Invariants<double>& invariants)
    : normal_(frame.reference.transpose() * frame.axis),
      mass_(invariants.mass),
      first_moment_(invariants.first_moment),
      shape_(invariants.shape),
      mixed_(2, invariants.size()),
      pattern_(invariants.pattern),
      entries_(8, invariants.pattern.nonzeros()) {
  const Matrix3d P = Matrix3d::Identity() - normal_ * normal_.transpose();
  const Matrix3d J = skew<double>(normal_);
  inertia_at_rest_ = P.cwiseProduct(invariants.second_moment).sum();
  if (size() == 0) return;
  // Σ a_kl H_lk: H_lk stands in row 3l + k.
  mixed_.row(0) = P.reshaped().transpose() * invariants.mixed;
  mixed_.row(1) = J.reshaped().transpose() * invariants.mixed;
  for (const Row row : {Row::g_C, Row::C_v}) entries_.row(row) = moment_sum(invariants, P);
  for (const Row row : {Row::g_D, Row::D_v, Row::D_a}) {
    entries_.row(row) = moment_sum(invariants, J);
  }
  entries_.row(Row::S_a) = invariants.mass_matrix.transpose();
  entries_.row(Row::K_q) = invariants.stiffness.transpose();
  entries_.row(Row::D_f_v) = invariants.damping.transpose();
}

Eigen::MatrixXd PlanarConstants::matrices() const {
  Eigen::MatrixXd matrices(entries_.cols(), 5);
  Eigen::Index column = 0;
  for (const Row row : {Row::K_q, Row::D_f_v, Row::S_a, Row::g_C, Row::g_D}) {
    matrices.col(column++) = entries_.row(row).transpose();
  }
  return matrices;
}

/// All products with the matrices of the body in one pass over their non-zeros.
void PlanarConstants::multiply(const ElasticMotion& elastic, PlanarProducts& out) const {
  out.rates.resize(8, size());
  out.of_coordinates.resize(8, size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double q = elastic.q(i), v = elastic.v(i), a = elastic.a(i);
    out.rates.col(i) << q, q, v, v, a, q, v, a;
  }
  for (int row = 0; row < pattern_.size; ++row) {
    Eigen::Array<double, 8, 1> sum = Eigen::Array<double, 8, 1>::Zero();
    for (int i = pattern_.row_start[row]; i < pattern_.row_start[row + 1]; ++i) {
      sum += entries_.col(i) * out.rates.col(pattern_.column[i]);
    }
    sum.head<2>() += mixed_.col(row).array();
    out.of_coordinates.col(row) = sum;
  }
}

void PlanarConstants::evaluate(const BodyMotion& motion, const ElasticMotion& elastic,
                               PlanarProducts& out) const {
  multiply(elastic, out);
  out.omega = normal_.dot(motion.frame.omega);
  out.alpha = normal_.dot(motion.frame.alpha);
  out.elastic_forces.resize(size());
  Vector3d c = first_moment_, shape_v = Vector3d::Zero(), shape_a = shape_v;
  double inertia = inertia_at_rest_, g_C_v = 0.0, g_D_a = 0.0;
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double* product = out.of_coordinates.col(i).data();
    const Vector3d shape = shape_.col(i);
    const double q = elastic.q(i), v = elastic.v(i), a = elastic.a(i);
    c += q * shape;
    shape_v += v * shape;
    shape_a += a * shape;
    inertia += q * (mixed_(0, i) + product[Row::g_C]);
    g_C_v += product[Row::g_C] * v;
    g_D_a += product[Row::g_D] * a;
    out.elastic_forces(i) = product[Row::S_a] + product[Row::K_q] + product[Row::D_f_v] +
                            shape.dot(motion.a0) - out.omega * out.omega * product[Row::g_C] +
                            out.alpha * product[Row::g_D] + 2.0 * out.omega * product[Row::D_v];
  }
  out.c = c;
  out.shape_v = shape_v;
  out.inertia = inertia;
  out.g_C_v = g_C_v;
  out.force = mass_ * motion.a0 + motion.X * c + motion.Y * shape_v + shape_a;
  out.moment =
      normal_.cross(c).dot(motion.a0) + out.alpha * inertia + 2.0 * out.omega * g_C_v + g_D_a;
}

}  // namespace pleuel
