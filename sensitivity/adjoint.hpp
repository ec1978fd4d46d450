#pragma once

#include <functional>

#include "core/integration/simulate.hpp"

namespace pleuel {

/// Derivatives of several functions with respect to one instant: of the form of derivatives of an
/// instant, with one column a function.
using StateAdjoint = StateSensitivity;

/// Called for each step from the last to the first: adds the derivatives of the functions with
/// respect to this very instant.
/// @returns how many columns, counted from the first, depend on this or a later instant
using FunctionDerivatives = std::function<int(int step, const State& state, StateAdjoint& adjoint)>;

/// The discrete adjoint: the map of sensitivities from step to step that differentiate()
/// (direct.hpp) goes forwards, transposed and in reverse time. The same gradient up to round-off,
/// with one solution a step for each function instead of one for each design variable. With y = J⁻ᵀ
/// of the derivatives with respect to the unknowns of a step
///     dJ/dx = Σ_steps −yᵀ [ s R_x ; c Φ_x ] + (derivatives at the start)ᵀ s₀
/// where R_x is summed up by what the derivatives of the data are multiplied with (term.hpp), so
/// that the cost does not grow with the number of variables.
/// @param trajectory  of simulate() for the same mechanism
/// @param functions   how many there are
/// @returns variables × functions, without what the functions depend on x directly
/// @throws SimulationError if a step matrix is singular
Eigen::MatrixXd adjoint_gradients(Mechanism& mechanism, const Trajectory& trajectory, int functions,
                                  const FunctionDerivatives& derivatives);

}  // namespace pleuel
