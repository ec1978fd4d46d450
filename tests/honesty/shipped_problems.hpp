#pragma once

#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel::test {

/// A problem file of the project, and a design where members are light and ring.
struct ShippedProblem {
  std::string name;
  std::vector<double> optimum;  ///< to four digits, as `pleuel optimize` finds it [m]; or empty
};

const std::vector<ShippedProblem>& shipped_problems();

ProblemFile read_shipped(const ShippedProblem& problem);

Eigen::VectorXd optimum_of(const ShippedProblem& problem);

}  // namespace pleuel::test
