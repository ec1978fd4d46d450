#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

/// What the model leaves out: the mechanism is simulated once more with it, and the difference is what
/// it would change.
namespace pleuel {

/// What one variant makes of all responses.
struct VariantChange {
  std::string name;        ///< of what is left out: "shear"
  Eigen::VectorXd change;  ///< what is missing of each response [its unit]
};

struct LeftOut {
  std::vector<VariantChange> changes;
  std::vector<Finding> findings;
};

/// Runs the variants whose indicators speak, in larger steps (coarse_runs.hpp):
/// - `shear` in beams that leave it out and are stubby (bent_beams.hpp),
/// - `more_frames`, by twice as many, in beams that bend or twist far against those they have: linear
///   elasticity in a frame is off by the square of rotations, of which twice the frames leave a
///   quarter.
///
/// Told from 1 % of what a response is with it, serious from 10 % of that or of a tenth of its
/// limits (coarse_runs.hpp), with the beams whose indicators say that they have a part in it. Where a response cannot be had of a divided beam, rotations tell (bent_beams.hpp).
LeftOut compare_variants(const TrustedRun& run);

}  // namespace pleuel
