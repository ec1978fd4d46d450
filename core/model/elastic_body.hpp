#pragma once

#include <string>
#include <vector>

#include "core/beam/invariants.hpp"
#include "core/scene/body_constants.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Points of a body with their displacements: the nodes of a beam, the places of a file. Inertia
/// loads come from their accelerations.
struct BodyPlaces {
  std::vector<std::string> names;  ///< of the places of a file
  Eigen::Matrix3Xd positions;      ///< undeformed, local axes [m]
  SparseMatrix shape;              ///< u v w θx θy θz of each = shape · q_f, 6 places × n

  int size() const { return static_cast<int>(positions.cols()); }

  /// u v w θx θy θz in local axes, a column each place.
  template <class Vector>
  Eigen::Matrix<double, 6, Eigen::Dynamic> displacements(const Vector& q_f) const {
    const Eigen::VectorXd all = shape * q_f;
    return all.reshaped(6, size());
  }
};

/// Numbers that are linear in the state of an elastic body, one a row, such as section forces:
///     numbers = of_coordinates q_f + of_accelerations a + of_stretching N
struct Recovery {
  SparseMatrix of_coordinates;    ///< rows × n
  SparseMatrix of_accelerations;  ///< of all places against free fall, local axes, rows × 3 places
  /// Of the axial forces N = κ ½ dᵀ Ĝ d of the members of geometric stiffening, rows × members.
  SparseMatrix of_stretching;
};

/// All that the equations of motion, joints, loads and responses know of an elastic body, with the
/// derivatives: one list entry a design variable, in the same order and arrangement everywhere.
/// The builder of beams makes it, and so does the importer of files. Of a rigid body there are no
/// coordinates.
struct ElasticBody {
  Invariants<double> invariants;
  std::vector<DesignDerivative<Invariants<double>>> invariants_x;

  BodyPlaces places;
  std::vector<DesignDerivative<BodyPlaces>> places_x;

  Stretching stretching;  ///< of a beam without members where stiffening is left out
  std::vector<DesignDerivative<Stretching>> stretching_x;

  /// Stress at the points of a file; a beam has section forces (core/response/section_forces.hpp).
  StressRecovery stress;
  std::vector<DesignDerivative<StressRecovery>> stress_x;

  int elastic_size() const { return invariants.size(); }
};

/// The members of geometric stiffening of a body in its elastic coordinates: with d = Z q_f
///     Δu = (Zᵀ b)ᵀ q_f,   ∫ v'² + w'² dx = q_fᵀ (Zᵀ Ĝ Z) q_f
/// so that nobody has to make displacements in every step. `displacements` of a member are the
/// elastic coordinates that move it here; those that neither value nor derivative needs are left
/// out. Derivatives have the arrangement of the values; their `elongation` is Z'ᵀ b.
struct StretchedMembers {
  std::vector<StretchedElement> values;
  std::vector<DesignDerivative<std::vector<StretchedElement>>> derivatives;
};

StretchedMembers stretched_members(const ElasticBody& body);

}  // namespace pleuel
