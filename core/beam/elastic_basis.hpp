#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/beam/elastic_coordinates.hpp"
#include "core/beam/invariants.hpp"

/// Elastic coordinates that are not nodal: d = Z q_f, with d the nodal coordinates of a beam.
///
/// The derivative of Z with respect to a design variable is taken up to changes of basis within the
/// span of Z: no response depends on them, and they are what is singular when frequencies meet.
namespace pleuel {

/// Matrices of a beam in its nodal coordinates, or their derivative.
struct NodalMatrices {
  Eigen::MatrixXd mass, stiffness;  ///< n × n
  Eigen::MatrixXd momentum;  ///< 6 × n: ∫ρ S (linear), ∫ρ p̃₀ S (angular momentum), rows x y z
  Eigen::MatrixXd rigid;  ///< n × 6: nodal displacements of unit translations and rotations
};

struct BasisWithDerivatives {
  Eigen::MatrixXd basis;                     ///< Z, n × k
  std::vector<Eigen::MatrixXd> derivatives;  ///< one for each derivative of the matrices
};

/// Interior coordinates that vibrate without the others, as bending in one plane does.
struct ModeFamily {
  std::vector<int> coordinates;  ///< ascending
  int modes = 0;                 ///< how many of its fixed-interface modes are kept, the lowest
};

/// What a Craig–Bampton basis keeps.
struct KeptCoordinates {
  std::vector<int> boundary;         ///< nodal coordinates that stay as they are (ascending)
  std::vector<ModeFamily> families;  ///< of all others, each in one family
};

/// Craig & Bampton 1968: with i the interior and b the boundary,
///     Z = [ I 0 ; −K_ii⁻¹ K_ib  Φ ],   K_ii Φ = M_ii Φ Λ  for each family
/// Modes are counted family by family, so that a beam that moves in a plane has the same modes of
/// bending there as in space. They are scaled to a largest entry of one.
BasisWithDerivatives craig_bampton_basis(const NodalMatrices& matrices,
                                         const std::vector<NodalMatrices>& derivatives,
                                         const KeptCoordinates& kept);

/// Number of fixed-interface modes of a family below a frequency [rad/s]; modes of one frequency
/// stay together.
int count_fixed_interface_modes(const NodalMatrices& matrices, const std::vector<int>& family,
                                double frequency);

/// Completes a number of modes of a family so that modes of (nearly) one frequency are not torn
/// apart.
int complete_modes(const NodalMatrices& matrices, const std::vector<int>& family, int modes);

/// Mean axis (Tisserand; Agrawal & Shabana 1985): takes from each given deformation D the rigid
/// motion that has its momentum,
///     Z = D − R (C R)⁻¹ C D,   C = momentum rows, R = rigid displacements
/// @param active  which of the six rigid motions the nodal coordinates can follow
BasisWithDerivatives mean_axis_basis(const NodalMatrices& matrices,
                                     const std::vector<NodalMatrices>& derivatives,
                                     const BasisWithDerivatives& deformations,
                                     const std::vector<int>& active);

/// The invariants in the coordinates of a basis, I(Z): S̄ Z, Zᵀ S_kl Z, …
Invariants<double> project_invariants(const Invariants<double>& nodal, const Eigen::MatrixXd& z);

/// Derivative of those: product rule with dI and dZ.
Invariants<double> project_derivative(const Invariants<double>& nodal,
                                      const Invariants<double>& nodal_derivative,
                                      const Eigen::MatrixXd& z, const Eigen::MatrixXd& dz);

/// Damping matrix of a ratio ζ in every mode of (K, M), D = 2ζ M (M⁻¹K)^½, and its derivative.
struct ModalDamping {
  Eigen::MatrixXd damping;
  std::vector<Eigen::MatrixXd> derivatives;
};
struct DampedMatrices {
  Eigen::MatrixXd mass, stiffness;
  double ratio = 0.0;
};
ModalDamping modal_damping(const DampedMatrices& matrices,
                           const std::vector<DampedMatrices>& derivatives);

/// A matrix of a body as a dense one.
Eigen::MatrixXd dense_matrix(const ElasticPattern& pattern, const Eigen::VectorXd& entries);

/// Nodal displacements of the unit rigid motions at node positions x (or their derivatives with
/// respect to the design, from those of x: then `translation` is zero).
Eigen::MatrixXd rigid_displacements(const ElasticCoordinates& coordinates,
                                    const std::vector<double>& x, double translation);

/// Undamped modes, K φ = λ M φ.
struct NaturalModes {
  Eigen::VectorXd lambda;  ///< ω², ascending [rad²/s²]
  Eigen::MatrixXd shapes;  ///< columns φ with φᵀ M φ = 1
};

/// Of symmetric K and positive definite M (lower triangles are read).
NaturalModes natural_modes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

}  // namespace pleuel
