#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/trust/error_bars.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// What finer and coarser divisions of time and space say of the responses.
struct Resolution {
  /// One a response; none of those that are errors themselves, or round-off.
  std::vector<std::optional<ErrorBar>> bars;
  std::vector<std::optional<Evidence>> evidence;  ///< what the bars are made from
  std::vector<Eigen::VectorXd> bands;             ///< of histories (error_bars.hpp)
  std::string failure;                            ///< of a run that could not be made; empty: none
};

/// Bars of all responses from runs of the same design (refinement_set.hpp), as few as it needs: those
/// with larger steps, and with other elements in one of them, together cost about as much as the
/// simulation. Half the step, and a quarter where that does not do, is run where these say nothing of
/// a response that counts, or where the balance of energy says that all of them may agree on having
/// seen nothing. Under close scrutiny half the step is always run, with twice the elements, and a
/// quarter where the accuracy is not what the file asks for. Balances of energy and drifts of
/// constraints are errors themselves, and not judged; round-off neither (round_off.hpp).
Resolution judge_resolution(const TrustedRun& run);

/// Findings about what the bars do not know well enough: one about the steps, one about the elements,
/// one about modes, from an estimated error of one percent on, which is half of most bars. Serious
/// from ten percent on of a response that is minimized or limited; of any in a file that
/// minimizes nothing.
std::vector<Finding> check_resolution(const TrustedRun& run, const Resolution& found);

/// Energy that comes from nowhere: steps too long for what moves, or a drive that jumps. Serious
/// from a tenth of the largest energy on: sudden loads on members that vibrate within a step give a
/// steady, wrong answer at any step that long.
std::vector<Finding> check_energy_balance(const TrustedRun& run);

}  // namespace pleuel
