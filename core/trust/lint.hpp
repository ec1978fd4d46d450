#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Variables whose range says nothing of how far they may go, since one bound is far from both the
/// start and the other bound: other starts, step lengths and scales of a search are taken from it.
std::vector<Finding> check_far_bounds(const ProblemFile& problem);

/// What is said of a value [SI] that is so far beyond the limit of a response; nothing if it is not.
std::optional<std::string> far_limit_text(const ProblemFile& problem,
                                          const ConstraintSettings& constraint, double value);

/// Limits that the value exceeds (or, of lower ones, misses) more than ten-thousandfold: a plain
/// number is in SI units, so that a stress limit of 80 is 80 Pa.
std::vector<Finding> check_far_limits(const TrustedRun& run);

/// Beams close to the global z axis whose direction is a matter of the design, without a `reference`:
/// local y lies in the x–y plane by default, so that the section turns with the smallest inclination,
/// and by 90 degrees where the beam is exactly along z. Not for sections that bend alike both ways.
std::vector<Finding> check_section_axes(const TrustedRun& run);

/// Places of joints and loads so near to an end of an elastic beam, a boundary of its segments or
/// another place that no node of the mesh is there (core/scene/beam_mesh.hpp): section forces do not
/// know what lies between both.
std::vector<Finding> check_lost_places(const TrustedRun& run);

}  // namespace pleuel
