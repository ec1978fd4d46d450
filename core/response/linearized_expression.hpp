#pragma once

#include "core/response/analysis.hpp"
#include "core/response/expression_value.hpp"

namespace pleuel {

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
