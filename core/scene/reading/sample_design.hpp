#pragma once

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A design for which the scene must make sense.
struct SampleDesign {
  Design<double> design;
  std::string where;  ///< end of a message: empty for the start design
};

/// The start values of the variables.
Design<double> start_values(const std::vector<DesignVariable>& variables);

/// The start design, then with each variable at either bound.
std::vector<SampleDesign> sample_designs(const std::vector<DesignVariable>& variables);

}  // namespace pleuel
