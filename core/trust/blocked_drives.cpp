#include "core/trust/blocked_drives.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/model/drive_rows.hpp"
#include "core/start/degrees_of_freedom.hpp"

namespace pleuel {

namespace {

std::string names_of_drives(const Model& model) {
  std::vector<std::string> names;
  for (const JointModel& joint : model.joints) {
    if (joint.drive_row >= 0) names.push_back(fmt::format("\"{}\"", joint.name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string blocked_drives_text(const Model& model, const State& state) {
  const std::vector<int> drives = drive_rows(model);
  const int blocked = blocked_drives(model.mechanism, state, drives);
  if (blocked == 0) return "";
  const std::string what =
      drives.size() == 1
          ? fmt::format("the joints leave no motion to the drive of {}", names_of_drives(model))
          : fmt::format("there {} more than the joints leave motions to (drives: {})",
                        blocked == 1 ? "is one drive" : fmt::format("are {} drives", blocked),
                        names_of_drives(model));
  return what +
         ": what moves does so only because bodies bend. If that is not meant, a joint has a "
         "freedom "
         "too few (fixed instead of revolute, an axis in another direction, one joint too many), "
         "or "
         "a drive is too many";
}

std::vector<Finding> check_blocked_drives(const TrustedRun& run) {
  State start;
  run.analysis.trajectory.states->load(0, start);
  const std::string text = blocked_drives_text(run.analysis.model, start);
  if (!text.empty()) return {{text}};
  if (run.analysis.rigid_path.end != RigidPath::End::bends) return {};
  return {
      {fmt::format("rigid bodies cannot follow the drive of {} from the start: what moves does "
                   "so only because bodies bend. If that is not meant, look at the axes of the "
                   "joints",
                   names_of_drives(run.analysis.model))}};
}

std::vector<Finding> check_rest(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  const Mechanism& mechanism = model.mechanism;
  const RigidPath& path = run.analysis.rigid_path;
  const bool is_driven = drive_rows(model).empty() || path.time == 0.0 || path.travel > 0.0;
  if (is_driven || !model.terms.loads.empty() || !model.gravity.isZero(0.0) ||
      !mechanism.guess.v.isZero(0.0) || !mechanism.bent_starts.empty()) {
    return {};
  }
  return {
      {fmt::format("nothing moves: the drive of {} stands still, and no load, weight or initial "
                   "velocity acts. All numbers of the motion are round-off",
                   names_of_drives(model)),
       true}};
}

}  // namespace pleuel
