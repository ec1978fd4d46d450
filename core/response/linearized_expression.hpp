#pragma once

#include <vector>

#include "core/response/analysis.hpp"

namespace pleuel {

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

/// By the chain rule through all expressions; of a response that is none, itself with weight 1.
LinearizedResponse linearized(const Analysis& analysis, std::size_t response);

/// @throws SimulationError where a response has no finite derivative, as sqrt(x) at 0
void require_derivatives(const Analysis& analysis, std::size_t response);

/// What errors of a response are small beside: the largest magnitude in its history, of an
/// expression the largest share that one of its parts has in it; else its value.
double magnitude_of(const Analysis& analysis, std::size_t response);

/// Whether it has a history, or is made from a response that has one.
bool depends_on_motion(const Analysis& analysis, std::size_t response);

}  // namespace pleuel
