#include "core/trust/misaligned_joints.hpp"

#include <algorithm>

#include "core/response/misalignment.hpp"

namespace pleuel {

namespace {

/// Nobody means less; more may be the breadth of a bearing.
constexpr double hardly_meant = 1e-3;
/// Of joints that lock a body altogether.
constexpr double locking = 3e-2;
/// Of the scale of a coordinate.
constexpr double stands_still = 1e-3;

bool moves(const BodyModel& body, const TrustedRun& run) {
  const Trajectory& trajectory = run.analysis.trajectory;
  const Eigen::VectorXd& scale = run.analysis.model.mechanism.scale;
  State state, start;
  trajectory.load(0, start);
  for (int step = 1; step <= trajectory.steps(); ++step) {
    trajectory.load(step, state);
    const Eigen::VectorXd way = (state.q - start.q).cwiseQuotient(scale);
    if (way.segment(body.frame.offset, body.frame.size()).lpNorm<Eigen::Infinity>() >
        stands_still) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Doubt> doubt_misaligned_joints(const TrustedRun& run) {
  State start;
  run.analysis.trajectory.load(0, start);
  const Model& model = run.analysis.model;
  std::vector<Doubt> doubts;
  for (const Misalignment& found : find_misalignments(model, start, locking)) {
    const bool is_locked = std::none_of(
        found.bodies.begin(), found.bodies.end(),
        [&](const std::string& name) { return moves(*model.parts(name).front(), run); });
    if (found.size > hardly_meant && !is_locked) continue;
    doubts.push_back({found.text(), true});
  }
  return doubts;
}

}  // namespace pleuel
