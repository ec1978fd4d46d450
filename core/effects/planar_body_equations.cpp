#include "core/effects/planar_body_equations.hpp"

namespace pleuel {

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
