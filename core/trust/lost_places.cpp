#include "core/trust/lost_places.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/body_point.hpp"
#include "core/scene/attached_points.hpp"

namespace pleuel {

namespace {

/// Of the length of the beam: less is the rounding of written numbers.
constexpr double rounding = 1e-6;

}  // namespace

std::vector<Finding> check_lost_places(const TrustedRun& run) {
  const Eigen::VectorXd x = start_design(run.problem);
  const Design<double> start(x.begin(), x.end());
  std::vector<Finding> findings;
  for (const Body& body : run.problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || beam->is_rigid) continue;
    const BodyModel& model = run.analysis.model.body(body.name);
    if (!model.is_elastic) continue;
    const double length = model.beam.node_position(model.beam.node_count() - 1);
    for (const AttachedPoint& point : attached_points(run.problem.scene, body.name)) {
      const BeamPlace place = held_place(model, share_along(*beam, point.at, start));
      if (place.is_node()) continue;
      const double distance = std::min(place.xi, 1.0 - place.xi) *
                              model.beam.elements[static_cast<std::size_t>(place.element)].length;
      if (distance <= rounding * length) continue;
      findings.push_back({fmt::format(
          "\"{}\" is only {:.2g} m beside an end of the beam \"{}\", a boundary of its segments or "
          "another place where something is: forces and stress in between are not known. Put both "
          "at one place, or give the beam shorter elements there.",
          point.name, distance, body.name)});
    }
  }
  return findings;
}

}  // namespace pleuel
