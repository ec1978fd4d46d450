#pragma once

#include <optional>
#include <vector>

#include "core/model/model.hpp"

namespace pleuel {

/// What is simulated of a beam.
struct BeamEffects {
  bool elasticity = true, axial_elasticity = true, torsional_elasticity = true;
  bool geometric_stiffening = true, rotary_inertia = true;
};

/// Decides what is simulated of a beam: what the file forces; else, where there is a tolerance and
/// an estimate, what the estimate calls for; else all of it.
BeamEffects decide_beam_effects(const Body& body, const EffectSettings& settings);

/// Lines of the table of effects for a beam that was built.
/// @param is_planar  motion in a plane has neither torsion nor bending out of it
std::vector<EffectRecord> beam_records(const Body& body, const EffectSettings& settings,
                                       const BodyModel& model, bool is_planar);

}  // namespace pleuel
