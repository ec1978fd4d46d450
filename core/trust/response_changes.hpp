#pragma once

#include <Eigen/Core>

#include "core/response/analysis.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// How much of each response another simulation of a problem changes, relative to the reference:
/// beside its value, or a hundredth of the largest in its history where that is near zero, or a
/// tenth of its limits.
/// - Coordinates, whose zero is arbitrary (positions, angles, lengths of springs), beside how far
///   they move from where the file draws them.
/// - Damage by fatigue beside its value alone, formulas beside theirs, which may be a difference of
///   large parts.
///
/// Round-off, and monitors (balance of energy, drift of constraints), change by 0.
Eigen::VectorXd response_changes(const ProblemFile& problem, const Analysis& reference,
                                 const Analysis& other);

}  // namespace pleuel
