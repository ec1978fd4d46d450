#pragma once

#include <vector>

#include "core/scene/body_constants.hpp"

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

  /// To the chart and back, with derivatives.
  /// @throws SimulationError if what has a logarithm is not positive
  void take_logarithms(BodyConstants& constants, std::vector<BodyConstants>& derivatives) const;
  void take_exponentials(BodyConstants& constants, std::vector<BodyConstants>& derivatives) const;

  /// Multiplies what is a logarithm.
  static void scale(BodyConstants& constants, double factor);

 private:
  /// S and V of one of the matrices.
  struct Basis {
    Eigen::VectorXd scale;
    Eigen::MatrixXd vectors;
  };
  enum class Way { to_chart, back };

  static Basis basis_of(const Eigen::MatrixXd& matrix);
  void change(Way way, BodyConstants& constants, std::vector<BodyConstants>& derivatives) const;

  std::vector<Basis> bases_;  ///< in the order of the matrices
};

}  // namespace pleuel
