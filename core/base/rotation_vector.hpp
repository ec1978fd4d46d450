#pragma once

#include <cmath>

#include <Eigen/Core>

#include "core/base/dual.hpp"
#include "core/base/small_matrices.hpp"

/// Rotations in space by rotation vectors. The rotation of a frame is A = exp(ψ̃); its rates are the
/// angular velocity ω and acceleration α in body axes; small changes δ are right perturbations
///     A ⊕ δ = A exp(δ̃)
/// so that nothing is singular and planar motion adds angles (Brüls & Cardona 2010).
namespace pleuel {

/// exp(ψ̃) (Rodrigues).
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& psi);

/// The ψ of a rotation matrix with |ψ| ≤ π.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

/// ψ ⊕ δ: the vector of exp(ψ̃) exp(δ̃), composed by Euler parameters.
Eigen::Vector3d compose(const Eigen::Vector3d& psi, const Eigen::Vector3d& delta);

/// T(δ) of  exp((δ + ε)~) = exp(δ̃) exp((T ε)~) + O(ε²):
///     T = I − (1 − cos φ)/φ² δ̃ + (φ − sin φ)/φ³ δ̃δ̃,   φ = |δ|
Eigen::Matrix3d tangent_operator(const Eigen::Vector3d& delta);

/// T(δ)⁻¹ for |δ| < 2π.
Eigen::Matrix3d inverse_tangent_operator(const Eigen::Vector3d& delta);

/// The functions of x = φ² that rotations by rotation vectors are made of,
///     c_k(x) = Σⱼ (−x)ʲ/(k + 2j)!:   c₁ = sin φ/φ,  c₂ = (1 − cos φ)/φ²,  c₃ = (φ − sin φ)/φ³, …
/// (Stumpff functions). They are smooth at φ = 0, and
///     c_k = 1/k! − x c_{k+2},   dc_k/dx = ½ (k c_{k+2} − c_{k+1})
template <class Scalar>
struct RotationSeries {
  Scalar c1, c2, c3, c4, c5;

  /// At x = 0.
  RotationSeries() : c1(1.0), c2(1.0 / 2.0), c3(1.0 / 6.0), c4(1.0 / 24.0), c5(1.0 / 120.0) {}

  /// To round-off for any x ≥ 0: by series up to one radian, where quotients would cancel.
  explicit RotationSeries(const Scalar& x) {
    if (value_of(x) < 1.0) {
      c4 = sum<4>(x) / 24.0;
      c5 = sum<5>(x) / 120.0;
      c3 = 1.0 / 6.0 - x * c5;
      c2 = 0.5 - x * c4;
      c1 = 1.0 - x * c3;
    } else {
      using std::cos;
      using std::sin;
      using std::sqrt;
      const Scalar angle = sqrt(x);
      c1 = sin(angle) / angle;
      c2 = (1.0 - cos(angle)) / x;
      c3 = (1.0 - c1) / x;
      c4 = (0.5 - c2) / x;
      c5 = (1.0 / 6.0 - c3) / x;
    }
  }

  Scalar slope_of_c2() const { return 0.5 * (2.0 * c4 - c3); }
  Scalar slope_of_c3() const { return 0.5 * (3.0 * c5 - c4); }

 private:
  /// k! c_k by Horner's rule; the ninth member is below 24/20! = 1e-17 for x ≤ 1.
  template <int k>
  static Scalar sum(const Scalar& x) {
    Scalar value(1.0);
    for (int n = k + 14; n > k; n -= 2) value = 1.0 - x * value * (1.0 / (n * (n - 1)));
    return value;
  }
};

/// w̃ of the cross product: w̃ u = w × u.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> skew(const Eigen::Matrix<Scalar, 3, 1>& w) {
  Eigen::Matrix<Scalar, 3, 3> matrix;
  const Scalar zero(0);
  matrix << zero, -w(2), w(1), w(2), zero, -w(0), -w(1), w(0), zero;
  return matrix;
}

}  // namespace pleuel
