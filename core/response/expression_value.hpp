#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/expression.hpp"
#include "core/response/reduction.hpp"
#include "core/response/response.hpp"

namespace pleuel {

/// A response, and how much of its change counts.
struct WeightedResponse {
  std::size_t response;
  double weight;
};

/// What a response is made from, to first order at a design:
///     d(response) = Σ weight · d(part) + design · dx
struct LinearizedResponse {
  std::vector<WeightedResponse> parts;  ///< responses that are no expressions, each once
  Eigen::VectorXd design;               ///< explicit part, one a design variable [SI]
};

/// What expressions are evaluated with: responses by their number, and the design. What it refers to
/// has to outlive it.
struct ResponseNumbers {
  const Eigen::VectorXd& x;  ///< design variables [SI]
  /// The expression of a response, null if it is none.
  std::function<const Expression*(std::size_t response)> expression_of;
  std::function<double(std::size_t response)> value_of;  ///< of one that an expression names
  std::function<std::string(std::size_t response)> name_of;

  /// The value of an expression. @throws SimulationError where that is not finite
  double value(std::size_t response) const;

  /// By the chain rule through all expressions; of a response that is none, itself with weight 1.
  LinearizedResponse linearized(std::size_t response) const;

  /// @param what  it has not: "value"
  /// @throws SimulationError with the numbers of the responses that the expression names
  [[noreturn]] void refuse(std::size_t response, const char* what) const;

  /// Value and derivatives, finite or not.
  ExpressionValue evaluated(const Expression& expression) const;
};

/// Those of the responses of one simulation.
ResponseNumbers numbers_of(const std::vector<Response>& responses,
                           const std::vector<Reduction>& reductions, const Eigen::VectorXd& x);

}  // namespace pleuel
