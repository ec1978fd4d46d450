#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "optimization/least_violation.hpp"

/// Where a search goes on whose start leads nowhere.
namespace pleuel {

/// The start values of the variables as they are.
Eigen::VectorXd start_of(const Problem& problem);

/// The first design with gradients among those on the way from the start to the middle of the bounds
/// and, after them, others spread between the bounds.
std::optional<Eigen::VectorXd> evaluable_design(Problem& problem);

/// A design within the limits, restored from `best` (restoration.hpp) or, where that fails, from
/// those of designs spread between the bounds that break the limits least.
/// @param rows         the limits as rows that are smooth
/// @param magnitudes   of the constraints of `limits`, see scaling.hpp
std::optional<Eigen::VectorXd> design_within_limits(const LimitRows& rows, const Problem& limits,
                                                    const Eigen::VectorXd& magnitudes,
                                                    const Eigen::VectorXd& best);

}  // namespace pleuel
