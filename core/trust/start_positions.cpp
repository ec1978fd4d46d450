#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/linear/free_deformations.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/model/model.hpp"
#include "core/scene/response_parts.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/start/assembly.hpp"
#include "core/trust/check_list.hpp"

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
  const auto owner = std::ranges::find_if(model.bodies, [&](const BodyModel& body) {
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
  const State begin = run.analysis.trajectory.state_at(0);
  if (asked.scale.size() == 0 ||
      placement_change(asked, begin.q, asked.guess.q).maxCoeff() <= small_placement) {
    return {};
  }
  const Eigen::VectorXd start = start_design(run.problem);
  Model model = build_model(run.problem.scene, run.problem.effects,
                            Design<double>(start.begin(), start.end()),
                            Design<double>(run.x.begin(), run.x.end()), std::nullopt);
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

namespace {

/// Its zero is its middle: what loads a part to one side loads it to the other.
bool has_two_sides(const ResponseSettings& response) {
  const auto* section = response.as<SectionForceResponse>();
  if (section != nullptr) return section->part != SectionForcePart::axial;
  return response.is<DeflectionResponse>() || response.is(DriveNumber::torque) ||
         response.is(DriveNumber::force) || response.is(ReactionKind::moment);
}

/// Forces of one section, and of others of the beam, count as one.
bool have_one_history(const ResponseSettings& one, const ResponseSettings& other) {
  const auto anywhere = [](AnyResponse response) {
    if (auto* force = std::get_if<SectionForceResponse>(&response)) force->station.reset();
    return response;
  };
  return anywhere(one.what) == anywhere(other.what);
}

/// Whether one looks at all instants that the other looks at.
bool sees_as_long(const ResponseSettings& one, const ResponseSettings& other) {
  return (!one.from || (other.from && *one.from <= *other.from)) &&
         (!one.to || (other.to && *one.to >= *other.to));
}

/// How far a limit lets a history go to one side, +1 or -1; infinity: any way.
double reach_of(const ConstraintSettings& limit, const ResponseSettings& response, double side) {
  constexpr double any_way = std::numeric_limits<double>::infinity();
  const bool is_of_side = response.over_time == (side > 0.0 ? OverTime::max : OverTime::min) ||
                          response.over_time == OverTime::max_abs;
  if (!is_of_side) return any_way;
  const bool has_signed_bound = response.over_time == OverTime::min;
  const std::optional<double>& bound = has_signed_bound ? limit.lower : limit.upper;
  return bound ? (has_signed_bound ? -*bound : *bound) : any_way;
}

/// Whether a limit counts for a side of a history. What a formula limits is taken for what is meant.
bool is_limited(const ProblemFile& problem, const ResponseSettings& response, double side) {
  return std::ranges::any_of(problem.constraints, [&](const ConstraintSettings& limit) {
    const auto index = index_of_named(problem.responses, limit.response);
    if (!index) return false;
    const std::vector<std::size_t> parts = parts_of(problem, *index);
    return std::ranges::any_of(parts, [&](std::size_t part) {
      const ResponseSettings& other = problem.responses[part];
      if (!have_one_history(response, other) || !sees_as_long(other, response)) return false;
      return part != *index || std::isfinite(reach_of(limit, other, side));
    });
  });
}

/// The furthest that a history goes to one side, within the window of its response.
double furthest(const Analysis& analysis, std::size_t response, double side) {
  const StepRange range = analysis.responses[response].steps(analysis.trajectory.time);
  const auto seen = analysis.histories[response].row(0).segment(range.first, range.steps());
  return std::max(0.0, side > 0.0 ? seen.maxCoeff() : -seen.minCoeff());
}

}  // namespace

std::vector<Finding> check_other_side(const TrustedRun& run) {
  std::vector<Finding> findings;
  for (const ConstraintSettings& limit : run.problem.constraints) {
    const auto index = index_of_named(run.problem.responses, limit.response);
    if (!index) continue;
    const ResponseSettings& response = run.problem.responses[*index];
    if (!has_two_sides(response)) continue;
    if (response.over_time != OverTime::max && response.over_time != OverTime::min) continue;
    const double side = response.over_time == OverTime::max ? 1.0 : -1.0;
    const double reach = reach_of(limit, response, side);
    const double beyond = furthest(run.analysis, *index, -side);
    const bool is_beyond = reach > 0.0 && beyond > reach;
    if (!is_beyond || is_limited(run.problem, response, -side)) continue;
    const ShownUnit unit = unit_of(response);
    findings.push_back({fmt::format(
        "the limit \"{}\" holds \"{}\" at {:.4g}{} to one side only, and it comes to {:.4g}{} "
        "on the other one. Where both sides count: \"over_time\": \"max-abs\".",
        limit.name, response.name, unit.shown(side * reach), unit.suffix(),
        unit.shown(-side * beyond), unit.suffix())});
    findings.back().responses = {response.name};
  }
  return findings;
}

}  // namespace pleuel
