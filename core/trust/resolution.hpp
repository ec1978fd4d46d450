#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/trust/doubt.hpp"
#include "core/trust/error_bars.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// What a finer division of time or space changes of a response.
struct Unresolved {
  std::size_t response = 0;  ///< index
  double change = 0.0;  ///< of its value by a run of half the step, twice the elements, or more
                        ///< modes
  double error = 0.0;   ///< estimate of what is missing to the limit of fine division
  bool is_of_quarter = false;  ///< the change is that by a quarter of the step, which is larger
};

/// Responses whose estimated error is above one percent, the worst first; all errors are relative
/// (core/base/relative_error.hpp).
struct Resolution {
  std::vector<Unresolved> in_time, in_space;
  std::vector<Unresolved> in_modes;  ///< that reductions leave out
  /// One a response; none of those that are errors themselves, or round-off.
  std::vector<std::optional<ErrorBar>> bars;
  std::vector<std::optional<Evidence>> evidence;  ///< what the bars are made from
  std::vector<Eigen::VectorXd> bands;             ///< of histories (error_bands.hpp)
  std::string failure;     ///< of a finer run that could not be made; empty: none
  std::string failed_run;  ///< the same of any run that judges
};

/// Judges which responses are resolved, in two stages:
/// 1. Suspicion. A run of twice the step, and one of it with half the elements (each in two, where
///    there are only one or two, or where joints, loads or frames divide the beam anyway, so that
///    half were the same mesh), together cost about as much as the simulation; where beams are reduced,
///    one with more modes joins them. A response is suspicious
///    if the values differ by more than a percent (a percent of its error in space, of order 2), if
///    the histories differ by some percent of their largest value (peaks can agree by accident), or
///    if the history swings from step to step (ωh above some 0.6, where twice the step says
///    nothing).
/// 2. Evidence. Only if there is a suspicion, half the step, twice the elements or more modes are
///    run, and judge all responses but those that are round-off (round_off.hpp). With the order p
///    of the scheme and the observed change c the error is c / (1 − 2⁻ᵖ) (Richardson). Where the
///    change is not a fraction of the one before, as it is of a peak that rings, nothing is known
///    of the limit, and three times the change is taken. If nothing else speaks against the step
///    than some of these that are below one percent, or if half the step changes a history as much
///    as the step did, a quarter of the step is run and has the last word.
///
/// Error bars of all responses follow from the same runs (error_bars.hpp), with one of four times
/// the step, and half and a quarter of it where these say nothing of a response that counts, or
/// more than the accuracy the file asks for. Under close scrutiny half the step is always run, and
/// twice the elements at twice the step. Balances of energy and drifts of constraints are
/// errors themselves, and not judged.
Resolution judge_resolution(const TrustedRun& run);

/// Doubts from judge_resolution(). Serious beyond ten percent of a response
/// that is minimized or limited; of any in a file that minimizes nothing.
std::vector<Doubt> doubt_resolution(const TrustedRun& run, const Resolution& found);

}  // namespace pleuel
