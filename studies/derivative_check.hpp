#pragma once

#include <functional>
#include <vector>

#include "core/response/analysis.hpp"
#include "studies/derivative_verdict.hpp"

namespace pleuel {

/// Some variables that change together, each by a generic part of its scale.
struct CheckedDirection {
  std::vector<Eigen::Index> variables;
  /// Change of each variable of the problem for a relative step of 1 [its SI unit]; 0 of the others.
  Eigen::VectorXd change;
};

/// How well values and derivatives of one response can be trusted.
struct DerivativeCheck {
  double adjoint_error = 0.0;   ///< of the adjoint method against direct differentiation, relative
  double noise = 0.0;           ///< of the value [SI]: see ResponseNoise::floor()
  double relative_noise = 0.0;  ///< of it; at least the round-off of one number
  Eigen::VectorXd derivatives;  ///< by each variable [SI]
  /// One a direction: derivatives by the relative step along it [SI unit of the response].
  std::vector<JudgedDerivative> directions;

  /// The direction whose derivative is worst: by verdict, then by error.
  std::size_t worst_direction() const;
  const JudgedDerivative& worst() const { return directions[worst_direction()]; }
};

struct DerivativeChecks {
  std::vector<CheckedDirection> directions;  ///< each variable is in one of them
  std::vector<DerivativeCheck> responses;
};

struct DerivativeCheckOptions {
  int threads = 1;  ///< simulations at a time
  /// Called before so many simulations of differences.
  std::function<void(int simulations)> see_differences = [](int) {};
};

/// Compares direct differentiation with central differences of relative steps from 1e-3 to 1e-6,
/// and where some derivative differs or drowns in noise, of 1e-7, 1e-2 and 1e-8; with the adjoint
/// method; and the values with their neighbours for noise. A step at which a simulation fails is
/// left out.
///
/// All variables change together, by generic numbers: one wrong derivative shows in the derivative
/// along them. Where that differs, both halves of the variables are tried by themselves, and so on
/// down to single variables: the work grows with the logarithm of their number for each one that is
/// wrong (group testing: Dorfman 1943).
///
/// Newton's method that stops early leaves an error that varies smoothly with the design: no
/// scatter shows it, and differences see its derivative where the gradient does not. Where some
/// derivative differs, all is repeated with a `newton_tolerance` of 1e-12 (or 1e-10, if that is
/// not reached): a derivative that is right then is `noise`, if it is that of this design at all.
/// @param analysis  of the problem at x, which has at least one variable
/// @throws SimulationError if the differences of all steps fail
DerivativeChecks check_derivatives(const ProblemFile& problem, const Eigen::VectorXd& x,
                                   Analysis& analysis, const DerivativeCheckOptions& options = {});

}  // namespace pleuel
