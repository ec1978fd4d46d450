#include "core/trust/fast_turning.hpp"

#include <numbers>

#include <fmt/format.h>

namespace pleuel {

namespace {

/// A direction is known from what it was a step before [rad].
constexpr double most_turned = 0.5 * std::numbers::pi;

}  // namespace

std::vector<Finding> check_fast_turning(const TrustedRun& run) {
  const Trajectory& trajectory = run.analysis.trajectory;
  double most = most_turned, step_size = 0.0, time = 0.0;
  const BodyModel* fastest = nullptr;
  State state;
  for (int step = 1; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    for (const BodyModel& body : run.analysis.model.bodies) {
      const BodyFrame& frame = body.frame;
      const double speed =
          state.v.segment(frame.offset + frame.translations(), frame.rotations()).norm();
      const double turned = speed * trajectory.step_size(step);
      if (!(turned > most)) continue;
      most = turned;
      step_size = trajectory.step_size(step);
      time = trajectory.time(step);
      fastest = &body;
    }
  }
  if (fastest == nullptr) return {};
  return {
      {fmt::format("\"{}\" turns by {:.3g} deg within the step of {:.3g} s at t = {:.4g} s: what "
                   "its direction changes is not seen. Give a revolution 32 steps: a "
                   "/simulation/step of {:.2g} s.",
                   fastest->name, most * 180.0 / std::numbers::pi, step_size, time,
                   step_size * 2.0 * std::numbers::pi / (32.0 * most)),
       true}};
}

}  // namespace pleuel
