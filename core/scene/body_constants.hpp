#pragma once

/// What the equations of motion and the responses know of the finite-element model of an elastic
/// body: plain numbers, from whatever code, in SI units and in the axes of the body frame. The n
/// elastic coordinates q_f leave no rigid motion: the reference condition of the body frame.

/// The files by which bodies come from other codes and go to them (docs/invariants.md).

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "core/base/strengths.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A point that joints and loads hold on to and where responses look.
struct BodyPlace {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< undeformed [m]
  SparseMatrix displacement;                           ///< u = displacement · q_f, 3 × n
  SparseMatrix rotation;                               ///< small rotation, 3 × n
};

/// Points of stress that responses name together.
struct PointGroup {
  std::string name;
  std::vector<int> points;  ///< in rising order

  bool operator==(const PointGroup&) const = default;
};

/// Stress from the deformation, and from what the inertia load adds within the finite elements:
///     σ = of_coordinates q_f + of_accelerations a + of_stretching N
/// with six rows a point, σ_xx σ_yy σ_zz τ_xy τ_yz τ_xz [Pa].
struct StressRecovery {
  std::vector<std::string> points;  ///< their names
  std::vector<PointGroup> groups;
  Strengths<double> strengths;
  SparseMatrix of_coordinates;  ///< 6 points × n
  /// Times the accelerations of all places against free fall, three each, 6 points × 3 places.
  SparseMatrix of_accelerations;
  /// Times the axial forces κ ½ dᵀ Ĝ d of the elements of geometric stiffening, 6 points ×
  /// elements.
  SparseMatrix of_stretching;
};

/// Constants of geometric stiffening of one member (core/effects/geometric_stiffening.hpp).
struct StretchedElement {
  std::vector<int> displacements;  ///< which of d it has, twelve at most
  Eigen::VectorXd elongation;      ///< b: Δu = bᵀ d, the same in all designs
  double axial_stiffness = 0.0;    ///< κ [N/m]
  Eigen::MatrixXd slopes;          ///< Ĝ [1/m], symmetric
};

struct Stretching {
  double damping = 0.0;        ///< β: the axial force is κ (g + β ġ) [s]
  SparseMatrix displacements;  ///< d = displacements · q_f
  std::vector<StretchedElement> elements;
};

/// The invariants (core/beam/invariants.hpp) with stiffness, damping, places, stress and
/// stiffening; or their derivatives with respect to a design variable, in the same arrangement.
struct BodyConstants {
  double mass = 0.0;                                        ///< m = ∫ρ [kg]
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();   ///< ∫ρ p₀ [kg m]
  Eigen::Matrix3d second_moment = Eigen::Matrix3d::Zero();  ///< ∫ρ p₀ p₀ᵀ [kg m²]
  SparseMatrix shape;                                       ///< S̄ = ∫ρ S, 3 × n
  SparseMatrix mixed;                   ///< H_kl = ∫ρ p₀_k S_l, row 3k + l of 9 × n
  std::array<SparseMatrix, 6> moments;  ///< S_kl = ∫ρ S_kᵀ S_l for moment_pairs, n × n
  SparseMatrix mass_matrix;             ///< S_xx + S_yy + S_zz, n × n
  SparseMatrix stiffness, damping;      ///< K, D, n × n
  std::vector<BodyPlace> places;
  std::optional<StressRecovery> stress;
  std::optional<Stretching> stretching;

  int size() const { return static_cast<int>(stiffness.rows()); }
};

/// (k, l) of the moments; S_lk = S_klᵀ.
inline constexpr std::array<std::pair<int, int>, 6> moment_pairs = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

/// The points that a name stands for: those of a group, or all that are called so.
/// @returns indices; none if the name is unknown
std::vector<int> named_points(const StressRecovery& stress, const std::string& name);

/// Names of all groups and points.
std::vector<std::string> point_names(const StressRecovery& stress);

/// The constants as functions of one design variable, at the design of the file.
struct ConstantsDerivative {
  std::string variable;
  double value = 0.0;  ///< of the variable [SI]
  std::string unit;    ///< SI
  std::optional<BodyConstants> derivative;
};

/// The surface of a body, for pictures.
struct BodySurface {
  Eigen::Matrix3Xd positions;                 ///< of its points [m]
  std::vector<std::array<int, 3>> triangles;  ///< of points
  Eigen::MatrixXd displacement;               ///< of the points per coordinate, 3 points × n
  double young = 0.0, poisson = 0.0;          ///< E [Pa], ν: what makes stress of strain
};

/// A file of invariants.
struct InvariantsFile {
  std::string body, description;
  std::string reference_condition;       ///< how the body frame is tied to the deformed body
  std::vector<std::string> coordinates;  ///< names of q_f, in their order
  BodyConstants constants;
  std::vector<ConstantsDerivative> design;
  std::optional<BodySurface> surface;
};

/// to += factor · change
void add_constants(BodyConstants& to, double factor, const BodyConstants& change);

/// Whether all numbers are zero: the body does not depend on the variable.
bool is_zero(const BodyConstants& change);

/// All zero, in the arrangement of others.
BodyConstants zero_constants(const BodyConstants& like);

/// The place that is nearest to a point in the axes of the body; −1 if there is none.
int nearest_place(const BodyConstants& constants, const Eigen::Vector3d& point);

/// The largest distance of a place from the origin or from another place [m].
double size_of(const BodyConstants& constants);

/// The text of a file. Numbers read back exactly.
std::string write_invariants(const InvariantsFile& file);

/// Reads a file and checks it: sizes, finite numbers, a mass that is positive, matrices that are
/// symmetric and positive definite, S_xx + S_yy + S_zz = mass matrix.
/// @throws InputError that names the file and the JSON pointer.
InvariantsFile read_invariants(const std::filesystem::path& path);

/// @param file  how messages name the text
InvariantsFile read_invariants_text(const std::string& text, const std::string& file);

}  // namespace pleuel
