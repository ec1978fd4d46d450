#pragma once

#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// What is behind a finding. What is wrong in one class makes numbers wrong that those after it look at.
enum class Cause {
  unit,           ///< a number that lacks its unit, or has another one than meant
  mobility,       ///< what moves, and from where, is not what is meant, or not what the steps see
  limit,          ///< a limit that is far from what is reached
  not_modelled,   ///< the motion leaves what the equations are for
  unstable,       ///< what moves so would buckle or flutter
  not_converged,  ///< steps or elements are too large
  left_out        ///< an effect that is not built
};

/// Something that speaks against numbers that came out of a simulation without complaint.
struct Finding {
  std::string text;  ///< a sentence: what, where, how far, and what to do about it
  /// The numbers are not to be trusted (more than 1 % off, or of another mechanism than meant): no
  /// design that rests on them is `verified`.
  bool is_serious = false;
  /// Names of the responses that it concerns; empty: all.
  std::vector<std::string> responses{};
  /// Names of bodies that stand in it for not being held or driven as a mechanism's are: drawn red.
  std::vector<std::string> bodies{};
  Cause cause = Cause::left_out;
};

/// Sorts findings by class, within a class the serious ones first: so the cause is told before what
/// follows from it.
void rank_findings(std::vector<Finding>& findings);

/// How many of ranked findings follow from those before them: those of lower classes than the highest
/// one with a serious finding, or with numbers that lack a unit.
int count_consequences(const std::vector<Finding>& findings);

/// Findings of several load cases, one list a case, as one list, ranked.
std::vector<Finding> joined_findings(const ProblemFile& problem,
                                     const std::vector<std::vector<Finding>>& of_cases);

}  // namespace pleuel
