#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/base/dual.hpp"
#include "core/scene/body_constants.hpp"
#include "core/scene/number.hpp"

namespace pleuel {

/// Coordinates of the space of bodies in which any step leads to a body: in place of what has to stay
/// positive, its logarithm. These are
/// - stiffness and damping,
/// - inertia as one matrix G = ∫ρ φ φᵀ, φ = (1, p₀, S), which has mass, first and second moment and all
///   invariants as its blocks,
/// - axial stiffness of the elements of geometric stiffening.
/// A matrix A has the logarithm V log(a) Vᵀ of a = Vᵀ S A S V, with S Sᵀ = 1/diag(A) and V the
/// eigenvectors of S A S that are not zero, both of a reference (Arsigny et al. 2006). What is
/// outside of them, nothing where bodies of all designs have the same dependent coordinates, stays
/// as it is.
class BodyChart {
 public:
  explicit BodyChart(const BodyConstants& reference);

  enum class Way { to_chart, back };

  /// Takes logarithms, or exponentials, with derivatives.
  /// @throws SimulationError if what has a logarithm is not positive
  void change(Way way, BodyConstants& constants, std::vector<BodyConstants>& derivatives) const;

  /// Multiplies what is a logarithm.
  static void scale(BodyConstants& constants, double factor);

 private:
  /// S and V of one of the matrices.
  struct Basis {
    Eigen::VectorXd scale;
    Eigen::MatrixXd vectors;
  };
  static Basis basis_of(const Eigen::MatrixXd& matrix);

  std::vector<Basis> bases_;  ///< in the order of the matrices
};

/// Axes of a body that lies as a beam does, body to global: local x from `from` to `to`; local y
/// the part normal to it of the reference vector (by default z × x, or global y for beams along z).
template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> beam_axes(const Point& from, const Point& to,
                                      const std::optional<std::array<double, 3>>& reference,
                                      const Design<Scalar>& design) {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  Vector x, y;
  for (int i = 0; i < 3; ++i) {
    x(i) = resolve(to[i], design) - resolve(from[i], design);
  }
  x.normalize();
  if (reference) {
    const Vector given =
        Eigen::Vector3d((*reference)[0], (*reference)[1], (*reference)[2]).template cast<Scalar>();
    const Scalar along = given.dot(x);
    y = given - along * x;
  } else {
    y = Vector(-x(1), x(0), Scalar(0));
    const bool is_vertical = std::abs(value_of(x(0))) + std::abs(value_of(x(1))) < 1e-9;
    if (is_vertical) y = Eigen::Vector3d::UnitY().template cast<Scalar>() - x(1) * x;
  }
  y /= Scalar(y.norm());
  Eigen::Matrix<Scalar, 3, 3> axes;
  axes << x, y, Vector(x.cross(y));
  return axes;
}

}  // namespace pleuel
