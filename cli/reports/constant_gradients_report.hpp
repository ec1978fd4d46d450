#pragma once

#include <string>

#include "cli/text/json.hpp"
#include "sensitivity/constant_gradients.hpp"

namespace pleuel {

/// {"body", "responses": {NAME: {"unit", "invariants", "places", "stress", "stiffening"}}}: derivatives in the arrangement
/// of a file of invariants (docs/invariants.md).
Json constant_gradients_document(const ProblemFile& problem, const std::string& body,
                                 const ConstantGradients& gradients);

/// What one percent more of all inertia, stiffness or damping of the body changes of each response, a row each.
std::string constant_gradients_text(const ProblemFile& problem, const std::string& body,
                                    const ConstantGradients& gradients,
                                    const Eigen::VectorXd& values);

}  // namespace pleuel
