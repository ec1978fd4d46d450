#include "core/response/point_stress_signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/response/recovered_signal.hpp"

namespace pleuel {

namespace {

/// Stress at a point: xx yy zz xy yz xz [Pa].
using Stress = Eigen::Matrix<double, 6, 1>;

constexpr double tiny = 1e-300;  // keeps the root differentiable at zero [Pa²]

double von_mises(const Stress& s) {
  const double xy = s(0) - s(1), yz = s(1) - s(2), zx = s(2) - s(0);
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * s.tail<3>().squaredNorm() + tiny);
}

Stress von_mises_slope(const Stress& s) {
  Stress slope;
  slope << 2 * s(0) - s(1) - s(2), 2 * s(1) - s(2) - s(0), 2 * s(2) - s(0) - s(1), 6 * s(3),
      6 * s(4), 6 * s(5);
  return slope / (2.0 * von_mises(s));
}

/// Some of the points.
class StressPoints : public Stations {
 public:
  StressPoints(const BodyModel& body, const std::string& at) : body_(body) {
    if (!at.empty()) points_ = named_points(body.stress, at);
    for (int i = 0; at.empty() && i < int_size(body.stress.points); ++i) points_.push_back(i);
  }

  int numbers() const override { return 6; }
  Recovery recovery() const override { return rows_of(body_.stress); }
  Recovery recovery_derivative(std::size_t k) const override {
    return rows_of(body_.stress_x[k].data);
  }

 protected:
  const BodyModel& body() const { return body_; }
  int count() const { return int_size(points_); }
  const std::string& name(int station) const { return body_.stress.points[points_[station]]; }

 private:
  SparseMatrix rows_of(const SparseMatrix& all) const {
    SparseMatrix rows(6 * static_cast<Eigen::Index>(points_.size()), all.cols());
    if (all.rows() == 0) return rows;
    Eigen::Index row = 0;
    for (const int point : points_) {
      for (int i = 0; i < 6; ++i, ++row) rows.row(row) = all.row(6 * point + i);
    }
    return rows;
  }
  Recovery rows_of(const StressRecovery& stress) const {
    return {rows_of(stress.of_coordinates), rows_of(stress.of_accelerations),
            rows_of(stress.of_stretching)};
  }

  const BodyModel& body_;
  std::vector<int> points_;
};

/// One channel a point.
class EquivalentStress final : public StressPoints {
 public:
  EquivalentStress(const BodyModel& body, const std::string& at, StressPart part)
      : StressPoints(body, at),
        part_(part),
        strength_(part == StressPart::utilization ? body.stress.strengths.yield : 1.0) {}

  int channels() const override { return count(); }
  int station(int channel) const override { return channel; }
  std::string describe(int channel) const override { return name(channel); }

  double value(int, const double* numbers) const override {
    const Eigen::Map<const Stress> stress(numbers);
    return part_ == StressPart::normal ? stress(0) : von_mises(stress) / strength_;
  }
  Numbers slopes(int, const double* numbers) override {
    if (part_ == StressPart::normal) return Stress::Unit(0);
    return von_mises_slope(Eigen::Map<const Stress>(numbers)) / strength_;
  }
  double design_slope(int channel, const double* numbers, std::size_t k) const override {
    if (part_ != StressPart::utilization) return 0.0;
    return -value(channel, numbers) / strength_ * body().stress_x[k].data.strengths.yield;
  }

 private:
  StressPart part_;
  double strength_;  ///< that stress is divided by
};

constexpr int plane_angle = 15;  // between normals [degrees]

Eigen::Vector3d turned(const Eigen::Vector3d& x, const Eigen::Vector3d& y, double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return std::cos(angle) * x + std::sin(angle) * y;
}

/// Normals of planes that contain the normal of the motion.
std::vector<Eigen::Vector3d> directions_in_plane(const Eigen::Vector3d& normal) {
  Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  if (std::abs(normal.x()) > 0.5) x = Eigen::Vector3d::UnitY();
  x = (x - normal.dot(x) * normal).normalized();
  std::vector<Eigen::Vector3d> directions;
  for (int angle = 0; angle < 180; angle += plane_angle) {
    directions.push_back(turned(x, normal.cross(x), angle));
  }
  return directions;
}

/// On circles of latitude about the z axis; opposite normals are one plane.
std::vector<Eigen::Vector3d> directions_in_space() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  std::vector<Eigen::Vector3d> directions = directions_in_plane(z);
  for (int latitude = plane_angle; latitude <= 90; latitude += plane_angle) {
    const double circle = 360.0 * turned(Eigen::Vector3d::UnitX(), z, latitude).x();
    const int count = std::max(1, static_cast<int>(std::lround(circle / plane_angle)));
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d level =
          turned(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 360.0 * i / count);
      directions.push_back(turned(level, z, latitude));
    }
  }
  return directions;
}

/// nᵀ σ n = weights · σ
Stress weights_of(const Eigen::Vector3d& n) {
  Stress weights;
  weights << n.x() * n.x(), n.y() * n.y(), n.z() * n.z(), 2 * n.x() * n.y(), 2 * n.y() * n.z(),
      2 * n.x() * n.z();
  return weights;
}

/// One channel a point and plane.
class PlaneStress final : public StressPoints {
 public:
  PlaneStress(const BodyModel& body, const std::string& at) : StressPoints(body, at) {
    const bool is_planar = body.frame.rotation == RotationCoordinates::angle;
    directions_ = is_planar
                      ? directions_in_plane(body.frame.reference.transpose() * body.frame.axis)
                      : directions_in_space();
    for (const Eigen::Vector3d& direction : directions_) weights_.push_back(weights_of(direction));
  }

  int channels() const override { return count() * int_size(directions_); }
  int station(int channel) const override { return channel / int_size(directions_); }
  std::string describe(int channel) const override {
    const Eigen::Vector3d& n = directions_[channel % int_size(directions_)];
    return fmt::format("{}, along ({:.2f}, {:.2f}, {:.2f})", name(station(channel)), n.x(), n.y(),
                       n.z());
  }

  double value(int channel, const double* numbers) const override {
    return weights(channel).dot(Eigen::Map<const Stress>(numbers));
  }
  Numbers slopes(int channel, const double*) override { return weights(channel); }
  double design_slope(int, const double*, std::size_t) const override { return 0.0; }

 private:
  const Stress& weights(int channel) const { return weights_[channel % int_size(weights_)]; }

  std::vector<Eigen::Vector3d> directions_;
  std::vector<Stress> weights_;
};

}  // namespace

std::unique_ptr<Signal> make_point_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity, StressPart part,
                                                 const std::string& at) {
  return make_recovered_signal(body, gravity, std::make_unique<EquivalentStress>(body, at, part));
}

std::unique_ptr<Signal> make_plane_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity,
                                                 const std::string& at) {
  return make_recovered_signal(body, gravity, std::make_unique<PlaneStress>(body, at));
}

}  // namespace pleuel
