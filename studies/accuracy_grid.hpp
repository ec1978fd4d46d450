#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// How finely space and time are divided.
struct Discretization {
  double step = 0.0;  ///< [s]
  int elements = 0;   ///< of every segment of every beam; 0: `factor` times those of the file
  double factor = 1.0;
};

/// The problem divided like that. A rounded number of elements is rounded up.
ProblemFile discretized(ProblemFile problem, const Discretization& settings);

/// Steps and elements that are tried: those of the file; where it names none, four times to half
/// the step, half to twice the elements.
std::vector<Discretization> accuracy_grid(const ProblemFile& problem);

/// Half the finest step of a grid, twice its most elements; more where those are the same mesh, since
/// frames divide the beams anyway.
Discretization finer_than(const ProblemFile& problem, const std::vector<Discretization>& grid);

/// 4/3 of the step, 3/4 of the elements.
Discretization slightly_coarser(Discretization settings);

/// Errors of second order between a division and a slightly coarser one tell so much of the error
/// of the finer one (Richardson): 1 / ((4/3)² − 1).
inline constexpr double richardson_share = 1.0 / (16.0 / 9.0 - 1.0);

}  // namespace pleuel
