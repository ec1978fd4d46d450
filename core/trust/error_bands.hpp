#pragma once

#include <vector>

#include "core/response/analysis.hpp"
#include "core/trust/error_bars.hpp"

namespace pleuel {

/// How far the shown history of each response (shown_history.hpp) may be from that of arbitrarily
/// fine steps and elements, at each instant: error bars (error_bars.hpp) of histories. At an
/// instant of the run with twice the step the bound is what the runs differ by there, or at the
/// instants beside it (errors of a vibration pass through zero), times what is left by the order
/// that the histories as wholes show; differences by elements, modes and Newton's tolerance come on
/// top.
/// @returns one a response, half-widths at the instants of the simulation [SI]; empty for those
/// without a history, and where the run of twice the step failed
std::vector<Eigen::VectorXd> error_bands(const Analysis& analysis, const JudgingRuns& runs,
                                         double order);

}  // namespace pleuel
