#pragma once

#include "core/base/rotation_vector.hpp"
#include "core/frame/body_frame.hpp"

namespace pleuel {

/// How the elastic rotation ψ of a place turns the directions that are attached to it: by the
/// rotation R = exp(ψ̃), so that they keep their lengths and angles, and turn in space by the angle
/// that they turn by in a plane. All vectors are in the axes of the floating frame.
///
/// With c_k of RotationSeries at x = ψ·ψ:
///     R s = s + c₁ ψ × s + c₂ ψ × (ψ × s)
/// A change δψ turns by δθ = T δψ against the frame, δ(R s) = δθ × R s, and a moment M does the
/// work M · δθ:
///     T δψ = δψ + c₂ ψ × δψ + c₃ ψ × (ψ × δψ)
/// T is the transpose of the operator of rotation_vector.hpp, which belongs to turned axes. About
/// one axis T is one.
template <class Scalar>
class ElasticRotation {
 public:
  using Vector = Vector3<Scalar>;
  using Matrix = Matrix3<Scalar>;

  /// No rotation.
  ElasticRotation() = default;
  explicit ElasticRotation(const Vector& psi) : psi_(psi), series_(psi.dot(psi)) {}

  /// R s
  Vector turned(const Vector& s) const {
    const Vector across = psi_.cross(s);
    return s + series_.c1 * across + series_.c2 * psi_.cross(across);
  }

  /// T ψ̇: the angular velocity against the frame [rad/s].
  Vector spin(const Vector& rate) const {
    const Vector across = psi_.cross(rate);
    return rate + series_.c2 * across + series_.c3 * psi_.cross(across);
  }

  /// d(T ψ̇)/dt: the angular acceleration against the frame [rad/s²].
  Vector spin_rate(const Vector& rate, const Vector& acceleration) const {
    const Vector across = psi_.cross(rate);
    const Scalar growth = 2.0 * psi_.dot(rate);
    return spin(acceleration) + (growth * series_.slope_of_c2()) * across +
           (growth * series_.slope_of_c3()) * psi_.cross(across) + series_.c3 * rate.cross(across);
  }

  /// Tᵀ M: what a moment M does on ψ.
  Vector generalized(const Vector& moment) const {
    const Vector across = psi_.cross(moment);
    return moment - series_.c2 * across + series_.c3 * psi_.cross(across);
  }

  /// T = (1 − c₃ x) I + c₂ ψ̃ + c₃ ψ ψᵀ
  Matrix tangent() const {
    const Vector scaled = series_.c3 * psi_;
    Matrix columns = skew<Scalar>(Vector(series_.c2 * psi_)) + scaled * psi_.transpose();
    columns.diagonal().array() += 1.0 - scaled.dot(psi_);
    return columns;
  }

  /// ∂(Tᵀ M)/∂ψ for a constant M.
  Matrix slope_of_generalized(const Vector& moment) const {
    const Vector across = psi_.cross(moment);
    Matrix slope = series_.c2 * skew<Scalar>(moment);
    slope.diagonal().array() += series_.c3 * psi_.dot(moment);
    slope += series_.c3 * psi_ * moment.transpose();
    slope += (-2.0 * series_.c3 * moment - 2.0 * series_.slope_of_c2() * across +
              2.0 * series_.slope_of_c3() * psi_.cross(across)) *
             psi_.transpose();
    return slope;
  }

  /// ∂²(g · R s)/∂ψ², symmetric; t is T and `turned` is R s.
  Matrix curvature(const Matrix& t, const Vector& turned, const Vector& g) const {
    const Vector along_turned = t.transpose() * turned, along_g = t.transpose() * g;
    // ∂(tᵢ · R s × g)/∂ψⱼ:  tᵢ changes, and R s by tⱼ × R s.
    return slope_of_generalized(turned.cross(g)) + along_turned * along_g.transpose() -
           g.dot(turned) * t.transpose() * t;
  }

 private:
  Vector psi_ = Vector::Constant(Scalar(0));
  RotationSeries<Scalar> series_;
};

}  // namespace pleuel
