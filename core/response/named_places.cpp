#include "core/response/named_places.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/model/body_point.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/response_kind.hpp"

namespace pleuel {

namespace {

/// Where the scene and the responses hold on to a beam.
class PlaceFinder {
 public:
  PlaceFinder(const ProblemFile& problem, const BodyModel& body) : body_(body) {
    for (const DesignVariable& variable : problem.variables) start_.push_back(variable.start);
    beam_ = &std::get<BeamBody>(find_named(problem.scene.bodies, body.name)->shape);
    for (const AttachedPoint& point : attached_points(problem.scene, body.name)) {
      add(point.name, held_place(body, share_along(*beam_, point.at, start_)));
    }
    for (const ResponseSettings& response : problem.responses) add_response(response);
    for (int node = 0; node < body.beam.node_count(); ++node) {
      add(fmt::format("node {}", node),
          node == 0 ? BeamPlace{{0, 0.0}} : BeamPlace{{node - 1, 1.0}});
    }
    std::stable_sort(places_.begin(), places_.end(),
                     [](const NamedPlace& a, const NamedPlace& b) { return a.x < b.x; });
  }

  std::vector<NamedPlace> take() { return std::move(places_); }

 private:
  void add_response(const ResponseSettings& response) {
    if (!kind_of(response.type).is_of_point || response.bodies.front() != body_.name) return;
    add(response.name, place_at(body_, response.at));
  }

  void add(const std::string& name, const BeamPlace& place) {
    const double x = position_of(body_.beam, place);
    const double length = body_.beam.node_position(body_.beam.node_count() - 1);
    bool has_name = false;
    for (const NamedPlace& other : places_) {
      if (std::abs(other.x - x) < 1e-9 * length) return;
      has_name = has_name || other.name == name;
    }
    places_.push_back({has_name ? fmt::format("{} at {:.6g}", name, x / length) : name, place, x});
  }

  const BodyModel& body_;
  const BeamBody* beam_ = nullptr;
  Design<double> start_;
  std::vector<NamedPlace> places_;
};

}  // namespace

std::vector<NamedPlace> named_places(const ProblemFile& problem, const BodyModel& body) {
  return PlaceFinder(problem, body).take();
}

}  // namespace pleuel
