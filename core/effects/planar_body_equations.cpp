#include "core/effects/planar_body_equations.hpp"

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

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using Row = PlanarProducts::Row;

}  // namespace

PlanarBodyEquations::PlanarBodyEquations(const BodyFrame& frame,
                                         const Invariants<double>& invariants)
    : frame_(frame), body_(frame, invariants), matrices_(body_.matrices()) {}

void PlanarBodyEquations::evaluate(const BodyMotion& motion) {
  basis_ = motion.frame.A.transpose() * frame_.basis;
  body_.evaluate(motion, motion, products_);
}

void PlanarBodyEquations::add_forces(const BodyMotion&, Eigen::VectorXd& residual) const {
  const int k = frame_.translations(), first = frame_.offset;
  for (int i = 0; i < k; ++i) residual(first + i) += basis_.col(i).dot(products_.force);
  residual(first + k) += products_.moment;
  residual.segment(first + k + 1, body_.size()) += products_.elastic_forces;
}

void PlanarDerivativeForces::set_forces(const BodyMotion& motion, const ElasticMotion& elastic,
                                        Eigen::VectorXd& forces) {
  derivative_.evaluate(motion, elastic, products_);
  const int k = frame_.translations();
  forces.resize(k + 1 + derivative_.size());
  forces.head(k) = frame_.basis.transpose() * (motion.frame.A * products_.force);
  forces(k) = products_.moment;
  forces.tail(derivative_.size()) = products_.elastic_forces;
}

void PlanarBodyEquations::write_tangent(const BodyMotion& motion, const Weights& weights,
                                        double* entries) {
  const int m = frame_.size();
  write_frame_block(motion, weights, entries);
  if (body_.size() == 0) return;
  if (m == 3) {
    write_coupling<6>(motion, weights, entries + m * m);
  } else {
    write_coupling<Eigen::Dynamic>(motion, weights, entries + m * m);
  }
  write_elastic_block(weights, entries + m * m + 2 * m * body_.size());
}

/// Through dω = w.v, dα = w.a, and a turn by w.q: in body axes, da₀ = −w.q n × a₀.
void PlanarBodyEquations::write_frame_block(const BodyMotion& motion, const Weights& weights,
                                            double* entries) const {
  const int k = frame_.translations(), m = frame_.size();
  const Vector3d& c = products_.c;
  const Vector3d lever = body_.normal().cross(c);
  const Vector3d d_a0 = -weights.q * body_.normal().cross(motion.a0);
  const Vector3d d_force =
      body_.mass() * d_a0 -
      2.0 * products_.omega * weights.v * (c - body_.normal().dot(c) * body_.normal()) +
      weights.a * lever + 2.0 * weights.v * body_.normal().cross(products_.shape_v) +
      weights.q * body_.normal().cross(products_.force);
  for (int i = 0; i < k; ++i) {
    for (int j = 0; j < k; ++j) {
      entries[i * m + j] = weights.a * body_.mass() * basis_.col(i).dot(basis_.col(j));
    }
    entries[i * m + k] = basis_.col(i).dot(d_force);
    entries[k * m + i] = weights.a * lever.dot(basis_.col(i));
  }
  entries[k * m + k] =
      lever.dot(d_a0) + weights.a * products_.inertia + 2.0 * weights.v * products_.g_C_v;
}

/// `Rows` is 2m where the compiler may know it.
template <int Rows>
void PlanarBodyEquations::write_coupling(const BodyMotion& motion, const Weights& weights,
                                         double* entries) const {
  const int k = frame_.translations(), m = k + 1;
  constexpr int most = Rows == Eigen::Dynamic ? 8 : Rows;
  using Column = Eigen::Matrix<double, Rows, 1, 0, most, 1>;
  // What multiplies S̄: rows of the frame, then columns.
  Eigen::Matrix<double, Rows, 3, 0, most, 3> of_shape(2 * m, 3);
  Matrix3d Q = weights.q * motion.X + weights.v * motion.Y;
  Q.diagonal().array() += weights.a;
  of_shape.topRows(k) = basis_.transpose() * Q;
  of_shape.row(k) = weights.q * motion.a0.cross(body_.normal()).transpose();
  of_shape.middleRows(m, k) = weights.a * basis_.transpose();
  of_shape.row(m + k) = of_shape.row(k);
  const double row_g_C = 2.0 * (products_.alpha * weights.q + products_.omega * weights.v);
  const double row_C_v = 2.0 * products_.omega * weights.q;
  const double column_g_C = -2.0 * products_.omega * weights.v, column_D_v = 2.0 * weights.v;
  for (Eigen::Index i = 0; i < body_.size(); ++i) {
    const double* product = products_.of_coordinates.col(i).data();
    const double* shape = body_.shape().data() + 3 * i;
    Column out =
        shape[0] * of_shape.col(0) + shape[1] * of_shape.col(1) + shape[2] * of_shape.col(2);
    const double of_g_D = weights.a * product[Row::g_D];
    out(k) += row_g_C * product[Row::g_C] + of_g_D + row_C_v * product[Row::C_v] -
              weights.q * product[Row::D_a];
    out(m + k) += column_g_C * product[Row::g_C] + of_g_D + column_D_v * product[Row::D_v];
    Eigen::Map<Column>(entries + 2 * m * i, 2 * m) = out;
  }
}

/// w.q (K − ω² C + α D) + w.v (D_f + 2ω D) + w.a S_ff on the pattern of the body.
void PlanarBodyEquations::write_elastic_block(const Weights& weights, double* entries) const {
  Eigen::Map<Eigen::VectorXd> block(entries, matrices_.rows());
  if (weights.q == 0.0 && weights.v == 0.0) {
    block = weights.a * matrices_.col(2);
    return;
  }
  // Of more than eight entries at most: Eigen then takes its product of a matrix and a vector, whose
  // rounding does not depend on how `entries` are aligned.
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 12, 1> factors(matrices_.cols());
  factors << weights.q, weights.v, weights.a, -products_.omega * products_.omega * weights.q,
      products_.alpha * weights.q + 2.0 * products_.omega * weights.v;
  block.noalias() = matrices_ * factors;
}

}  // namespace pleuel
