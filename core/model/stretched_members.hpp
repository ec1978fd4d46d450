#pragma once

#include <vector>

#include "core/model/elastic_body.hpp"

namespace pleuel {

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
