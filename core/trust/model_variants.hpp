#pragma once

#include <functional>
#include <memory>
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

/// Runs the variants whose indicators speak, at twice the step:
/// - `shear` in beams that leave it out and are stubby (low_slenderness.hpp),
/// - `more_frames`, by twice as many, in beams that bend or twist far against those they have: linear
///   elasticity in a frame is off by the square of rotations, of which twice the frames leave a
///   quarter.
///
/// Told from 1 % of what a response is with it, serious from 10 % of that or of a tenth of its
/// limits (response_changes.hpp), with the beams that make it: where there are several, each is
/// simulated alone. Where a response cannot be had of a divided beam, rotations tell (far_bending.hpp).
LeftOut compare_variants(const TrustedRun& run);

// The same mechanism with something that it leaves out. What that changes needs no fine steps: it is
// looked for at twice the step, where that can be simulated.

/// What variants are compared with: the run with twice the step, which is made once, or the one that
/// is judged.
const Analysis& basis_of_variants(const TrustedRun& run);

/// The problem of that run.
const ProblemFile& problem_of_variants(const TrustedRun& run);

/// A variant, with the instants of the basis.
/// @throws SimulationError
std::unique_ptr<Analysis> analyze_variant(const TrustedRun& run, const ProblemFile& variant);

}  // namespace pleuel
