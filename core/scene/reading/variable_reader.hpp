#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"

namespace pleuel {

/// Names of the design variables, in order.
std::vector<std::string> variable_names(const JsonNode& root);

/// Start values and bounds, once `numbers` has seen where the variables are used: that tells their
/// quantities. Every variable must be used, and every number bound to one must keep to its range at
/// the start value and at both bounds. @throws InputError
std::vector<DesignVariable> read_variables(const JsonNode& node, const NumberReader& numbers);

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
