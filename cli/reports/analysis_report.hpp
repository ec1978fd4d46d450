#pragma once

#include "cli/reports/warnings.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"

/// What simulate, gradient and check have in common to say of one simulated design.
namespace pleuel {

/// {NAME: {"value", "unit", "error", "peak"}} [SI]; without "error" where none are known, and
/// "peak" (time, place) of peaks over time only
Json responses_document(const ProblemFile& problem, const Analysis& analysis,
                        const ErrorBars& errors = {});

/// Of the mechanism as it is drawn; 0 if nothing in it moves [m].
double size_of(const Model& model);

/// The value of a response for people: 0 where it is round-off of its history (1e-14 of the largest
/// number in it), or a length that is round-off of the size of the mechanism.
double without_round_off(const Analysis& analysis, std::size_t response);

/// Table of values in engineering units.
std::string responses_text(const ProblemFile& problem, const Analysis& analysis,
                           const ErrorBars& errors = {});

/// {"position_drift", "velocity_drift", "energy_error", "elastic_rotation"} [SI]
Json monitors_document(const Monitors& monitors);

/// Sentences about constraints (if there are multipliers) and energy.
std::string monitors_text(const Monitors& monitors, int multipliers);

/// "4514 steps of 2.5e-05 s, 41 coordinates, 24 multipliers"
std::string size_text(const Analysis& analysis);

}  // namespace pleuel
