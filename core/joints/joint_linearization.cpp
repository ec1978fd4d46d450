#include "core/joints/joint_linearization.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

using Eigen::Matrix3d;
using Eigen::Vector3d;

JointLinearization::JointLinearization(const JointTopology& topology, const JointData<double>& data,
                                       double time, const double* q, int size)
    : topology_(topology),
      data_(data),
      gradient_(size),
      gradient_rate_(size),
      hessian_(Hessian::Zero(size, size)) {
  if (topology_.is_driven) drive_ = data_.drive.at(time);
  set_marker(0, 0, q);
  set_marker(1, markers_[0].size, q + markers_[0].size);
}

void JointLinearization::set_marker(std::size_t m, int start, const double* q) {
  const Marker& marker = topology_.markers[m];
  const BodyFrame& frame = marker.frame;
  MarkerState& state = markers_[m];
  state.start = start;
  state.frame = frame.size();
  state.r = frame.origin;
  for (int i = 0; i < frame.translations(); ++i) state.r += q[i] * frame.basis.col(i);
  const double* rotation = q + frame.translations();
  switch (frame.rotation) {
    case RotationCoordinates::none:
      state.A.setIdentity();
      break;
    case RotationCoordinates::angle:
      state.angle = rotation[0];
      set_planar_rotation(frame, state);
      break;
    case RotationCoordinates::rotation_vector:
      state.A = rotation_of(Vector3d(rotation));
      for (int i = 0; i < 3; ++i) {
        state.A_p[i] = state.A * skew<double>(Vector3d::Unit(i));
      }
      break;
  }
  state.u = data_.points[m];
  state.psi.setZero();
  const double* next = q + state.frame;
  for (int i = 0; i < 6; ++i) {
    if (marker.elastic[i] >= 0) (i < 3 ? state.u : state.psi)(i % 3) += *next++;
  }
  state.size = static_cast<int>(next - q);
}

/// R v = c v + s n × v + (1 − c)(n·v) n, applied to the columns of A_ref.
void JointLinearization::set_planar_rotation(const BodyFrame& frame, MarkerState& state) {
  state.normal = frame.reference.transpose() * frame.axis;
  const Matrix3d across = skew<double>(frame.axis) * frame.reference;
  const Matrix3d along = frame.axis * state.normal.transpose();
  const Matrix3d in_plane = frame.reference - along;
  const double c = std::cos(state.angle), s = std::sin(state.angle);
  state.A = along + c * in_plane + s * across;
  state.A_p[0] = c * across - s * in_plane;
}

void JointLinearization::set_turn(std::size_t m) {
  MarkerState& state = markers_[m];
  if (state.has_turn) return;
  state.has_turn = true;
  state.turn = ElasticRotation<double>(state.psi);
  state.turn_tangent = state.turn.tangent();
}

const JointLinearization::Hessian& JointLinearization::hessian() {
  if (!pull_.isZero(0.0)) {
    add_weighted_curvature(point(0), -pull_);
    add_weighted_curvature(point(1), pull_);
    pull_.setZero();
  }
  return hessian_;
}

void JointLinearization::clear_hessian() {
  hessian_.setZero();
  pull_.setZero();
}

/// Columns A_p s of the rotations and A ∂s/∂e of the elastic coordinates.
void JointLinearization::add_rotations(Attached& attached) const {
  const MarkerState& state = markers_[attached.marker];
  const BodyFrame& frame = topology_.markers[attached.marker].frame;
  for (int i = 0; i < frame.rotations(); ++i) {
    attached.jacobian.col(frame.translations() + i) = state.A_p[i] * attached.s;
  }
  for (int i = state.frame; i < state.size; ++i) {
    attached.jacobian.col(i) = state.A * attached.elastic.col(i - state.frame);
  }
}

const JointLinearization::Attached& JointLinearization::point(std::size_t m) {
  if (!points_[m]) points_[m] = make_point(m);
  return *points_[m];
}

JointLinearization::Attached JointLinearization::make_point(std::size_t m) const {
  const MarkerState& state = markers_[m];
  const Marker& marker = topology_.markers[m];
  Attached attached{AttachedKind::point,
                    m,
                    state.u,
                    state.r + state.A * state.u,
                    Jacobian(3, state.size),
                    Jacobian::Zero(3, state.size - state.frame)};
  int next = 0;
  for (int i = 0; i < 6; ++i) {
    if (marker.elastic[i] < 0) continue;
    if (i < 3) attached.elastic(i, next) = 1.0;
    ++next;
  }
  for (int i = 0; i < marker.frame.translations(); ++i) {
    attached.jacobian.col(i) = marker.frame.basis.col(i);
  }
  add_rotations(attached);
  return attached;
}

JointLinearization::Attached JointLinearization::direction(std::size_t m, const Vector3d& local) {
  const MarkerState& state = markers_[m];
  const Marker& marker = topology_.markers[m];
  if (marker.has_elastic_rotation()) set_turn(m);
  const Vector3d s = marker.has_elastic_rotation() ? state.turn.turned(local) : local;
  Attached attached{AttachedKind::direction,
                    m,
                    s,
                    state.A * s,
                    Jacobian::Zero(3, state.size),
                    Jacobian::Zero(3, state.size - state.frame)};
  int next = 0;
  for (int i = 0; i < 6; ++i) {
    if (marker.elastic[i] < 0) continue;
    if (i >= 3) attached.elastic.col(next) = state.turn_tangent.col(i - 3).cross(s);
    ++next;
  }
  add_rotations(attached);
  return attached;
}

/// gradient += Jᵀ g
void JointLinearization::add_to(Vector& gradient, const Attached& a, const Vector3d& g) const {
  const MarkerState& state = markers_[a.marker];
  gradient.segment(state.start, state.size).noalias() += a.jacobian.transpose() * g;
}

void JointLinearization::add_curvature(const Attached& a, const Vector3d& g) {
  add_weighted_curvature(a, weight_ * g);
}

/// hessian += H(g): second derivatives with respect to two rotations, a rotation and an elastic
/// coordinate, or two elastic rotations.
void JointLinearization::add_weighted_curvature(const Attached& a, const Vector3d& g) {
  const MarkerState& state = markers_[a.marker];
  const BodyFrame& frame = topology_.markers[a.marker].frame;
  if (a.kind == AttachedKind::direction) add_elastic_curvature(a, state.A.transpose() * g);
  const int first = state.start + frame.translations();
  for (int i = 0; i < frame.rotations(); ++i) {
    const Vector3d turned = state.A_p[i].transpose() * g;
    for (int j = state.frame; j < state.size; ++j) {
      const double entry = turned.dot(a.elastic.col(j - state.frame));
      hessian_(first + i, state.start + j) += entry;
      hessian_(state.start + j, first + i) += entry;
    }
  }
  if (frame.rotation == RotationCoordinates::angle) {
    // ∂²A/∂φ² turns the part of s in the plane by a half turn.
    const Vector3d in_plane = a.s - state.normal.dot(a.s) * state.normal;
    hessian_(first, first) -= g.dot(state.A * in_plane);
  } else if (frame.rotation == RotationCoordinates::rotation_vector) {
    // Row i, gᵀ A (eᵢ × s), changes with A → A (I + ẽⱼ) by g'ᵢ sⱼ − δᵢⱼ g'·s, g' = Aᵀ g.
    const Vector3d local = state.A.transpose() * g;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) hessian_(first + i, first + j) += local(i) * a.s(j);
      hessian_(first + i, first + i) -= local.dot(a.s);
    }
  }
}

/// Of two elastic rotations; g in local axes.
void JointLinearization::add_elastic_curvature(const Attached& a, const Vector3d& local) {
  const MarkerState& state = markers_[a.marker];
  const Marker& marker = topology_.markers[a.marker];
  if (!marker.has_elastic_rotation()) return;
  const Matrix3d curvature = state.turn.curvature(state.turn_tangent, a.s, local);
  std::array<int, 3> index{-1, -1, -1};
  int next = state.start + state.frame;
  for (std::size_t i = 0; i < 6; ++i) {
    if (marker.elastic[i] < 0) continue;
    if (i >= 3) index[i - 3] = next;
    ++next;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (index[i] < 0 || index[j] < 0) continue;
      hessian_(index[i], index[j]) += curvature(static_cast<int>(i), static_cast<int>(j));
    }
  }
}

/// hessian += weight sign (Jₐᵀ J_b + J_bᵀ Jₐ)
void JointLinearization::add_product(const Attached& a, const Attached& b, double sign) {
  const MarkerState& first = markers_[a.marker];
  const MarkerState& second = markers_[b.marker];
  hessian_.block(first.start, second.start, first.size, second.size).noalias() +=
      weight_ * sign * a.jacobian.transpose() * b.jacobian;
  hessian_.block(second.start, first.start, second.size, first.size).noalias() +=
      weight_ * sign * b.jacobian.transpose() * a.jacobian;
}

void JointLinearization::evaluate(const JointEquation& equation, double weight) {
  rate_ = 0.0;
  weight_ = weight;
  gradient_.setZero();
  gradient_rate_.setZero();
  const auto local = [&](int index) { return data_.directions[index]; };
  switch (equation.kind) {
    case EquationKind::coincident:
      evaluate_coincident(equation.fixed);
      break;
    case EquationKind::on_plane:
      evaluate_on_plane(equation);
      break;
    case EquationKind::slide:
      evaluate_on_plane(equation);
      value_ -= drive_.value;
      rate_ = -drive_.rate;
      break;
    case EquationKind::distance:
      evaluate_distance();
      break;
    case EquationKind::perpendicular:
      evaluate_directions(direction(0, local(equation.first)),
                          direction(1, local(equation.second)));
      break;
    case EquationKind::drive:
      evaluate_drive(equation);
      break;
    case EquationKind::planar_angle:
      evaluate_planar_angle(equation);
      break;
  }
}

/// Of all such equations of a joint H is evaluated at once.
void JointLinearization::evaluate_coincident(const Vector3d& e) {
  const Attached &first = point(0), &second = point(1);
  value_ = e.dot(second.y - first.y);
  add_gradient(first, -e);
  add_gradient(second, e);
  pull_ += weight_ * e;
}

void JointLinearization::evaluate_on_plane(const JointEquation& equation) {
  const Attached d = direction(0, data_.directions[equation.first]);
  const Attached &first = point(0), &second = point(1);
  const Vector3d difference = second.y - first.y;
  value_ = d.y.dot(difference);
  add_gradient(d, difference);
  add_gradient(first, -d.y);
  add_gradient(second, d.y);
  add_curvature(d, difference);
  add_curvature(first, -d.y);
  add_curvature(second, d.y);
  add_product(d, second, 1.0);
  add_product(d, first, -1.0);
}

/// Φ = ½ (Δ·Δ/ℓ − ℓ):  Φ_q = Jᵀ Δ/ℓ,  Φ_qq = H(Δ/ℓ) + Jᵀ J/ℓ  with J = J₂ − J₁
void JointLinearization::evaluate_distance() {
  const Attached &first = point(0), &second = point(1);
  const Vector3d difference = second.y - first.y;
  const double length = data_.length + drive_.value;
  value_ = 0.5 * (difference.squaredNorm() / length - length);
  rate_ = -0.5 * drive_.rate * (difference.squaredNorm() / (length * length) + 1.0);
  const Vector3d g = difference / length;
  add_gradient(first, -g);
  add_gradient(second, g);
  add_curvature(first, -g);
  add_curvature(second, g);
  add_product(first, second, -1.0 / length);
  add_product(first, first, 0.5 / length);
  add_product(second, second, 0.5 / length);
  gradient_rate_ = -(drive_.rate / length) * gradient_;
}

void JointLinearization::evaluate_directions(const Attached& first, const Attached& second) {
  value_ = first.y.dot(second.y);
  add_gradient(first, second.y);
  add_gradient(second, first.y);
  add_curvature(first, second.y);
  add_curvature(second, first.y);
  add_product(first, second, 1.0);
}

/// cos f d_b − sin f d_a, and its derivative with respect to f with f a quarter turn further.
Vector3d JointLinearization::driven_direction(const JointEquation& equation,
                                              double quarter_turns) const {
  const double angle = drive_.value + quarter_turns * std::acos(0.0);
  return std::cos(angle) * data_.directions[equation.third] -
         std::sin(angle) * data_.directions[equation.first];
}

void JointLinearization::evaluate_drive(const JointEquation& equation) {
  const Attached second = direction(1, data_.directions[equation.second]);
  evaluate_directions(direction(0, driven_direction(equation, 0.0)), second);
  const Attached rate = direction(0, drive_.rate * driven_direction(equation, 1.0));
  add_to(gradient_rate_, rate, second.y);
  add_to(gradient_rate_, second, rate.y);
  rate_ = rate.y.dot(second.y);
}

void JointLinearization::evaluate_planar_angle(const JointEquation& equation) {
  const double sense = equation.sense;
  value_ = -sense * data_.offset - (equation.is_driven ? drive_.value : 0.0);
  rate_ = equation.is_driven ? -drive_.rate : 0.0;
  for (std::size_t m = 0; m < 2; ++m) {
    const MarkerState& state = markers_[m];
    const Marker& marker = topology_.markers[m];
    if (marker.frame.rotations() == 0) continue;
    const double sign = m == 0 ? -sense : sense;
    value_ += sign * (state.angle + state.normal.dot(state.psi));
    gradient_(state.start + marker.frame.translations()) = sign;
    int next = state.start + state.frame;
    for (int i = 0; i < 6; ++i) {
      if (marker.elastic[i] < 0) continue;
      if (i >= 3) gradient_(next) = sign * state.normal(i - 3);
      ++next;
    }
  }
}

}  // namespace pleuel
