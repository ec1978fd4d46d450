#pragma once

#include <string>
#include <vector>

#include "core/integration/newton_corrector.hpp"

/// What a simulation says that cannot go on.
namespace pleuel {

/// Where it is.
struct StepPlace {
  double time;  ///< [s]
  int step, steps;
};

/// " of the body \"rod\"": what the largest entry of a residual belongs to.
/// @param names  of equations (Mechanism::equation_names); empty text where there are none
std::string worst_equation(const Eigen::Ref<const Eigen::VectorXd>& residual,
                           const std::vector<std::string>& names);
/// The same for one equation.
std::string equation_text(Eigen::Index equation, const std::vector<std::string>& names);

/// @param step          that was tried last [s]
/// @param regular_step  [s]
[[noreturn]] void throw_failed(const StepPlace& place, const StepFailure& failure, double step,
                               double largest_residual, const std::string& equation,
                               double regular_step);
/// @param error  relative to what is allowed
[[noreturn]] void throw_inaccurate(const StepPlace& place, double step, double error,
                                   const std::string& equation);
[[noreturn]] void throw_not_finite(const StepPlace& place, const std::string& equation);
/// @param drift  [m or rad]
[[noreturn]] void throw_drifted(const StepPlace& place, double drift, const std::string& equation);

}  // namespace pleuel
