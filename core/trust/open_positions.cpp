#include "core/trust/open_positions.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/linear/free_deformations.hpp"
#include "core/mechanism/configuration.hpp"
#include "core/model/model.hpp"
#include "core/start/assembly.hpp"

namespace pleuel {

namespace {

/// Of a length of the mechanism, and of a radian.
constexpr double small_placement = 0.01;
/// What counts in another measure: so many times as much as it does.
constexpr double other_measure = 16.0;

Eigen::VectorXd assembled_positions(Mechanism& mechanism) {
  System::Matrix matrix = mechanism.system->make_matrix();
  LinearSolver solver(matrix, mechanism.elastic);
  return assemble(mechanism, solver, matrix).state.q;
}

/// How far one placement is from another, relative to the scales; elastic coordinates left out.
Eigen::VectorXd placement_change(const Mechanism& mechanism, const Eigen::VectorXd& to,
                                 const Eigen::VectorXd& from) {
  Eigen::VectorXd change =
      pleuel::difference(mechanism.rotations, to, from).cwiseQuotient(mechanism.scale).cwiseAbs();
  change(mechanism.elastic).setZero();
  return change;
}

/// Coordinates of frames that another measure counts more: those of angles, or of one direction.
/// @param kind  0 … 2: directions of translations; 3: rotations
std::vector<int> counted_more(const Model& model, int kind) {
  std::vector<int> coordinates;
  for (const BodyModel& body : model.bodies) {
    const BodyFrame& frame = body.frame;
    const int first = frame.offset, turns = frame.offset + frame.translations();
    if (kind < frame.translations()) coordinates.push_back(first + kind);
    for (int i = 0; kind == 3 && i < frame.rotations(); ++i) coordinates.push_back(turns + i);
  }
  return coordinates;
}

/// The same mechanism, placed by another measure; where it was placed if that cannot be.
Eigen::VectorXd placed_otherwise(Model& model, int kind, const Eigen::VectorXd& placed) {
  Mechanism& mechanism = model.mechanism;
  const Eigen::VectorXd weight = mechanism.assembly_weight;
  mechanism.assembly_weight(counted_more(model, kind)) *= other_measure;
  Eigen::VectorXd other = placed;
  try {
    other = assembled_positions(mechanism);
  } catch (const SimulationError&) {
    // So far away that it cannot be assembled like that.
  }
  mechanism.assembly_weight = weight;
  return other;
}

/// @param coordinate  of a frame
std::string text_of(const Model& model, Eigen::Index coordinate, const Eigen::VectorXd& placed,
                    const Eigen::VectorXd& other) {
  const Mechanism& mechanism = model.mechanism;
  const auto owner =
      std::find_if(model.bodies.begin(), model.bodies.end(), [&](const BodyModel& body) {
        const Eigen::Index in_frame = coordinate - body.frame.offset;
        return in_frame >= 0 && in_frame < body.frame.size();
      });
  const bool is_angle = coordinate - owner->frame.offset >= owner->frame.translations();
  const auto moved = [&](const Eigen::VectorXd& q) {
    return pleuel::difference(mechanism.rotations, q, mechanism.guess.q)(coordinate);
  };
  return fmt::format(
      "joints and drives do not let bodies begin where the file places them, and leave open where "
      "else: \"{}\" begins {:.3g} {} away, the closest by a measure of lengths and angles that "
      "goes by the size of the mechanism where variables start; by another one it would be {:.3g} "
      "{}. Place the bodies as joints and drives have them at t = 0, or let a drive begin where "
      "they stand.",
      owner->name, moved(placed), is_angle ? "rad" : "m", moved(other), is_angle ? "rad" : "m");
}

}  // namespace

std::vector<Finding> check_open_positions(const TrustedRun& run) {
  // A motion that repeats itself is not told where it begins.
  if (run.analysis.trajectory.periodic) return {};
  const Mechanism& asked = run.analysis.model.mechanism;
  State begin;
  run.analysis.trajectory.states->load(0, begin);
  if (asked.scale.size() == 0 ||
      placement_change(asked, begin.q, asked.guess.q).maxCoeff() <= small_placement) {
    return {};
  }
  const Eigen::VectorXd start = start_design(run.problem);
  Model model = build_model(run.problem.scene, run.problem.effects,
                            Design<double>(start.begin(), start.end()),
                            Design<double>(run.x.begin(), run.x.end()));
  Mechanism& mechanism = model.mechanism;
  const Eigen::VectorXd placed = assembled_positions(mechanism);
  if (placement_change(mechanism, placed, mechanism.guess.q).maxCoeff() <= small_placement) {
    return {};
  }
  State at = mechanism.guess;
  at.q = placed;
  if (rigid_motions(mechanism, constraint_rows(mechanism, at)).cols() == 0) return {};
  double largest = small_placement;
  std::optional<std::string> text;
  for (const int kind : {0, 1, 2, 3}) {
    const Eigen::VectorXd other = placed_otherwise(model, kind, placed);
    Eigen::Index worst = 0;
    const double change = placement_change(mechanism, other, placed).maxCoeff(&worst);
    if (!(change > largest)) continue;
    largest = change;
    text = text_of(model, worst, placed, other);
  }
  if (!text) return {};
  return {{*text, true}};
}

}  // namespace pleuel
