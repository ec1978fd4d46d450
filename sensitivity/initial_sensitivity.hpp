#pragma once

#include <string>
#include <vector>

#include "core/integration/simulate.hpp"
#include "core/integration/state_sensitivity.hpp"
#include "core/scene/problem_file.hpp"
#include "core/start/initial_state.hpp"

namespace pleuel {

/// Derivatives of the consistent initial values: assembly, velocity projection and initial
/// accelerations are differentiated as they are computed (implicit function theorem), the curvature
/// of the constraints included.
StateSensitivity initial_sensitivity(Mechanism& mechanism, const InitialState& initial);

/// Derivatives of the values from which the first step sets out
/// (core/integration/damped_start.hpp).
StateSensitivity first_step_sensitivity(Mechanism& mechanism, const Trajectory& trajectory,
                                        const State& start, StateSensitivity initial);

/// A sentence for each variable with equal bounds whose derivatives are not those of the mechanism:
/// it would move a place along an elastic beam (core/scene/scene_rules.hpp).
std::vector<std::string> unknown_derivatives(const ProblemFile& problem, const Design<double>& x);

}  // namespace pleuel
