#pragma once

#include <vector>

#include "core/response/analysis.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// How much another simulation changes a response, relative.
struct ResponseChange {
  /// To what it is in the reference, or a hundredth of the largest in its history where that is near
  /// zero.
  double of_value = 0.0;
  /// The same, or a tenth of its limits where these are far away.
  double beside_limits = 0.0;
};

/// One a response.
/// - Coordinates, whose zero is arbitrary (positions, angles, lengths of springs), are compared with
///   how far they move from where the file draws them.
/// - Damage by fatigue is compared with itself alone, and so are formulas, which may be a difference
///   of large parts.
///
/// Round-off, and monitors (balance of energy, drift of constraints), change by 0.
std::vector<ResponseChange> response_changes(const ProblemFile& problem, const Analysis& reference,
                                             const Analysis& other);

}  // namespace pleuel
