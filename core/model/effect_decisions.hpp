#pragma once

#include <array>
#include <vector>

#include "core/model/model.hpp"

namespace pleuel {

/// What is simulated of a beam or an imported body.
struct BodyEffects {
  bool elasticity = true, axial_elasticity = true, torsional_elasticity = true;
  bool geometric_stiffening = true, rotary_inertia = true;
};

/// One of them: its name in files, what the file says, its estimate, whether it is built.
struct BeamEffect {
  const char* name;
  EffectChoice EffectSettings::*choice;
  double BeamEstimates::*estimate;
  bool BodyEffects::*is_built;
};
inline constexpr std::array<BeamEffect, 5> beam_effects = {
    {{"elasticity", &EffectSettings::elasticity, &BeamEstimates::elasticity,
      &BodyEffects::elasticity},
     {"axial_elasticity", &EffectSettings::axial_elasticity, &BeamEstimates::axial_elasticity,
      &BodyEffects::axial_elasticity},
     {"torsional_elasticity", &EffectSettings::torsional_elasticity,
      &BeamEstimates::torsional_elasticity, &BodyEffects::torsional_elasticity},
     {"geometric_stiffening", &EffectSettings::geometric_stiffening,
      &BeamEstimates::geometric_stiffening, &BodyEffects::geometric_stiffening},
     {"rotary_inertia", &EffectSettings::rotary_inertia, &BeamEstimates::rotary_inertia,
      &BodyEffects::rotary_inertia}}};

/// Decides what is simulated of a body: what the file forces; else what was measured; else,
/// where there is a tolerance and an estimate, what the estimate calls for; else all of it. The
/// axial force that stiffens comes from axial strain: without it there is no stiffening, and what
/// stiffening needs is kept. Of an imported body nobody has estimates.
BodyEffects decide_effects(const Body& body, const EffectSettings& settings);

/// Lines of the table of effects for a beam that was built.
/// @param is_planar  motion in a plane has neither torsion nor bending out of it
std::vector<EffectRecord> beam_records(const Body& body, const EffectSettings& settings,
                                       const BodyModel& model, bool is_planar);

}  // namespace pleuel
