#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/base/error_bar.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "core/scene/problem_file.hpp"
#include "core/trust/refined_runs.hpp"

namespace pleuel {

/// Indices of the responses whose accuracy is asked for: those that are minimized or limited, or
/// listed in the block `accuracy`; of a file that does nothing of this, all.
std::vector<std::size_t> asked_responses(const ProblemFile& problem);

/// Those of them that are no expressions, and what their expressions are made from, each once.
std::vector<std::size_t> asked_parts(const ProblemFile& problem);

/// How far a beam is deformed at most.
struct LargestDeformation {
  int bending_step = 0;  ///< instant (step of the trajectory) at which it bends most
  double bending = 0.0;  ///< rotation against the frame, without twist [rad]
  double twist = 0.0;    ///< about the axis [rad]
  double strain = 0.0;   ///< |Δu|/ℓ of an element
};

/// How much a judgement of errors may cost.
enum class Scrutiny {
  none,   ///< nothing: what speaks against the numbers is not looked for
  usual,  ///< about as much as the simulation, if nothing is suspicious
  close   ///< three times as much more: with half the step and twice the elements
};

/// The same design in larger steps (coarse_runs.hpp).
struct CoarseRuns {
  NestedRun twice, four;
  bool is_four_enough = false;  ///< to compare variants with
};

/// What several findings ask for, each made when the first of them does.
struct SharedFindings {
  std::optional<CoarseRuns> coarse{};
  std::optional<std::vector<bool>> is_round_off{};  ///< round_off.hpp
  /// Values of a run with short steps behind jumps, one a response; of one that was needed (check_list.hpp).
  std::optional<Eigen::VectorXd> with_short_steps{};
  std::optional<std::vector<LargestDeformation>> deformations{};  ///< bent_beams.hpp
};

/// A simulated design, and what its findings are made from.
struct TrustedRun {
  const ProblemFile& problem;
  const Eigen::VectorXd& x;  ///< design variables [SI]
  const Analysis& analysis;
  const Monitors& monitors;  ///< of the analysis
  Scrutiny scrutiny = Scrutiny::usual;
  /// Error bars that are known otherwise, as a choice of the setting knows them: one a response, or
  /// null. They hold where they are narrower, without what is due to effects.
  const std::vector<std::optional<ErrorBar>>* known = nullptr;
  std::shared_ptr<SharedFindings> shared = std::make_shared<SharedFindings>();
};

}  // namespace pleuel
