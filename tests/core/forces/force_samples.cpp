#include "tests/core/forces/force_samples.hpp"

#include <cmath>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/forces/joint_force.hpp"
#include "core/forces/point_load.hpp"
#include "core/forces/spring_damper.hpp"
#include "core/frame/number_data.hpp"

using namespace pleuel;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Marker spatial_marker(int offset) {
  Marker marker;
  marker.frame.offset = offset;
  marker.frame.rotation = RotationCoordinates::rotation_vector;
  for (int i = 0; i < 6; ++i) marker.elastic[i] = offset + 6 + i;
  return marker;
}

/// In the plane normal to (0.36, 0.48, 0.8); local z is the normal.
Marker planar_marker(int offset) {
  Marker marker;
  BodyFrame& frame = marker.frame;
  frame.offset = offset;
  frame.rotation = RotationCoordinates::angle;
  frame.axis = Vector3d(0.36, 0.48, 0.8);
  frame.basis.resize(3, 2);
  frame.basis.col(0) = Vector3d(0.8, -0.6, 0.0);
  frame.basis.col(1) = frame.axis.cross(Vector3d(0.8, -0.6, 0.0));
  frame.reference.col(0) = frame.basis.col(0);
  frame.reference.col(1) = frame.basis.col(1);
  frame.reference.col(2) = frame.axis;
  marker.elastic = {offset + 3, offset + 4, -1, -1, -1, offset + 5};
  return marker;
}

Marker ground_marker() {
  Marker marker{.frame = ground_frame()};
  return marker;
}

/// Motion of one marker, by the definition of its coordinates.
struct Place {
  Eigen::Matrix3d A;
  Vector3d r, u = Vector3d::Zero(), psi = Vector3d::Zero();
  double angle = 0.0;

  Place(const Marker& marker, const VectorXd& q) {
    const BodyFrame& frame = marker.frame;
    const int k = frame.translations();
    r = frame.origin + frame.basis * q.segment(k > 0 ? frame.offset : 0, k);
    A.setIdentity();
    if (frame.rotation == RotationCoordinates::angle) {
      angle = q(frame.offset + k);
      A = Eigen::AngleAxisd(angle, frame.axis) * frame.reference;
    } else if (frame.rotation == RotationCoordinates::rotation_vector) {
      A = rotation_of(q.segment<3>(frame.offset + k));
    }
    for (int i = 0; i < 6; ++i) {
      const int index = marker.elastic[i];
      if (index >= 0) (i < 3 ? u : psi)(i % 3) = q(index);
    }
  }
  Vector3d point(const Vector3d& p) const { return r + A * (p + u); }
  Vector3d direction(const Vector3d& s) const { return A * (rotation_of(psi) * s); }
};

template <template <class> class Data>
int count_numbers(const Data<double>& data) {
  int count = 0;
  convert_data<double>(data, [&](double number) { return ++count, number; });
  return count;
}

template <template <class> class Data>
Data<double> shifted(const Data<double>& data, int number, double shift) {
  int i = 0;
  return convert_data<double>(data, [&](double x) { return i++ == number ? x + shift : x; });
}

/// Every number is a variable of its own.
template <template <class> class Data>
std::vector<DesignDerivative<Data<double>>> all_derivatives(const Data<double>& data) {
  std::vector<DesignDerivative<Data<double>>> derivatives;
  for (int variable = 0; variable < count_numbers(data); ++variable) {
    int i = 0;
    derivatives.push_back({variable, convert_data<double>(data, [&](double) {
                             return i++ == variable ? 1.0 : 0.0;
                           })});
  }
  return derivatives;
}

template <class Data, class Make>
void set_data(ForceSample& sample, const Data& data, const Make& make) {
  sample.numbers = count_numbers(data);
  sample.make_shifted = [=](int number, double shift) {
    const Data moved = shifted(data, number, shift);
    return make(moved, all_derivatives(moved));
  };
}

template <class Data, class Make>
void set_parts(ForceSample& sample, const Data& data, const Make& make) {
  sample.stiffness = data.stiffness;
  sample.damping = data.damping;
  Data spring = data, damper = data;
  spring.damping = damper.stiffness = 0.0;
  sample.make_spring = [=] { return make(spring, all_derivatives(spring)); };
  sample.make_damper = [=] { return make(damper, all_derivatives(damper)); };
}

TimeLaw<double> harmonic() {
  return {TimeLaw<double>::Kind::harmonic, {3.0, 5.0, 0.4, 2.0}, {}};
}

ForceSample point_load_sample(const Mount& mount, LoadKind kind, LoadDirection direction) {
  const std::string what = kind == LoadKind::force ? "Force" : "Torque";
  const char* where = direction == LoadDirection::space ? "Space" : "Body";
  ForceSample sample{where + what + mount.name, mount};
  const PointLoadData<double> data{{0.3, -0.2, 0.5}, {0.6, 0.48, 0.64}, harmonic()};
  set_data(sample, data, [=](const auto& at, auto derivatives) {
    return make_point_load_term({"f", mount.markers[1], kind, direction}, at, derivatives);
  });
  return sample;
}

ForceSample spring_damper_sample(const Mount& mount) {
  ForceSample sample{"SpringDamper" + mount.name, mount};
  const SpringDamperData<double> data{{Vector3d(0.3, -0.2, 0.5), Vector3d(-0.7, 0.1, 0.4)},
                                      /*stiffness=*/7.0,
                                      /*damping=*/0.9,
                                      /*free_length=*/0.6};
  const auto make = [=](const auto& at, auto derivatives) {
    return make_spring_damper({"s", mount.markers}, at, derivatives).term;
  };
  set_data(sample, data, make);
  set_parts(sample, data, make);
  sample.rest = data.free_length;
  sample.coordinate = [=](const VectorXd& q) {
    return (Place(mount.markers[1], q).point(data.points[1]) -
            Place(mount.markers[0], q).point(data.points[0]))
        .norm();
  };
  return sample;
}

JointForceData<double> joint_force_data() {
  JointForceData<double> data;
  data.points = {Vector3d(0.3, -0.2, 0.5), Vector3d(-0.7, 0.1, 0.4)};
  data.directions = {Vector3d(0.8, 0.6, 0.0), Vector3d(-0.48, 0.64, 0.6), Vector3d(0.6, 0.8, 0.0)};
  data.stiffness = 7.0;
  data.damping = 0.9;
  data.rest = 0.2;
  return data;
}

double joint_coordinate(RelativeCoordinate kind, const Mount& mount,
                        const JointForceData<double>& data, double sense, const VectorXd& q) {
  const Place first(mount.markers[0], q), second(mount.markers[1], q);
  const auto& [a, b, c] = data.directions;
  switch (kind) {
    case RelativeCoordinate::planar_angle:  // local z is the normal
      return sense * (second.angle + second.psi.z() - first.angle - first.psi.z() - data.offset);
    case RelativeCoordinate::angle: {
      const Vector3d d = second.direction(c);
      return std::arg(std::complex<double>(d.dot(first.direction(a)), d.dot(first.direction(b))));
    }
    default:
      return first.direction(a).dot(second.point(data.points[1]) - first.point(data.points[0]));
  }
}

ForceSample joint_force_sample(const Mount& mount, RelativeCoordinate kind, const char* name,
                               double sense = 1.0) {
  ForceSample sample{name + mount.name, mount};
  JointForceData<double> data = joint_force_data();
  if (kind == RelativeCoordinate::planar_angle) data.offset = 0.4;
  const auto make = [=](const auto& at, auto derivatives) {
    return make_joint_force({"j", mount.markers, kind, sense}, at, derivatives).term;
  };
  set_parts(sample, data, make);
  sample.rest = data.rest;
  sample.coordinate = [=](const VectorXd& q) {
    return joint_coordinate(kind, mount, data, sense, q);
  };
  data.motor = harmonic();
  set_data(sample, data, make);
  return sample;
}

std::vector<ForceSample> all_force_samples() {
  std::vector<ForceSample> samples;
  for (const Mount& mount : all_mounts()) {
    for (LoadDirection direction : {LoadDirection::space, LoadDirection::body}) {
      samples.push_back(point_load_sample(mount, LoadKind::force, direction));
      samples.push_back(point_load_sample(mount, LoadKind::torque, direction));
    }
    samples.push_back(spring_damper_sample(mount));
    samples.push_back(joint_force_sample(mount, RelativeCoordinate::displacement, "Slider"));
    samples.push_back(joint_force_sample(mount, RelativeCoordinate::angle, "Hinge"));
    if (mount.name != "InThePlane") continue;
    samples.push_back(joint_force_sample(mount, RelativeCoordinate::planar_angle, "PlanarHinge"));
    samples.push_back(
        joint_force_sample(mount, RelativeCoordinate::planar_angle, "ReversedHinge", -1.0));
  }
  return samples;
}

}  // namespace

std::vector<Mount> all_mounts() {
  Marker mass;
  Marker other_place = spatial_marker(0);
  for (int& index : other_place.elastic) index += 6;
  return {{"InSpace", {spatial_marker(0), spatial_marker(12)}, 24, {3, 15}},
          {"InThePlane", {planar_marker(0), planar_marker(6)}, 12, {}},
          {"OnGroundAndBody", {ground_marker(), spatial_marker(0)}, 12, {3}},
          {"OnGroundAndPointMass", {ground_marker(), mass}, 3, {}},
          {"OnOneBody", {spatial_marker(0), other_place}, 18, {3}}};
}

State ForceSample::random_state() const {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  State state(mount.coordinates, 0);
  state.time = 0.13;
  for (auto* part : {&state.q, &state.v, &state.a}) {
    for (double& entry : *part) entry = uniform(random);
  }
  for (const Marker& marker : mount.markers) {
    for (std::size_t i = 0; i < 6; ++i) {
      const int index = marker.elastic[i];
      if (index >= 0) state.q(index) = (i < 3 ? 0.05 : 0.4) * uniform(random);
    }
  }
  return state;
}

VectorXd ForceSample::advanced(const VectorXd& q, const VectorXd& increment) const {
  VectorXd moved = q + increment;
  for (int first : mount.rotations) {
    moved.segment<3>(first) = compose(q.segment<3>(first), increment.segment<3>(first));
  }
  return moved;
}

std::vector<ForceSample> force_samples(ForceChoice choice) {
  std::vector<ForceSample> samples = all_force_samples();
  std::erase_if(samples, [&](const ForceSample& sample) {
    const bool is_internal = static_cast<bool>(sample.coordinate);
    const bool is_spatial = sample.mount.rotations.size() == 2;
    return (!is_internal &&
            (choice == ForceChoice::internal || choice == ForceChoice::internal_spatial)) ||
           (!is_spatial &&
            (choice == ForceChoice::spatial || choice == ForceChoice::internal_spatial));
  });
  return samples;
}

std::ostream& operator<<(std::ostream& stream, const ForceSample& sample) {
  return stream << sample.name;
}
