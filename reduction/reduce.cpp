#include "reduction/reduce.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/body_constants.hpp"
#include "reduction/body_surface.hpp"
#include "reduction/interface.hpp"
#include "reduction/model_reader.hpp"
#include "reduction/nodal_invariants.hpp"
#include "reduction/stress_points.hpp"

namespace pleuel {

namespace {

/// The box around the nodes [m].
Eigen::Vector3d extent_of(const SolidMesh& mesh) {
  return mesh.positions.rowwise().maxCoeff() - mesh.positions.rowwise().minCoeff();
}

/// Rigid motions of all nodes about the middle of the body, with rotations that move by about one.
Eigen::MatrixXd rigid_motions_of(const SolidMesh& mesh) {
  InterfaceSet all{"the body", {}, {}, true};
  for (int i = 0; i < mesh.size(); ++i) all.nodes.push_back(i);
  all.at = centroid_of(all.nodes, mesh.positions);
  Eigen::MatrixXd motions = rigid_rows(all, mesh.positions);
  motions.rightCols<3>() /= 0.5 * extent_of(mesh).maxCoeff();
  return motions;
}

void check_rigid_motions(const ReductionModel& model) {
  const SolidMatrix& k = model.matrices.stiffness;
  const Eigen::MatrixXd forces = k * rigid_motions_of(model.mesh);
  double largest = 0.0;
  for (int j = 0; j < k.outerSize(); ++j) largest = std::max(largest, std::abs(k.coeff(j, j)));
  const double share = forces.cwiseAbs().maxCoeff() / largest;
  if (share < 1e-7) return;
  throw InputError(fmt::format(
      "the stiffness resists a rigid motion: |K r| is {:.1e} of the largest stiffness, and "
      "round-off "
      "only if the body is free; are K and the nodes of one mesh, in the same order and unit, and "
      "nothing held (*BOUNDARY) or tied to the ground (*SPRING)?",
      share));
}

void check_connection(const ReductionModel& model) {
  const std::vector<int> parts = connected_parts(model.mesh);
  const int first = parts[model.interfaces.front().nodes.front()];
  for (const InterfaceSet& interface : model.interfaces) {
    for (const int node : interface.nodes) {
      if (parts[node] == first) continue;
      throw InputError(
          fmt::format("the interfaces \"{}\" and \"{}\" are not connected: no chain of elements "
                      "leads from one to "
                      "node {} of the other; merge the nodes of parts that touch",
                      model.interfaces.front().name, interface.name, model.mesh.numbers[node]));
    }
  }
}

void add_mass_finding(const ReductionModel& model, double mass,
                      std::vector<std::string>& findings) {
  const double of_mesh = mass_of(model.mesh);
  if (of_mesh == 0.0 || std::abs(mass / of_mesh - 1.0) < 1e-3) return;
  findings.push_back(
      fmt::format("the mass matrix holds {:.6g} kg, but volume and density of the mesh make {:.6g} "
                  "kg: they are "
                  "not of one model",
                  mass, of_mesh));
}

/// Foam to tungsten.
constexpr double least_density = 20.0, largest_density = 25000.0;
/// √(E/ρ): rubber to diamond [m/s].
constexpr double least_speed = 20.0, largest_speed = 20000.0;

void add_unit_findings(const ReductionModel& model, double mass,
                       std::vector<std::string>& findings) {
  const Eigen::Vector3d extent = extent_of(model.mesh);
  const double density = mass / volume_of(model.mesh);
  const std::string understood =
      fmt::format("a body of {:.4g} × {:.4g} × {:.4g} m with {:.4g} kg was understood", extent(0),
                  extent(1), extent(2), mass);
  if (density < least_density || density > largest_density) {
    findings.push_back(fmt::format("{}, of {:.3g} kg/m³, which no solid has: is \"units\" right?",
                                   understood, density));
  }
  for (const SolidMaterial& material : model.mesh.materials) {
    if (material.young <= 0.0 || material.density <= 0.0) continue;
    const double speed = std::sqrt(material.young / material.density);
    if (speed >= least_speed && speed <= largest_speed) continue;
    findings.push_back(fmt::format(
        "{}; sound would run through {} at {:.3g} m/s (E = {:.3g} Pa, ρ = {:.3g} kg/m³), which no "
        "solid has: is \"units\" right?",
        understood, material.name, speed, material.young, material.density));
  }
}

/// The motion of interfaces and other places per coordinate; those of interfaces are in the coordinates, too.
std::vector<BodyPlace> places_of(const ReductionModel& model, const Eigen::MatrixXd& shape) {
  std::vector<BodyPlace> places;
  for (const auto* sets : {&model.interfaces, &model.places}) {
    for (const InterfaceSet& set : *sets) {
      const Eigen::MatrixXd motion = mean_motion(set, model.mesh.positions, shape);
      places.push_back(
          {set.name, set.at, sparse_of(motion.topRows<3>()), sparse_of(motion.bottomRows<3>())});
    }
  }
  return places;
}

/// Of a group the nodes that become points, in rising order.
std::vector<int> stressed_nodes(const ReductionModel& model, const std::vector<int>& group,
                                const Eigen::MatrixXd& shape, const Eigen::MatrixXd& stiffness) {
  const std::vector<int> nodes = corners_among(model.mesh, group);
  if (nodes.empty()) {
    throw InputError(
        "no node of /stress/nodes is a corner of an element and outside of rigid interfaces, of "
        "which "
        "no stress is known");
  }
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
  check_connection(model);
  check_rigid_motions(model);
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
  add_mass_finding(model, body.file.constants.mass, body.findings);
  add_unit_findings(model, body.file.constants.mass, body.findings);
  if (model.plane) body.asymmetry = clear_across_plane(body.file.constants, *model.plane);
  return body;
}

}  // namespace pleuel
