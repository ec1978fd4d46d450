#include "core/integration/step_messages.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {

namespace {

std::string place_text(const StepPlace& place) {
  return fmt::format("t = {:.6g} s (step {} of {}", place.time, place.step, place.steps);
}

}  // namespace

std::string equation_text(Eigen::Index equation, const std::vector<std::string>& names) {
  return equation < std::ssize(names) ? " of " + names[equation] : "";
}

std::string worst_equation(const Eigen::Ref<const Eigen::VectorXd>& residual,
                           const std::vector<std::string>& names) {
  Eigen::Index worst = 0;
  residual.cwiseAbs().maxCoeff(&worst);
  return equation_text(worst, names);
}

void throw_failed(const StepPlace& place, const StepFailure& failure, double step,
                  double largest_residual, const std::string& equation, double regular_step) {
  throw SimulationError(fmt::format(
      "simulation stopped at {}, Newton iteration {}): {}, nor with a step of {:.3g} s; largest "
      "residual {:.3g}{}. Try a smaller /simulation/step (now {:.3g} s), or look for a position in "
      "which the mechanism locks",
      place_text(place), failure.iteration, failure.what, step, largest_residual, equation,
      regular_step));
}

void throw_inaccurate(const StepPlace& place, double step, double error,
                      const std::string& equation) {
  throw SimulationError(fmt::format(
      "simulation stopped at {}): with a step of {:.3g} s the local error{} is still {:.3g} times "
      "what /simulation/local_error allows. Allow more, or a smaller /simulation/smallest_step; or "
      "look for something that jumps there",
      place_text(place), step, equation, error));
}

void throw_not_finite(const StepPlace& place, const std::string& equation) {
  throw SimulationError(fmt::format(
      "simulation stopped at {}): the state{} is not finite. Look for numbers of the file that are "
      "out of proportion (sizes, densities, stiffness, units)",
      place_text(place), equation));
}

void throw_drifted(const StepPlace& place, double drift, const std::string& equation) {
  throw SimulationError(fmt::format(
      "simulation stopped at {}): constraints have drifted, those{} by {:.3g} m or rad. Try "
      "another /simulation/formulation, or /simulation/projection",
      place_text(place), equation, drift));
}

}  // namespace pleuel
