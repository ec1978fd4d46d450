#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/scene/problem_reader.hpp"
#include "tests/support/files.hpp"

namespace pleuel::test {

/// The round slider-crank with coarse steps and only its ramp: a simulation takes milliseconds,
/// and the most robust of the backends needs few of them.
inline ProblemFile quick_problem(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"/simulation/step=0.2 ms", "/simulation/end_time=20 ms",
                                        "/scene/joints/bearing/drive/ramp=20 ms",
                                        "/optimizer/backend=nlopt-mma"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return read_problem(source_folder() + "/problems/slider_crank_round.json", overrides).complete();
}

/// What the command accuracy tries.
inline AccuracySettings grid(std::vector<double> steps, std::vector<int> elements, double target) {
  AccuracySettings settings;
  settings.steps = std::move(steps);
  settings.elements = std::move(elements);
  settings.target = target;
  return settings;
}

/// The quick problem with such a grid.
inline ProblemFile graded_problem(std::vector<double> steps, std::vector<int> elements,
                                  double target = 1e-2, const std::vector<std::string>& more = {}) {
  ProblemFile problem = quick_problem(more);
  problem.accuracy = grid(std::move(steps), std::move(elements), target);
  return problem;
}

}  // namespace pleuel::test
