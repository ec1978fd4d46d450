#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Beams under a pull N that bend within √(EI/N) of where they are held or loaded, far less than their
/// elements are long: with twice the elements hardly more of it is seen, so that error bars say
/// nothing of it. Serious for what is made from the bending moment, where that counts. By the
/// moment of a pulled cantilever, M = F √(EI/N) tanh(ℓ √(N/EI)): elements of length ℓ ≫ √(EI/N)
/// see about the part √(EI/N)/ℓ of it.
std::vector<Finding> check_tension_layers(const TrustedRun& run);

}  // namespace pleuel
