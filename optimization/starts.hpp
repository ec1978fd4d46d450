#pragma once

#include <vector>

#include <Eigen/Core>

#include "optimization/problem.hpp"

namespace pleuel {

/// Designs that fill the space between the bounds evenly: a Latin hypercube (McKay, Beckman &
/// Conover 1979), each variable once in each of `count` equal parts of its range. Where a bound is
/// missing (or beyond 1e19), the range reaches ten times the larger of |start| and the magnitude of
/// the variable away from the start. The same on every machine.
/// @param seed  other designs for other seeds
/// @throws InputError names a variable without bounds, start and magnitude
std::vector<Eigen::VectorXd> latin_hypercube(const std::vector<Variable>& variables, int count,
                                             unsigned seed);

}  // namespace pleuel
