#include "core/scene/reading/beam_places.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/sample_design.hpp"

namespace pleuel {

namespace {

/// Of the distance between two places, or to the end of the beam, at the start: elements that are
/// smaller against their neighbours drown in round-off.
constexpr double least_gap = 0.01;

}  // namespace

BeamPlaces::BeamPlaces(const Body& body, const Scene& scene, const Design<double>& start)
    : body_(body),
      scene_(scene),
      beam_(std::get<BeamBody>(body.shape)),
      start_(start),
      mesh_(make_mesh(body, scene, start, true)) {}

std::optional<std::string> BeamPlaces::find_misplaced(const Point& at,
                                                      const Design<double>& design) const {
  const Eigen::Vector3d there = resolve_point(at, design);
  const double before = nearest_share(beam_, resolve_point(at, start_), start_);
  const double modelled = modelled_share(before, design);
  if (is_on_beam(beam_, modelled, there, design)) return find_disorder(at, design);
  const double now = nearest_share(beam_, there, design);
  const bool moves = mesh_.depends_on_design() && is_bound(at);
  if (moves && !is_on_beam(beam_, now, there, design)) {
    return fmt::format("must be on the axis of the beam \"{}\", the nearest point is {} [m]",
                       body_.name, pleuel::describe(point_at(beam_, now, design)));
  }
  const bool is_taken_along = std::abs(modelled - before) > placement_tolerance;
  return fmt::format(
      "must stay {} of the length of the beam \"{}\", which is {} [m]",
      is_taken_along
          ? fmt::format("with what moves from its place or beside it, at the share {:.6g}",
                        modelled)
          : fmt::format("at the share {:.6g}", modelled),
      body_.name, pleuel::describe(point_at(beam_, modelled, design)));
}

std::optional<std::string> BeamPlaces::find_taken_along(const Point& at,
                                                        const Design<double>& design) const {
  const double before = nearest_share(beam_, resolve_point(at, start_), start_);
  const double modelled = modelled_share(before, design);
  const double now = nearest_share(beam_, resolve_point(at, design), design);
  const bool is_taken_along = std::abs(modelled - before) > placement_tolerance &&
                              std::abs(std::clamp(modelled, 0.0, 1.0) - now) > placement_tolerance;
  return is_taken_along ? find_misplaced(at, design) : find_disorder(at, design);
}

bool BeamPlaces::leaves(const Point& at, std::size_t variable, double change) const {
  Design<Dual> seeded(start_.begin(), start_.end());
  seeded[variable].derivatives()[0] = 1.0;
  const Dual share =
      modelled_share(nearest_share(beam_, resolve_point(at, start_), start_), seeded);
  const Eigen::Matrix<Dual, 3, 1> from = resolve_point(beam_.from, seeded);
  const Eigen::Matrix<Dual, 3, 1> modelled =
      from + share * (resolve_point(beam_.to, seeded) - from);
  const Eigen::Matrix<Dual, 3, 1> off = resolve_point(at, seeded) - modelled;
  const double length =
      (resolve_point(beam_.to, start_) - resolve_point(beam_.from, start_)).norm();
  return std::abs(change) * derivative_matrix(off).norm() > placement_tolerance * length;
}

std::string BeamPlaces::describe(int node) const {
  if (node == 0 || node == int_size(mesh_.elements)) return "the end";
  const double share = mesh_.share_at(node);
  for (const AttachedPoint& point : attached_points(scene_, body_.name)) {
    if (std::abs(share_along(beam_, point.at, start_) - share) <= rounding_tolerance) {
      return fmt::format("the place of \"{}\"", point.name);
    }
  }
  return "the next segment";
}

std::optional<std::string> BeamPlaces::find_disorder(const Point& at,
                                                     const Design<double>& design) const {
  const ElementPlace place =
      find_place(mesh_, nearest_share(beam_, resolve_point(at, start_), start_));
  const bool moves = place.is_node() && std::ranges::any_of(mesh_.knots, [&](const MeshKnot& knot) {
                       return knot.node == place.node() && knot.at;
                     });
  if (!moves) return std::nullopt;
  const std::vector<double> at_start = knot_distances(beam_, mesh_, start_);
  const std::vector<double> distances = knot_distances(beam_, mesh_, design);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const bool is_beside =
        mesh_.knots[i].node == place.node() || mesh_.knots[i + 1].node == place.node();
    if (is_beside && !(distances[i] >= least_gap * at_start[i])) {
      return fmt::format(
          "must not come nearer to {} of the beam \"{}\" than a hundredth of its distance at the "
          "start, which is {:.3g} of the length",
          describe(mesh_.knots[mesh_.knots[i].node == place.node() ? i + 1 : i].node), body_.name,
          at_start[i]);
    }
  }
  return std::nullopt;
}

}  // namespace pleuel
