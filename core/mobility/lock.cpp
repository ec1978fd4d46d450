#include "core/mobility/lock.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/quoted.hpp"
#include "core/model/body_frames.hpp"

namespace pleuel {

namespace {

/// Of the fastest body: what is slower stands still.
constexpr double moves = 0.05;
constexpr std::size_t most_names = 4;

/// Where the drives are: "crank_pin" at 66.4°.
std::string drives_text(const Model& model, double time) {
  std::vector<std::string> places;
  for (const JointModel& joint : model.joints) {
    if (joint.drive_row < 0) continue;
    const double travel = joint.data.drive.at(time).value;
    const auto& equation = joint.topology.equations[joint.drive_row - joint.first_multiplier];
    places.push_back(
        traits_of(equation.kind).is_moment
            ? fmt::format("\"{}\" at {:.4g}°", joint.name, travel * 180.0 / std::numbers::pi)
            : fmt::format("\"{}\" at {:.4g} mm", joint.name, 1e3 * travel));
  }
  return fmt::format("{}", fmt::join(places, ", "));
}

std::vector<std::string> moving_bodies(const Model& model, const RigidPath& path) {
  const RigidConstraints constraints(model);
  const Eigen::VectorXd motion =
      constraints.expand(path.still_moves).cwiseQuotient(model.mechanism.scale).cwiseAbs();
  return moved_bodies(model, motion, moves * motion.lpNorm<Eigen::Infinity>());
}

}  // namespace

std::string lock_text(const Model& model, const RigidPath& path) {
  std::vector<std::string> names = moving_bodies(model, path);
  std::string members;
  if (names.size() > most_names) {
    members = fmt::format(" and {} more", names.size() - most_names);
    names.resize(most_names);
  }
  if (!names.empty()) {
    members = fmt::format(", in a dead centre of {}{}", quoted(names), members);
  }
  const std::string gap =
      path.gap > 0.0 ? fmt::format(" Beyond it joints of rigid bodies are about {:.2g} mm apart.",
                                   1e3 * path.gap)
                     : "";
  return fmt::format(
      "the mechanism locks at t = {:.4g} s, with {}{}.{} Change lengths or joints, end the motion "
      "before, or set /simulation/moves_by_bending to true if bodies are meant to bend by that "
      "much",
      path.time, drives_text(model, path.time), members, gap);
}

std::string names_of_drives(const Model& model) {
  std::vector<std::string> names;
  for (const JointModel& joint : model.joints) {
    if (joint.drive_row >= 0) names.push_back(joint.name);
  }
  return quoted(names);
}

std::string bending_text(const Model& model) {
  const bool has_several = drive_rows(model).size() > 1;
  return fmt::format(
      "rigid bodies cannot follow the drive of {} from the start: what moves does so only because "
      "bodies bend. If that is not meant, {}look at the places and axes of the joints",
      names_of_drives(model), has_several ? "a drive is too many, or " : "");
}

RigidPath follow_drives(const Model& model, double end, double step, const PathObserver& observer) {
  if (drive_rows(model).empty()) return {.time = end, .q = model.mechanism.guess.q};
  RigidConstraints constraints(model);
  Eigen::VectorXd start = model.mechanism.guess.q;
  start(model.mechanism.elastic).setZero();  // as bodies begin may not meet the joints yet
  return follow_drives(constraints, start, end, step, observer);
}

void require_no_lock(const Model& model, const RigidPath& path) {
  if (path.end == RigidPath::End::locks) throw LockedMechanism(lock_text(model, path));
}

}  // namespace pleuel
