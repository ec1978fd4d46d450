#pragma once

#include "cli/text/json.hpp"
#include "sensitivity/constant_gradients.hpp"
#include "studies/derivative_check.hpp"

/// What check has to say of values and derivatives.
namespace pleuel {

/// [{VARIABLE: change for a relative step of 1}]
Json directions_document(const ProblemFile& problem,
                         const std::vector<CheckedDirection>& directions);

/// Of one response: {"verdict", "error", "difference_step", "adjoint_error", "noise",
/// "digits", "variables", "directions"}
/// @param directions  of the check
Json derivative_document(const ProblemFile& problem,
                         const std::vector<CheckedDirection>& directions,
                         const DerivativeCheck& check);

/// A line for each response, then one for each derivative that does not agree.
std::string derivatives_text(const ProblemFile& problem, const Analysis& analysis,
                             const DerivativeChecks& checks);

/// A sentence for each objective or limited response whose noise is above the optimizer's
/// tolerance, with what to do. Noise of a limited response is relative to the larger one of value
/// and limit, as an optimizer sees it.
std::vector<std::string> noise_warnings(const ProblemFile& problem, const Analysis& analysis,
                                        const std::vector<DerivativeCheck>& checks);

/// {"body", "responses": {NAME: {"unit", "invariants", "places", "stress", "stiffening"}}}: derivatives in the arrangement
/// of a file of invariants (docs/invariants.md).
Json constant_gradients_document(const ProblemFile& problem, const std::string& body,
                                 const ConstantGradients& gradients);

/// What one percent more of all inertia, stiffness or damping of the body changes of each response, a row each.
std::string constant_gradients_text(const ProblemFile& problem, const std::string& body,
                                    const ConstantGradients& gradients,
                                    const Eigen::VectorXd& values);

}  // namespace pleuel
