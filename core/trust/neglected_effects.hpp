#pragma once

#include <memory>
#include <string>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// A design simulated once more with all effects, where a tolerance leaves some out.
struct CompleteRun {
  ProblemFile problem;
  std::unique_ptr<Analysis> analysis;  ///< null: it cannot be simulated
  std::string failure;                 ///< why not
};

/// @returns none where no effect is left out by measurement
std::optional<CompleteRun> simulate_completely(const TrustedRun& run);

/// Effects that were left out because little changed without them at the start design, and change
/// more at this one.
std::vector<Finding> check_neglected_effects(const TrustedRun& run, const CompleteRun& complete);

/// Geometric stiffening that the file does not forbid, but is not there because axial elasticity
/// is switched off: judged by the estimate of the axial force against Euler's load.
std::vector<Finding> check_lost_stiffening(const TrustedRun& run);

/// Adds to the error of each response what the effects change that are left out by a tolerance.
void add_neglected_effects(const TrustedRun& run, const CompleteRun& complete,
                           std::vector<std::optional<ErrorBar>>& errors);

/// Beams with modal damping and geometric stiffening that bend far: their axial displacements hold
/// the shortening by bending, which a ratio of the axial modes damps as if it were stretch.
std::vector<Finding> check_modal_damping(const TrustedRun& run);

}  // namespace pleuel
