#pragma once

#include <string>
#include <vector>

#include "core/trust/sideways_buckling.hpp"
#include "core/trust/stability.hpp"
#include "tests/core/trust/doubts_of.hpp"

namespace pleuel::test {

/// What is said of a scene's bending and of its compression.
inline std::vector<Doubt> buckling_doubts_of(const std::string& text) {
  const ProblemFile problem = read_scene(text);
  std::vector<Doubt> doubts = doubts_of(problem, doubt_sideways_buckling);
  for (const Doubt& doubt : doubts_of(problem, doubt_stability)) doubts.push_back(doubt);
  return doubts;
}

}  // namespace pleuel::test
