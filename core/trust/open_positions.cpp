#include "core/trust/open_positions.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/assembly.hpp"
#include "core/integration/configuration.hpp"
#include "core/integration/free_deformations.hpp"
#include "core/model/model.hpp"

namespace pleuel {

namespace {

/// Of a length of the mechanism, and of a radian.
constexpr double small_placement = 0.01;
/// Another measure: rotations count so many times as much beside lengths.
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
      "goes by "
      "the size of the mechanism where variables start; by another one it would be {:.3g} {}. "
      "Place "
      "the bodies as joints and drives have them at t = 0, or let a drive begin where they stand.",
      owner->name, moved(placed), is_angle ? "rad" : "m", moved(other), is_angle ? "rad" : "m");
}

}  // namespace

std::vector<Doubt> doubt_open_positions(const TrustedRun& run) {
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
  if (placement_change(mechanism, placed, mechanism.guess.q).maxCoeff() <= small_placement)
    return {};
  State at = mechanism.guess;
  at.q = placed;
  if (rigid_motions(mechanism, constraint_rows(mechanism, at)).cols() == 0) return {};
  for (const BodyModel& body : model.bodies) {
    const BodyFrame& frame = body.frame;
    mechanism.assembly_weight.segment(frame.offset + frame.translations(), frame.rotations()) *=
        other_measure;
  }
  Eigen::VectorXd other;
  try {
    other = assembled_positions(mechanism);
  } catch (const SimulationError&) {
    return {};  // so far away that its angles cannot be kept
  }
  Eigen::Index worst = 0;
  if (placement_change(mechanism, other, placed).maxCoeff(&worst) <= small_placement) return {};
  return {{text_of(model, worst, placed, other), true}};
}

}  // namespace pleuel
