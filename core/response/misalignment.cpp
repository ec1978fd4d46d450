#include "core/response/misalignment.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/quoted.hpp"
#include "core/model/drive_rows.hpp"
#include "core/start/redundancy.hpp"

namespace pleuel {

namespace {

/// Parts of a motion of length one that are more than round-off.
constexpr double visible = 1e-3;

std::vector<std::string> joints_of(const NearRedundancy& near, const Model& model) {
  std::vector<std::string> names;
  for (const JointModel& joint : model.joints) {
    const auto is_its = [&joint](int row) {
      return joint.first_multiplier <= row && row < joint.first_multiplier + joint.equations();
    };
    if (joint.is_division) continue;
    if (is_its(near.constraint) || std::any_of(near.others.begin(), near.others.end(), is_its)) {
      names.push_back(joint.name);
    }
  }
  return names;
}

std::vector<std::string> bodies_of(const NearRedundancy& near, const Model& model) {
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) {
    const auto part = near.motion.segment(body.frame.offset, body.frame.size());
    if (part.lpNorm<Eigen::Infinity>() <= visible) continue;
    if (names.empty() || names.back() != body.name) names.push_back(body.name);
  }
  return names;
}

}  // namespace

std::string Misalignment::text() const {
  const std::string motion =
      bodies.empty() ? "one deformation" : fmt::format("a motion of {}", quoted(bodies));
  return fmt::format(
      "the joints {} would hold {} twice if they were aligned; they are out of line by "
      "only {:.1g} (rad, or of the mechanism's size), which blocks that motion or makes the forces "
      "in them huge. Align their points and axes exactly, or let one of them free what the others "
      "hold.",
      quoted(joints), motion, size);
}

std::vector<Misalignment> find_misalignments(const Model& model, const State& state,
                                             double largest) {
  std::vector<Misalignment> found;
  for (const NearRedundancy& near :
       nearly_redundant_constraints(model.mechanism, state, drive_rows(model), largest)) {
    Misalignment misalignment{joints_of(near, model), bodies_of(near, model), near.misalignment};
    const auto same = std::find_if(found.begin(), found.end(), [&](const Misalignment& other) {
      return other.joints == misalignment.joints;
    });
    if (same == found.end()) {
      found.push_back(std::move(misalignment));
    } else if (misalignment.size < same->size) {
      *same = std::move(misalignment);
    }
  }
  return found;
}

}  // namespace pleuel
