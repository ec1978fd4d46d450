#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "core/base/expression.hpp"
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

/// A response, and how much of its change counts.
struct WeightedResponse {
  std::size_t response;
  double weight;
};

/// What a response is made from, to first order at the design of the analysis:
///     d(response) = Σ weight · d(part) + design · dx
struct LinearizedResponse {
  std::vector<WeightedResponse> parts;  ///< responses that are no expressions, each once
  Eigen::VectorXd design;               ///< explicit part, one a design variable [SI]
};

/// The derivatives of a response that is made from others by expressions of expressions: adds up by the
/// chain rule what each of those counts that are none.
class ChainedResponse {
 public:
  /// The expression of a response, none if it is no expression.
  using ExpressionOf = std::function<const Expression*(std::size_t response)>;
  /// An expression of a response, with its derivatives by its arguments.
  using Evaluated = std::function<ExpressionValue(std::size_t response, const Expression&)>;

  ChainedResponse(Eigen::Index variables, ExpressionOf expression_of, Evaluated evaluated);

  LinearizedResponse linearized(std::size_t response) &&;

 private:
  void add(std::size_t response, double weight);

  ExpressionOf expression_of_;
  Evaluated evaluated_;
  std::map<std::size_t, double> weights_;
  Eigen::VectorXd design_;
};

}  // namespace pleuel
