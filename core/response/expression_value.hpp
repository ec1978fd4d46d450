#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/response/reduction.hpp"
#include "core/response/response.hpp"

namespace pleuel {

/// Value and derivatives of an expression, from the numbers of the responses that it names.
/// @param x  design variables [SI]
ExpressionValue evaluate_at(const std::vector<Reduction>& reductions, const Eigen::VectorXd& x,
                            const Expression& expression);

/// Its value. @throws SimulationError where that is not finite
double expression_value(const std::vector<Response>& responses,
                        const std::vector<Reduction>& reductions, const Eigen::VectorXd& x,
                        std::size_t response);

/// @param what  it has not: "value"
/// @throws SimulationError with the numbers of the responses that the expression names
[[noreturn]] void refuse_expression(const std::vector<Response>& responses,
                                    const std::vector<Reduction>& reductions, std::size_t response,
                                    const char* what);

}  // namespace pleuel
