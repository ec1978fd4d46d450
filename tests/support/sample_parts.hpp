#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.hpp"
#include "tests/support/sample_scenes.hpp"

/// What the sample scenes are put together from.

namespace sample_parts {

using namespace pleuel;

/// A sample in the making, whose numbers may be bound to variables.
class SceneWriter {
 public:
  /// A number bound to a new variable.
  Number variable(const std::string& name, double value) {
    sample.variables.push_back(name);
    sample.design.push_back(value);
    return Number::bound(static_cast<int>(sample.design.size()) - 1);
  }
  /// constant + factor · an existing variable
  static Number shifted(double constant, const Number& number, double factor = 1.0) {
    Number result = Number::bound(number.variable, factor * number.factor);
    result.constant = constant + factor * number.constant;
    return result;
  }
  Scene& scene() { return sample.scene; }

  SampleScene sample;
};

inline Joint joint(const std::string& name, JointType type, const std::string& first,
                   const std::string& second, const Point& at, const std::array<double, 3>& axis) {
  Joint result;
  result.name = name;
  result.type = type;
  result.bodies = {first, second};
  result.at = at;
  result.axis = axis;
  return result;
}

inline BeamBody beam(const Point& from, const Point& to, std::vector<Segment> segments,
                     ReferenceCondition frame) {
  BeamBody result;
  result.from = from;
  result.to = to;
  result.material = "steel";
  result.segments = std::move(segments);
  result.frame = frame;
  return result;
}

inline Joint driven(Joint joint, const TimeFunction& motion,
                    DrivenCoordinate coordinate = DrivenCoordinate::angle) {
  joint.drive = Drive(motion, coordinate);
  return joint;
}

inline Joint universal(Joint joint, const std::array<double, 3>& second_axis) {
  joint.second_axis = second_axis;
  return joint;
}

inline Joint distance(Joint joint, const Point& to) {
  joint.to = to;
  return joint;
}

}  // namespace sample_parts

/// Parts of mechanisms in the x–y plane.

inline pleuel::RigidBody body_at(double x, double y, double mass, double inertia) {
  pleuel::RigidBody body;
  body.at = {x, y, 0.0};
  body.mass = mass;
  body.inertia = {0.0, 0.0, inertia, 0.0, 0.0, 0.0};
  return body;
}

inline pleuel::Joint joint(pleuel::JointType type, const std::string& first,
                           const std::string& second, const Eigen::Vector2d& at) {
  pleuel::Joint result;
  result.name = first + "-" + second;
  result.type = type;
  result.bodies = {first, second};
  result.at = {at.x(), at.y(), 0.0};
  return result;
}

inline pleuel::Joint revolute(const std::string& first, const std::string& second,
                              const Eigen::Vector2d& at) {
  return joint(pleuel::JointType::revolute, first, second, at);
}
