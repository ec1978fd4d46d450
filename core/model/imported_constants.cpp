#include "core/model/imported_constants.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/body_source.hpp"

namespace pleuel {

namespace {

/// Variables that differ by less are at the design of the file: rounding of written units.
constexpr double design_tolerance = 1e-9;

bool is_positive(const Eigen::VectorXd& numbers) {
  return (numbers.array() > 0.0).all();
}

/// Couplings and displacements across the plane that are round-off.
constexpr double plane_tolerance = 1e-9;

/// Whether a matrix in space has an entry with one index along n and the other across it.
bool couples_across(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& normal, double size) {
  const auto across = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return x - normal.dot(x) * normal;
  };
  const double most = std::max(across(matrix * normal).cwiseAbs().maxCoeff(),
                               across(matrix.transpose() * normal).cwiseAbs().maxCoeff());
  return most > plane_tolerance * size;
}

/// H_kl of any coordinate.
bool couples_across(const SparseMatrix& mixed, const Eigen::Vector3d& normal) {
  const Eigen::MatrixXd h(mixed);
  const double size = std::max(h.cwiseAbs().maxCoeff(), 1e-300);
  for (Eigen::Index i = 0; i < h.cols(); ++i) {
    if (couples_across(Eigen::Matrix3d(h.col(i).reshaped(3, 3)), normal, size)) return true;
  }
  return false;
}

/// S_kl of any two coordinates, for the size of their inertia.
bool couples_across(const std::array<SparseMatrix, 6>& moments, const Eigen::Vector3d& normal) {
  std::array<Eigen::MatrixXd, 6> s;
  for (std::size_t p = 0; p < s.size(); ++p) s[p] = Eigen::MatrixXd(moments[p]);
  const Eigen::VectorXd size = (s[0] + s[1] + s[2]).diagonal().cwiseAbs().cwiseSqrt();
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    for (Eigen::Index j = 0; j < size.size(); ++j) {
      Eigen::Matrix3d of;
      for (std::size_t p = 0; p < s.size(); ++p) {
        const auto [k, l] = moment_pairs[p];
        of(k, l) = s[p](i, j);
        of(l, k) = s[p](j, i);
      }
      if (couples_across(of, normal, size(i) * size(j))) return true;
    }
  }
  return false;
}

/// Whether it moves along n, or turns about anything but n.
bool leaves_plane(const BodyPlace& place, const Eigen::Vector3d& normal) {
  const Eigen::MatrixXd u(place.displacement), theta(place.rotation);
  const Eigen::VectorXd along = u.transpose() * normal;
  const Eigen::MatrixXd tilt = theta - normal * (normal.transpose() * theta);
  const auto exceeds = [](const Eigen::MatrixXd& part, const Eigen::MatrixXd& of) {
    return part.size() > 0 &&
           part.cwiseAbs().maxCoeff() > plane_tolerance * of.cwiseAbs().maxCoeff();
  };
  return exceeds(along, u) || exceeds(tilt, theta);
}

}  // namespace

Eigen::VectorXd body_values(const ImportedBody& imported, const Design<double>& design) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(imported.variables.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) = resolve(imported.variables[i].number, design);
  }
  return values;
}

std::shared_ptr<const InvariantsFile> body_at(const ImportedBody& imported, const Body& body,
                                              const Design<double>& design) {
  if (imported.maker) return imported.maker->at(body_values(imported, design));
  BodyConstants constants = imported.file->constants;
  bool is_there = true;
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
    is_there = false;
    add_constants(constants, distance, *derivative.derivative);
    if (!(constants.mass > 0.0) || !is_positive(constants.mass_matrix.diagonal()) ||
        !is_positive(constants.stiffness.diagonal())) {
      throw SimulationError(
          fmt::format("/scene/bodies/{}/file, continued to {} = {:.6g}, is no body any more: its "
                      "mass, inertia or stiffness is not positive",
                      body.name, derivative.variable, derivative.value + distance));
    }
  }
  if (is_there) return imported.file;
  auto continued = std::make_shared<InvariantsFile>(*imported.file);
  continued->constants = std::move(constants);
  return continued;
}

int place_at(const ImportedBody& imported, const Point& point, const Design<double>& start) {
  const Pose<double> pose = beam_pose(imported, start);
  return nearest_place(imported.file->constants,
                       pose.rotation.transpose() * (resolve_point(point, start) - pose.origin));
}

bool is_symmetric(const BodyConstants& constants, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d shift = Eigen::MatrixXd(constants.shape).cwiseAbs().rowwise().maxCoeff();
  const double length = size_of(constants), moved = std::max(shift.maxCoeff(), 1e-300);
  if (std::abs(constants.first_moment.dot(normal)) > plane_tolerance * constants.mass * length) {
    return false;
  }
  const Eigen::VectorXd along = Eigen::MatrixXd(constants.shape).transpose() * normal;
  return !couples_across(constants.second_moment, normal,
                         constants.second_moment.cwiseAbs().maxCoeff()) &&
         along.cwiseAbs().maxCoeff() <= plane_tolerance * moved &&
         !couples_across(constants.mixed, normal) && !couples_across(constants.moments, normal) &&
         std::ranges::none_of(constants.places,
                              [&](const BodyPlace& place) { return leaves_plane(place, normal); });
}

}  // namespace pleuel
