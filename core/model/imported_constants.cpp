#include "core/model/imported_constants.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/scene_geometry.hpp"

namespace pleuel {

namespace {

/// Variables that differ by less are at the design of the file: rounding of written units.
constexpr double design_tolerance = 1e-9;

bool is_positive(const Eigen::VectorXd& numbers) {
  return (numbers.array() > 0.0).all();
}

}  // namespace

BodyConstants constants_at(const ImportedBody& imported, const Body& body,
                           const Design<double>& design) {
  BodyConstants constants = imported.file->constants;
  for (const ImportedVariable& of : imported.variables) {
    const ConstantsDerivative& derivative = imported.file->design[of.in_design];
    const double distance = resolve(of.number, design) - derivative.value;
    if (std::abs(distance) <= design_tolerance * std::abs(derivative.value)) continue;
    if (!imported.is_linear) {
      throw InputError(fmt::format(
          "/scene/bodies/{}/file is known at the design {} = {:.12g} only, not at {:.12g}: write "
          "{} anew for that design, or continue it linearly with \"other_designs\": \"linear\"",
          body.name, derivative.variable, derivative.value, derivative.value + distance,
          imported.source));
    }
    add_constants(constants, distance, *derivative.derivative);
    if (!(constants.mass > 0.0) || !is_positive(constants.mass_matrix.diagonal()) ||
        !is_positive(constants.stiffness.diagonal())) {
      throw SimulationError(
          fmt::format("/scene/bodies/{}/file, continued to {} = {:.6g}, is no body any more: its "
                      "mass, inertia or stiffness is not positive",
                      body.name, derivative.variable, derivative.value + distance));
    }
  }
  return constants;
}

int place_at(const ImportedBody& imported, const Point& point, const Design<double>& start) {
  const Pose<double> pose = beam_pose(imported, start);
  return nearest_place(imported.file->constants,
                       pose.rotation.transpose() * (resolve_point(point, start) - pose.origin));
}

bool is_symmetric(const BodyConstants& constants, const Eigen::Vector3d& normal) {
  constexpr double tolerance = 1e-9;
  const Eigen::Matrix3d& second = constants.second_moment;
  const Eigen::Vector3d across = second * normal - normal.dot(second * normal) * normal;
  const double length = size_of(constants);
  if (across.norm() > tolerance * second.cwiseAbs().maxCoeff()) return false;
  if (std::abs(constants.first_moment.dot(normal)) > tolerance * constants.mass * length) {
    return false;
  }
  // n·S = 0 almost everywhere if ∫ρ (n·S)ᵀ (n·S) vanishes; its diagonal will do.
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(constants.size());
  Eigen::VectorXd mixed = Eigen::VectorXd::Zero(3 * constants.size());
  const Eigen::MatrixXd h(constants.mixed);
  for (std::size_t i = 0; i < moment_pairs.size(); ++i) {
    const auto [k, l] = moment_pairs[i];
    const double weight = (k == l ? 1.0 : 2.0) * normal(k) * normal(l);
    moved += weight * constants.moments[i].diagonal();
  }
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      mixed.segment(l * constants.size(), constants.size()) +=
          normal(k) * h.row(3 * k + l).transpose();
    }
  }
  return moved.cwiseAbs().maxCoeff() <=
             tolerance * constants.mass_matrix.diagonal().cwiseAbs().maxCoeff() &&
         mixed.cwiseAbs().maxCoeff() <= tolerance * std::max(h.cwiseAbs().maxCoeff(), 1e-300);
}

}  // namespace pleuel
