#pragma once

#include <variant>

#include "core/model/model.hpp"

/// What can be chosen besides steps and elements, one change at a time.
namespace pleuel {

/// A value of the file that `--set` replaces.
struct Override {
  std::string pointer;
  std::variant<bool, int, double, std::string> value;
};

/// One change of a problem: what `--set` would change.
struct Variation {
  std::string knob;   ///< "formulation", "geometric_stiffening"
  std::string value;  ///< "stabilized-index-2", "off"
  std::vector<Override> overrides;
  ProblemFile of(ProblemFile problem) const;
};

/// Other formulations of the constraints, schemes, spectral radii, tolerances of Newton's method,
/// local errors that steps follow, and numbers of modes where a beam is reduced. What the problem
/// has already, or what contradicts the rest of it, is left out.
std::vector<Variation> numerical_variations(const ProblemFile& problem);

/// Each effect that the model has, left out; each that it leaves out of all bodies, included; and
/// the mechanism without gravity. Elasticity is left alone where a response is nothing without it.
/// @param model  of the problem
std::vector<Variation> effect_variations(const ProblemFile& problem, const Model& model);

/// A formulation that the reference of a study can be compared with: stabilized index 2, or index 3
/// where the problem has that.
Variation other_formulation(const ProblemFile& problem);

}  // namespace pleuel
