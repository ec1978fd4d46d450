#include "core/integration/newton_corrector.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {

namespace {

/// Factors are renewed where the corrections shrink by less than this.
constexpr double slow_rate = 0.1;
/// Scaled corrections below this that no longer shrink are round-off.
constexpr double round_off = 1e-9;
/// The error that one iteration leaves is foreseen from those of other steps, in the coordinates:
/// stiff members make more of it in the forces of joints, and many steps add it up.
constexpr double foreseen_safety = 10.0;

}  // namespace

NewtonCorrector::NewtonCorrector(const Mechanism& mechanism, const StepEquations& equations,
                                 const TimeIntegration& options)
    : scale_(mechanism.scale),
      tolerance_(options.newton_tolerance),
      max_iterations_(options.max_newton_iterations),
      equations_of_system_(mechanism.system->size()),
      matrix_(equations.make_matrix()),
      solver_(matrix_, mechanism.elastic),
      correction_(equations.size()),
      residual_(equations.size()) {}

std::optional<StepFailure> NewtonCorrector::correct(StepEquations& equations, StepState& state,
                                                    Trust trust) {
  bool is_stale = true;
  double previous = 0.0;
  for (int iteration = 1; iteration <= max_iterations_; ++iteration) {
    ++iterations_;
    iterations_of_step_ = iteration;
    const bool is_fresh = is_stale;
    if (!is_stale) {
      equations.residual(state, residual_);
    } else if (!linearize(equations, state)) {
      return StepFailure{"the step matrix is singular", iteration};
    }
    correction_ = -residual_;
    solver_.solve(correction_);
    equations.apply(correction_, state);
    const double size = size_of_correction(state);
    if (!std::isfinite(size)) return StepFailure{"the solution is not finite", iteration};
    double error = std::min(size, foreseen_safety * experience_.curvature * size * size);
    if (iteration > 1) {
      error = size * std::min(1.0, size / previous);
      if (iteration == 2) record_curvature(size / (previous * previous));
    } else if (trust == Trust::none) {
      error = size;  // go on, to see the curvature
    }
    if (error <= tolerance_) return std::nullopt;
    const bool is_slow = iteration > 1 && size > slow_rate * previous;
    if (is_slow && is_fresh && size < round_off) return std::nullopt;
    is_stale = is_slow;
    previous = size;
  }
  return StepFailure{"Newton's method does not converge", max_iterations_};
}

bool NewtonCorrector::linearize(StepEquations& equations, const StepState& state) {
  equations.linearize(state, residual_, matrix_);
  if (!solver_.factorize(matrix_)) return false;
  record_condition();
  return true;
}

double NewtonCorrector::size_of_correction(const StepState& state) const {
  const Eigen::Index n = scale_.size();
  const double size = correction_.head(n).cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
  if (state.shift.size() == 0) return size;
  const auto shift = correction_.segment(equations_of_system_, n);
  return std::max(size, shift.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>());
}

void NewtonCorrector::record_curvature(double seen) {
  double& curvature = experience_.curvature;
  curvature = std::isfinite(curvature) ? std::max(seen, 0.5 * curvature) : seen;
}

void NewtonCorrector::record_condition() {
  if (solver_.reciprocal_condition() > 0.5 * experience_.worst_pivots) return;
  experience_.worst_pivots = solver_.reciprocal_condition();
  worst_condition_ = std::max(worst_condition_, solver_.condition());
}

std::string equation_text(Eigen::Index equation, const std::vector<std::string>& names) {
  return equation < std::ssize(names) ? " of " + names[equation] : "";
}

std::string worst_equation(const Eigen::Ref<const Eigen::VectorXd>& residual,
                           const std::vector<std::string>& names) {
  Eigen::Index worst = 0;
  residual.cwiseAbs().maxCoeff(&worst);
  return equation_text(worst, names);
}

namespace {

[[noreturn]] void stop(const StepPlace& place, const std::string& why) {
  throw SimulationError(fmt::format("simulation stopped at t = {:.6g} s (step {} of {}{}",
                                    place.time, place.step, place.steps, why),
                        place.time);
}

}  // namespace

void throw_failed(const StepPlace& place, const StepFailure& failure, double step,
                  double largest_residual, const std::string& equation, double regular_step) {
  stop(place, fmt::format(
                  ", Newton iteration {}): {}, also with a step of {:.3g} s; largest residual "
                  "{:.3g}{}. Try a smaller /simulation/step (now {:.3g} s), or look for a position "
                  "in which the mechanism locks",
                  failure.iteration, failure.what, step, largest_residual, equation, regular_step));
}

void throw_inaccurate(const StepPlace& place, double step, double error,
                      const std::string& equation) {
  stop(place, fmt::format("): with a step of {:.3g} s the local error{} is still {:.3g} times what "
                          "/simulation/local_error allows. Allow more, or a smaller "
                          "/simulation/smallest_step; or look for something that jumps there",
                          step, equation, error));
}

void throw_not_finite(const StepPlace& place, const std::string& equation) {
  stop(place, fmt::format("): the state{} is not finite. Look for numbers of the file that are out "
                          "of proportion (sizes, densities, stiffness, units)",
                          equation));
}

void throw_drifted(const StepPlace& place, double drift, const std::string& equation) {
  stop(place, fmt::format("): constraints have drifted, those{} by {:.3g} m or rad. Try another "
                          "/simulation/formulation, or /simulation/projection",
                          equation, drift));
}

}  // namespace pleuel
