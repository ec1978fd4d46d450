#include "core/trust/other_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/response_parts.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// Its zero is its middle: what loads a part to one side loads it to the other.
bool has_two_sides(const ResponseSettings& response) {
  switch (response.type) {
    case ResponseType::deflection:
    case ResponseType::drive_torque:
    case ResponseType::drive_force:
    case ResponseType::reaction_moment:
      return true;
    case ResponseType::section_force:
      return response.section_part != SectionForcePart::axial;
    default:
      return false;
  }
}

bool have_one_history(const ResponseSettings& one, const ResponseSettings& other) {
  return one.type == other.type && one.bodies == other.bodies && one.at == other.at &&
         one.place == other.place && one.chord == other.chord && one.against == other.against &&
         one.direction == other.direction && one.joint == other.joint &&
         one.coordinate == other.coordinate && one.section_part == other.section_part &&
         one.side == other.side;
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
  return std::any_of(problem.constraints.begin(), problem.constraints.end(),
                     [&](const ConstraintSettings& limit) {
                       const auto index = index_of_named(problem.responses, limit.response);
                       if (!index) return false;
                       const std::vector<std::size_t> parts = parts_of(problem, *index);
                       return std::any_of(parts.begin(), parts.end(), [&](std::size_t part) {
                         const ResponseSettings& other = problem.responses[part];
                         if (!have_one_history(response, other) || !sees_as_long(other, response))
                           return false;
                         return part != *index || std::isfinite(reach_of(limit, other, side));
                       });
                     });
}

/// The furthest that a history goes to one side, within the window of its response.
double furthest(const TrustedRun& run, std::size_t response, double side) {
  const ResponseSettings& settings = run.problem.responses[response];
  const Eigen::VectorXd& time = run.analysis.trajectory.time;
  const Eigen::MatrixXd& history = run.analysis.histories[response];
  double far = 0.0;
  for (Eigen::Index n = 0; n < history.cols(); ++n) {
    const bool is_within =
        time(n) >= settings.from.value_or(time(n)) && time(n) <= settings.to.value_or(time(n));
    if (is_within) far = std::max(far, side * history(0, n));
  }
  return far;
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
    const double beyond = furthest(run, *index, -side);
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
