#pragma once

#include <vector>

#include "core/joints/joint.hpp"

/// The local coordinates and the numbers of a joint, as all that evaluates it needs them.
namespace pleuel {

/// Indices in q of a joint's local coordinates: for each marker its frame, then its elastic ones.
inline std::vector<int> local_coordinates(const JointTopology& topology) {
  std::vector<int> coordinates;
  for (const Marker& marker : topology.markers) {
    for (int i = 0; i < marker.frame.size(); ++i) coordinates.push_back(marker.frame.offset + i);
    for (int index : marker.elastic) {
      if (index >= 0) coordinates.push_back(index);
    }
  }
  return coordinates;
}

/// The same numbers in another scalar type, all derivatives zero.
template <class Scalar>
JointData<Scalar> cast_data(const JointData<double>& data) {
  JointData<Scalar> cast;
  for (std::size_t i = 0; i < 2; ++i) cast.points[i] = data.points[i].template cast<Scalar>();
  for (const auto& direction : data.directions) {
    cast.directions.push_back(direction.template cast<Scalar>());
  }
  cast.offset = Scalar(data.offset);
  cast.length = Scalar(data.length);
  cast.drive = data.drive.transformed<Scalar>([](double parameter) { return Scalar(parameter); });
  return cast;
}

/// The numbers with their derivatives.
inline JointData<Dual> seed_data(const JointData<double>& data,
                                 const JointData<double>& derivative) {
  const auto with_derivative = [](double value, double change) {
    return Dual(value, Dual::Derivatives::Constant(change));
  };
  JointData<Dual> seeded = cast_data<Dual>(data);
  for (std::size_t i = 0; i < 2; ++i) {
    seeded.points[i] = data.points[i].binaryExpr(derivative.points[i], with_derivative);
  }
  for (std::size_t i = 0; i < data.directions.size(); ++i) {
    seeded.directions[i] = data.directions[i].binaryExpr(derivative.directions[i], with_derivative);
  }
  seeded.offset = with_derivative(data.offset, derivative.offset);
  seeded.length = with_derivative(data.length, derivative.length);
  for (std::size_t i = 0; i < data.drive.parameters.size(); ++i) {
    seeded.drive.parameters[i] =
        with_derivative(data.drive.parameters[i], derivative.drive.parameters[i]);
  }
  return seeded;
}

}  // namespace pleuel
