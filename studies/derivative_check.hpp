#pragma once

#include <functional>
#include <vector>

#include "core/response/analysis.hpp"
#include "studies/derivative_verdict.hpp"

namespace pleuel {

/// How well values and derivatives of one response can be trusted.
struct DerivativeCheck {
  /// The smallest over all steps, relative: see gradient_error() of relative_error.hpp.
  double error = 0.0;
  double step = 0.0;            ///< relative step of the differences where that was
  double adjoint_error = 0.0;   ///< of the adjoint method against direct differentiation, relative
  double noise = 0.0;           ///< of the value [SI]: see ResponseNoise::floor()
  double relative_noise = 0.0;  ///< of it; at least the round-off of one number
  std::vector<JudgedDerivative> variables;  ///< one a variable

  /// The variable whose derivative is worst: by verdict, then by error.
  std::size_t worst_variable() const;
  DerivativeVerdict verdict() const { return variables[worst_variable()].verdict; }
};

struct DerivativeCheckOptions {
  int threads = 1;  ///< simulations at a time
  /// Called before the differences of a step are computed.
  std::function<void(double step)> see_step = [](double) {};
};

/// Compares direct differentiation with central differences of relative steps from 1e-3 to 1e-6,
/// and while some derivative differs or drowns in noise, of 1e-7, 1e-2 and 1e-8; with the adjoint
/// method; and the values with their neighbours for noise. A step at which a simulation fails is
/// left out.
///
/// Newton's method that stops early leaves an error that varies smoothly with the design: no
/// scatter shows it, and differences see its derivative where the gradient does not. Where some
/// derivative differs, all is repeated with a `newton_tolerance` of 1e-12 (or 1e-10, if that is
/// not reached): a derivative that is right then is `noise`, if it is that of this design at all.
/// @param analysis  of the problem at x, which has at least one variable
/// @throws SimulationError if the differences of all steps fail
std::vector<DerivativeCheck> check_derivatives(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               Analysis& analysis,
                                               const DerivativeCheckOptions& options = {});

}  // namespace pleuel
