#include "reduction/reduce.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "reduction/body_surface.hpp"
#include "reduction/interface.hpp"
#include "reduction/model_check.hpp"
#include "reduction/nodal_invariants.hpp"
#include "reduction/stress_points.hpp"

namespace pleuel {

namespace {

/// The motion of a place per coordinate; interfaces have theirs in the coordinates.
BodyPlace place_of(const InterfaceSet& set, const Eigen::MatrixXd& motion) {
  return {set.name, set.at, sparse_of(motion.topRows<3>()), sparse_of(motion.bottomRows<3>())};
}

std::vector<BodyPlace> places_of(const ReductionModel& model, const Eigen::MatrixXd& shape) {
  std::vector<BodyPlace> places;
  const std::vector<InterfaceSet>& interfaces = model.interfaces;
  for (const InterfaceSet& interface : interfaces) {
    places.push_back(place_of(interface, mean_motion(interface, model.mesh.positions, shape)));
  }
  for (const InterfaceSet& place : model.places) {
    places.push_back(place_of(place, mean_motion(place, model.mesh.positions, shape)));
  }
  return places;
}

/// Of a group the nodes that become points, in rising order.
std::vector<int> stressed_nodes(const ReductionModel& model, const std::vector<int>& group,
                                const Eigen::MatrixXd& shape, const Eigen::MatrixXd& stiffness) {
  const std::vector<int> nodes = corners_among(model.mesh, group);
  if (nodes.empty()) throw InputError("no node of /stress/nodes is a corner of an element");
  const int most = model.stress->most;
  if (most == 0) return nodes;
  std::vector<int> found;
  for (const int i : most_stressed(nodal_stress(model.mesh, shape, nodes), stiffness, most)) {
    found.push_back(nodes[i]);
  }
  return found;
}

PointGroup group_of(const std::string& name, const std::vector<int>& group,
                    const std::vector<int>& all) {
  PointGroup points{name, {}};
  for (const int node : group) {
    points.points.push_back(
        static_cast<int>(std::lower_bound(all.begin(), all.end(), node) - all.begin()));
  }
  return points;
}

StressRecovery stress_of(const ReductionModel& model, const Eigen::MatrixXd& shape,
                         const Eigen::MatrixXd& stiffness) {
  std::vector<std::vector<int>> groups;
  std::set<int> all;
  for (const NodeGroup& group : model.stress->groups) {
    groups.push_back(stressed_nodes(model, group.nodes, shape, stiffness));
    all.insert(groups.back().begin(), groups.back().end());
  }
  const std::vector<int> nodes(all.begin(), all.end());
  StressRecovery stress;
  for (const int node : nodes) {
    stress.points.push_back(fmt::format("node {}", model.mesh.numbers[node]));
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::string& name = model.stress->groups[i].name;
    if (!name.empty()) stress.groups.push_back(group_of(name, groups[i], nodes));
  }
  stress.strengths = model.stress->strengths;
  const Eigen::MatrixXd rows = nodal_stress(model.mesh, shape, nodes);
  stress.of_coordinates = sparse_of(rows);
  stress.of_accelerations.resize(rows.rows(),
                                 3 * int_size(model.interfaces) + 3 * int_size(model.places));
  return stress;
}

/// Takes those coordinates alone that keep the body in the plane of its motion.
void keep_in_plane(const ReductionModel& model, ComponentModes& modes) {
  const BodyConstants all = nodal_invariants(model.matrices, model.mesh.positions, modes.shape);
  const int prescribed = 6 * (int_size(model.interfaces) - 1);
  const std::vector<int> kept = coordinates_in_plane(all, *model.plane, prescribed);
  modes.shape = Eigen::MatrixXd(modes.shape(Eigen::all, kept));
  std::vector<std::string> names;
  std::vector<double> frequencies;
  for (const int i : kept) {
    names.push_back(modes.names[i]);
    if (i >= prescribed) frequencies.push_back(modes.frequencies(i - prescribed));
  }
  modes.names = names;
  modes.frequencies = Eigen::Map<Eigen::VectorXd>(frequencies.data(), int_size(frequencies));
}

/// So many modes of the plane, whatever others lie between them: another design has as many.
void keep_lowest(int number, int prescribed, ComponentModes& modes) {
  if (int_size(modes.frequencies) > number) modes.next_frequency = modes.frequencies(number);
  modes.frequencies = Eigen::VectorXd(modes.frequencies.head(number));
  modes.shape = Eigen::MatrixXd(modes.shape.leftCols(prescribed + number));
  modes.names.resize(prescribed + number);
  for (int i = 0; i < number; ++i) modes.names[prescribed + i] = fmt::format("mode {}", i + 1);
}

ComponentModes modes_in_plane(const ReductionModel& model) {
  ModeCount asked = model.modes;
  asked.number = 2 * asked.number + 2;
  while (true) {
    ComponentModes modes =
        component_modes(model.matrices, model.mesh.positions, model.interfaces, asked);
    const bool are_all = int_size(modes.frequencies) < asked.number;
    keep_in_plane(model, modes);
    const int count = int_size(modes.frequencies);
    if (asked.frequency > 0.0 || asked.generations > 0) return modes;
    if (count >= model.modes.number || are_all) {
      const int prescribed = int_size(modes.names) - count;
      keep_lowest(std::min(model.modes.number, count), prescribed, modes);
      return modes;
    }
    asked.number *= 2;
  }
}

BodyConstants constants_of(const ReductionModel& model, const Eigen::MatrixXd& shape) {
  BodyConstants constants = nodal_invariants(model.matrices, model.mesh.positions, shape);
  constants.damping = model.damping * constants.stiffness;
  constants.places = places_of(model, shape);
  const Eigen::MatrixXd stiffness(constants.stiffness);
  if (model.stress) constants.stress = stress_of(model, shape, stiffness);
  if (model.stiffening) {
    constants.stretching =
        line_stiffening(*model.stiffening, model.mesh.positions, shape, stiffness);
  }
  return constants;
}

}  // namespace

ReducedBody reduce(const ReductionModel& model) {
  check_model(model);
  const ComponentModes modes = model.plane ? modes_in_plane(model)
                                           : component_modes(model.matrices, model.mesh.positions,
                                                             model.interfaces, model.modes);
  ReducedBody body;
  body.frequencies = modes.frequencies;
  body.next_frequency = modes.next_frequency;
  body.volume = volume_of(model.mesh);
  body.extent = extent_of(model.mesh);
  body.file.body = model.body;
  body.file.description = model.description;
  body.file.reference_condition =
      fmt::format("the interface \"{}\" is clamped", model.interfaces.front().name);
  body.file.coordinates = modes.names;
  body.file.constants = constants_of(model, modes.shape);
  if (model.surface > 0) body.file.surface = body_surface(model.mesh, modes.shape, model.surface);
  body.findings = findings_about(model, body.file.constants);
  if (model.plane) body.asymmetry = clear_across_plane(body.file.constants, *model.plane);
  return body;
}

}  // namespace pleuel
