#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error_bar.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/doubt.hpp"
#include "core/trust/error_bars.hpp"

namespace pleuel {

/// How much a judgement of errors may cost.
enum class Scrutiny {
  usual,  ///< about as much as the simulation, if nothing is suspicious
  close   ///< three times as much more: with half the step and twice the elements
};

/// A simulated design, and what its doubts are made from.
struct TrustedRun {
  const ProblemFile& problem;
  const Eigen::VectorXd& x;  ///< design variables [SI]
  const Analysis& analysis;
  const Monitors& monitors;  ///< of the analysis
  Scrutiny scrutiny = Scrutiny::usual;
  /// Error bars that are known otherwise, as a choice of the setting knows them: one a response, or
  /// null. They hold where they are narrower, without what is due to effects.
  const std::vector<std::optional<ErrorBar>>* known = nullptr;
};

/// What the file alone says against the numbers to come, at its start design: known before a long
/// run, and found again after it.
std::vector<Doubt> find_doubts_before(const ProblemFile& problem);

/// How far the numbers of a simulated design can be trusted.
struct Trust {
  std::vector<Doubt> doubts;  ///< the serious ones first
  /// One a response, none of those that are errors themselves or round-off; empty where the file
  /// leaves the check of resolution out.
  std::vector<std::optional<ErrorBar>> errors;
  std::vector<std::optional<Evidence>> evidence;  ///< of the errors by steps and elements
  std::vector<Eigen::VectorXd> bands;             ///< of histories (error_bands.hpp)
};

Trust judge_run(const TrustedRun& run);

/// All doubts about a simulated design, the serious ones first; every
/// command that shows numbers shows them. Each kind of doubt has a file of its own beside this one.
std::vector<Doubt> find_doubts(const TrustedRun& run);

/// The same with monitors of its own.
std::vector<Doubt> find_doubts(const ProblemFile& problem, const Eigen::VectorXd& x,
                               const Analysis& analysis);

/// Their sentences.
std::vector<std::string> texts_of(const std::vector<Doubt>& doubts);

/// Whether one of them is serious.
bool has_serious(const std::vector<Doubt>& doubts);

}  // namespace pleuel
