#pragma once

#include <string>
#include <vector>

#include "core/trust/check_list.hpp"
#include "core/trust/sideways_buckling.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test {

/// What is said of a scene's bending and of its compression.
inline std::vector<Finding> buckling_findings_of(const std::string& text) {
  const ProblemFile problem = read_scene(text);
  std::vector<Finding> findings = findings_of(problem, check_sideways_buckling);
  for (const Finding& finding : findings_of(problem, check_stability)) findings.push_back(finding);
  return findings;
}

}  // namespace pleuel::test
