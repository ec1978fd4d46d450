#include "reduction/model_check.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

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

}  // namespace

Eigen::Vector3d extent_of(const SolidMesh& mesh) {
  return mesh.positions.rowwise().maxCoeff() - mesh.positions.rowwise().minCoeff();
}

void check_model(const ReductionModel& model) {
  check_connection(model);
  check_rigid_motions(model);
}

std::vector<std::string> findings_about(const ReductionModel& model,
                                        const BodyConstants& constants) {
  std::vector<std::string> findings;
  add_mass_finding(model, constants.mass, findings);
  add_unit_findings(model, constants.mass, findings);
  return findings;
}

}  // namespace pleuel
