#include "core/scene/reading/body_places.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/body_chart.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/reading/mistakes.hpp"

namespace pleuel {

namespace {

/// Of the distance between two places, or to the end of the beam, at the start: elements that are
/// smaller against their neighbours drown in round-off.
constexpr double least_gap = 0.01;

/// The point of the axis of a beam at a share of its length, 0 … 1 [m].
Eigen::Vector3d point_at(const BeamBody& beam, double share, const Design<double>& design) {
  return (1.0 - share) * resolve_point(beam.from, design) + share * resolve_point(beam.to, design);
}

/// The share of the length, 0 … 1, where the axis of the beam is nearest to a place.
double nearest_share(const BeamBody& beam, const Eigen::Vector3d& place,
                     const Design<double>& design) {
  const Eigen::Vector3d from = resolve_point(beam.from, design);
  const Eigen::Vector3d axis = resolve_point(beam.to, design) - from;
  const double length = axis.stableNorm();
  return std::clamp((place - from).dot(axis / length) / length, 0.0, 1.0);
}

/// Whether a place is at the share of the length of a beam, up to the rounding of written numbers.
bool is_on_beam(const BeamBody& beam, double share, const Eigen::Vector3d& at,
                const Design<double>& design) {
  const double length =
      (resolve_point(beam.to, design) - resolve_point(beam.from, design)).stableNorm();
  return (at - point_at(beam, share, design)).stableNorm() <= placement_tolerance * length;
}

/// A place in the axes of the body frame of an imported body [m].
Eigen::Vector3d local_point(const ImportedBody& body, const Point& place,
                            const Design<double>& design) {
  return beam_axes(body.from, body.to, body.reference, design).transpose() *
         (resolve_point(place, design) - resolve_point(body.from, design));
}

/// The diagonal of the box around all bodies and joints [m].
double extent(const Scene& scene, const Design<double>& design) {
  Eigen::AlignedBox3d box;
  const auto add = [&](const Point& at, const PointKey&) { box.extend(resolve_point(at, design)); };
  for (const Body& body : scene.bodies) visit_body_points(body, add);
  for (const Joint& joint : scene.joints) visit_held_places(joint, add);
  return box.sizes().stableNorm();
}

/// A coordinate for a message, without the last digits, which are rounding.
std::string shown_coordinate(double coordinate) {
  return fmt::format("{:.9g}", coordinate + 0.0);
}

bool has_formula(const Point& point) {
  return std::ranges::any_of(point,
                             [](const Number& number) { return number.expression != nullptr; });
}

/// @param list  of the scene, in which the joint or load stands
template <class Holder>
void add_held(const Scene& scene, const char* list, const Holder& holder,
              std::vector<PlacedPoint>& points) {
  visit_held_points(holder, [&](const std::string& body, const Point& at, const PointKey& key) {
    std::vector<std::string> path = {list, holder.name, key.key};
    if (key.index >= 0) path.push_back(std::to_string(key.index));
    points.push_back({std::move(path), &at, find_named(scene.bodies, body)});
  });
}

void add_deflections(const Body& body, std::vector<PlacedPoint>& points) {
  for (std::size_t i = 0; i < body.initial_deflections.size(); ++i) {
    points.push_back({{"bodies", body.name, "initial_deflections", std::to_string(i), "at"},
                      &body.initial_deflections[i].at,
                      &body});
  }
}

}  // namespace

std::string describe(const Eigen::Vector3d& place) {
  return fmt::format("({}, {}, {})", shown_coordinate(place[0]), shown_coordinate(place[1]),
                     shown_coordinate(place[2]));
}

std::string PlacedPoint::pointer() const {
  return fmt::format("/scene/{}", fmt::join(path, "/"));
}

std::vector<PlacedPoint> placed_points(const Scene& scene) {
  std::vector<PlacedPoint> points;
  for (const Joint& joint : scene.joints) add_held(scene, "joints", joint, points);
  for (const Load& load : scene.loads) add_held(scene, "loads", load, points);
  for (const Body& body : scene.bodies) add_deflections(body, points);
  return points;
}

BeamPlaces::BeamPlaces(const Body& body, const Scene& scene, const Design<double>& start)
    : body_(body),
      scene_(scene),
      beam_(std::get<BeamBody>(body.shape)),
      start_(start),
      mesh_(make_mesh(body, scene, start, true)) {}

std::optional<std::string> BeamPlaces::find_misplaced(const Point& at, const Design<double>& design,
                                                      bool looks_at_axis) const {
  const Eigen::Vector3d there = resolve_point(at, design);
  const double before = nearest_share(beam_, resolve_point(at, start_), start_);
  const double modelled = modelled_share(before, design);
  const double now = nearest_share(beam_, there, design);
  const bool is_taken_along = std::abs(modelled - before) > placement_tolerance;
  const bool is_left =
      is_taken_along && std::abs(std::clamp(modelled, 0.0, 1.0) - now) > placement_tolerance;
  const bool is_in_place = looks_at_axis ? is_on_beam(beam_, modelled, there, design) : !is_left;
  if (is_in_place) return find_disorder(at, design);
  const bool moves = mesh_.depends_on_design() && is_bound(at);
  if (moves && !is_on_beam(beam_, now, there, design)) {
    return fmt::format("must be on the axis of the beam \"{}\", the nearest point is {} [m]",
                       body_.name, pleuel::describe(point_at(beam_, now, design)));
  }
  return fmt::format(
      "must stay {} of the length of the beam \"{}\", which is {} [m]",
      is_taken_along
          ? fmt::format("with what moves from its place or beside it, at the share {:.6g}",
                        modelled)
          : fmt::format("at the share {:.6g}", modelled),
      body_.name, pleuel::describe(point_at(beam_, modelled, design)));
}

double BeamPlaces::modelled_share(double at_start, const Design<double>& design) const {
  if (!mesh_.depends_on_design()) return at_start;
  const ElementPlace place = find_place(mesh_, at_start);
  const std::vector<double> shares = element_shares(beam_, mesh_, design);
  double share = place.xi * shares[place.element];
  for (int e = 0; e < place.element; ++e) share += shares[e];
  return share;
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

std::optional<Misplaced> PlacesOnBodies::find_misplaced(const PlacedPoint& placed,
                                                        const Design<double>& design,
                                                        bool is_known_at_bounds) {
  if (placed.body == nullptr) return std::nullopt;
  if (const auto* beam = std::get_if<BeamBody>(&placed.body->shape)) {
    return find_off_beam(placed, *beam, design, is_known_at_bounds);
  }
  if (const auto* mass = std::get_if<PointMass>(&placed.body->shape)) {
    return find_off_mass(placed, *mass, design);
  }
  const auto* imported = std::get_if<ImportedBody>(&placed.body->shape);
  return imported != nullptr ? find_off_place(placed, *imported, design) : std::nullopt;
}

/// The mesh is made where something varies only.
std::optional<Misplaced> PlacesOnBodies::find_off_beam(const PlacedPoint& placed,
                                                       const BeamBody& beam,
                                                       const Design<double>& design,
                                                       bool is_known_at_bounds) {
  if (beam.is_rigid) return std::nullopt;
  const Eigen::Vector3d at = resolve_point(*placed.point, design);
  if (design == start_) {
    const double share = nearest_share(beam, at, design);
    if (is_on_beam(beam, share, at, design)) return std::nullopt;
    return Misplaced{
        fmt::format("must be on the axis of the beam \"{}\", the nearest point is {} [m]",
                    placed.body->name, describe(point_at(beam, share, design))),
        at};
  }
  const bool is_formula =
      has_formula(*placed.point) || has_formula(beam.from) || has_formula(beam.to);
  const auto found = of_beam(*placed.body)
                         .find_misplaced(*placed.point, design, is_formula || !is_known_at_bounds);
  return found ? std::optional(Misplaced{*found, at}) : std::nullopt;
}

std::optional<Misplaced> PlacesOnBodies::find_off_mass(const PlacedPoint& placed,
                                                       const PointMass& mass,
                                                       const Design<double>& design) const {
  if (design != start_ && !is_bound(*placed.point) && !is_bound(mass.at)) return std::nullopt;
  const Eigen::Vector3d at = resolve_point(*placed.point, design);
  const Eigen::Vector3d there = resolve_point(mass.at, design);
  if ((at - there).stableNorm() <= placement_tolerance * extent(scene_, design)) {
    return std::nullopt;
  }
  return Misplaced{fmt::format("must be where the point mass \"{}\" is, {} [m]", placed.body->name,
                               describe(there)),
                   at};
}

/// It is to be where the place of the file is that is nearest at the start.
std::optional<Misplaced> PlacesOnBodies::find_off_place(const PlacedPoint& placed,
                                                        const ImportedBody& imported,
                                                        const Design<double>& design) const {
  const BodyConstants& constants = imported.file->constants;
  const auto number = static_cast<std::size_t>(
      nearest_place(constants, local_point(imported, *placed.point, start_)));
  const BodyPlace& place = constants.places[number];
  Eigen::Vector3d there = place.position;
  for (const ImportedVariable& of : imported.variables) {
    const ConstantsDerivative& derivative = imported.file->design[of.in_design];
    if (!derivative.derivative) continue;
    there += (resolve(of.number, design) - derivative.value) *
             derivative.derivative->places[number].position;
  }
  const Eigen::Vector3d local = local_point(imported, *placed.point, design);
  if ((local - there).stableNorm() <= placement_tolerance * size_of(constants)) return std::nullopt;
  return Misplaced{
      fmt::format(
          "must be at a place of the body \"{}\"; in its axes, the nearest one is \"{}\" at "
          "{} [m]",
          placed.body->name, place.name, describe(there)),
      local};
}

}  // namespace pleuel
