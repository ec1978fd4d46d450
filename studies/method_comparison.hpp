#pragma once

#include "core/base/stopwatch.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// What one method of gradients takes and brings, at one step if it has steps.
struct ComparedMethod {
  GradientMethod method;
  double step = 0.0;  ///< relative, of differences; 0: the method has none
  /// Beside the simulation of the design itself: of exact methods processor time, of differences
  /// wall time, the median over the steps, as all take the same simulations.
  double seconds = 0.0;
  /// Of the adjoint beside direct differentiation, in turns.
  std::optional<ComparedTime> beside_direct = {};
  Eigen::VectorXd errors;  ///< one a response: see gradient_error() of relative_error.hpp
};

struct MethodComparisonOptions {
  int threads = 1;  ///< simulations at a time
  /// Called before the differences of a step are computed.
  std::function<void(double step)> see_step = [](double) {};
};

/// The exact methods, each measured against the other, and both differences with relative steps
/// from 1e-2 to 1e-8, measured against direct differentiation. A step at which a simulation fails
/// is left out; whoever stops it gets what was done.
/// @param analysis  of the problem at x, which has at least one variable
std::vector<ComparedMethod> compare_methods(const ProblemFile& problem, const Eigen::VectorXd& x,
                                            Analysis& analysis,
                                            const MethodComparisonOptions& options = {});

}  // namespace pleuel
