#include "core/scene/reading/beam_places.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/placed_points.hpp"

namespace pleuel {

namespace {

/// Of the distance between two places, or to the end of the beam, at the start: elements that are
/// smaller against their neighbours drown in round-off.
constexpr double least_gap = 0.01;

}  // namespace

BeamPlaces::BeamPlaces(const Body& body, const Scene& scene, const Design<double>& start)
    : body_(body),
      beam_(std::get<BeamBody>(body.shape)),
      start_(start),
      mesh_(make_mesh(body, scene, start, true)) {}

std::optional<std::string> BeamPlaces::find_misplaced(const Point& at,
                                                      const Design<double>& design) const {
  const Eigen::Vector3d there = position(at, design);
  const double before = nearest_share(beam_, position(at, start_), start_);
  const Point* followed = followed_at(before);
  if (!followed) return find_moved(before, there, design, "");
  const double now = nearest_share(beam_, there, design);
  if (!is_on_beam(beam_, now, there, design)) {
    return fmt::format("must be on the axis of the beam \"{}\", the nearest point is {} [m]",
                       body_.name, describe(point_at(beam_, now, design)));
  }
  const double share = nearest_share(beam_, position(*followed, design), design);
  if (auto moved = find_moved(share, there, design, " with what is there at the start")) {
    return moved;
  }
  return find_disorder(at, design);
}

std::optional<std::string> BeamPlaces::find_moved(double share, const Eigen::Vector3d& there,
                                                  const Design<double>& design,
                                                  const char* why) const {
  if (is_on_beam(beam_, share, there, design)) return std::nullopt;
  return fmt::format(
      "must stay at the share {:.6g} of the length of the beam \"{}\"{}, which is {} [m]", share,
      body_.name, why, describe(point_at(beam_, share, design)));
}

bool BeamPlaces::leaves(const Point& at, std::size_t variable, double change) const {
  Design<Dual> seeded(start_.begin(), start_.end());
  seeded[variable].derivatives()[0] = 1.0;
  const auto place = [&](const Dual& share) {
    const Eigen::Matrix<Dual, 3, 1> from = resolve_point(beam_.from, seeded);
    return Eigen::Matrix<Dual, 3, 1>(from + share * (resolve_point(beam_.to, seeded) - from));
  };
  const double before = nearest_share(beam_, position(at, start_), start_);
  const Point* followed = followed_at(before);
  const Dual share = followed ? share_along(beam_, *followed, seeded) : Dual(before);
  const Eigen::Matrix<Dual, 3, 1> off = resolve_point(at, seeded) - place(share);
  const double length = (position(beam_.to, start_) - position(beam_.from, start_)).norm();
  return std::abs(change) * derivative_matrix(off).norm() > placement_tolerance * length;
}

const Point* BeamPlaces::followed_at(double share) const {
  const ElementPlace place = find_place(mesh_, share);
  if (!place.is_node()) return nullptr;
  for (const MeshKnot& knot : mesh_.knots) {
    if (knot.node == place.node() && knot.at) return &*knot.at;
  }
  return nullptr;
}

std::optional<std::string> BeamPlaces::find_disorder(const Point& at,
                                                     const Design<double>& design) const {
  const ElementPlace place = find_place(mesh_, nearest_share(beam_, position(at, start_), start_));
  const std::vector<double> at_start = knot_distances(beam_, mesh_, start_);
  const std::vector<double> distances = knot_distances(beam_, mesh_, design);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const bool is_beside = place.is_node() && (mesh_.knots[i].node == place.node() ||
                                               mesh_.knots[i + 1].node == place.node());
    if (is_beside && !(distances[i] >= least_gap * at_start[i])) {
      return fmt::format(
          "must not reach or pass the next place of a joint, load or section of the beam \"{}\", "
          "or "
          "its end, from which it is {:.6g} of the length away at the start",
          body_.name, at_start[i]);
    }
  }
  return std::nullopt;
}

}  // namespace pleuel
