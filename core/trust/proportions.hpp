#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Sizes that can hardly be meant, by name and place in the file: few points far away from all
/// others (a hundred times the size of the rest), sections larger than their beam is long or beams
/// five thousand times as long as they are thick, densities and moduli of no solid, inertia of a
/// body ten times as large as the mechanism, drives beyond 1000 rad/s that move a body beyond 50 m/s, gravity of
/// no planet. Most often a unit is missing.
std::vector<Finding> check_proportions(const TrustedRun& run);

/// The same of a design that need not be simulated.
std::vector<Finding> check_proportions_before(const ProblemFile& problem, const Eigen::VectorXd& x);

}  // namespace pleuel
