#pragma once

#include <string>

#include "core/scene/scene.hpp"

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
