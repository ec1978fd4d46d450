#include "cli/variable_quantity.hpp"

#include <optional>

namespace pleuel {

namespace {

/// Goes through the numbers of a scene until it finds one that is bound to the variable.
class Search {
 public:
  explicit Search(int variable) : variable_(variable) {}

  std::optional<Quantity> in(const Scene& scene) {
    for (const Number& g : scene.gravity) see(g, quantities::acceleration);
    for (const Material& material : scene.materials) {
      see(material.young, quantities::stress);
      see(material.poisson, quantities::pure_number);
      see(material.density, quantities::density);
    }
    for (const Body& body : scene.bodies) {
      std::visit([this](const auto& shape) { see_shape(shape); }, body.shape);
    }
    for (const Joint& joint : scene.joints) {
      see_point(joint.at);
      if (joint.drive) std::visit([this](const auto& drive) { see_drive(drive); }, *joint.drive);
    }
    return found_;
  }

 private:
  void see(const Number& number, const Quantity& quantity) {
    if (!found_ && number.variable == variable_) found_.emplace(quantity);
  }
  void see_point(const Point& point) {
    for (const Number& coordinate : point) see(coordinate, quantities::length);
  }

  void see_section(const RectangleSection& section) {
    see(section.width, quantities::length);
    see(section.height, quantities::length);
  }
  void see_section(const CircleSection& section) { see(section.diameter, quantities::length); }
  void see_section(const TubeSection& section) {
    see(section.outer_diameter, quantities::length);
    see(section.thickness, quantities::length);
  }

  void see_shape(const BeamBody& beam) {
    see_point(beam.from);
    see_point(beam.to);
    for (const Segment& segment : beam.segments) {
      std::visit([this](const auto& section) { see_section(section); }, segment.section);
    }
    see(beam.damping.mass, quantities::rate);
    see(beam.damping.stiffness, quantities::time);
  }
  void see_shape(const RigidBody& body) {
    see_point(body.at);
    see(body.mass, quantities::mass);
    for (const Number& entry : body.inertia) see(entry, quantities::inertia);
  }
  void see_shape(const PointMass& body) {
    see_point(body.at);
    see(body.mass, quantities::mass);
  }

  void see_drive(const ConstantSpeedDrive& drive) { see(drive.speed, quantities::angular_speed); }
  void see_drive(const RampToSpeedDrive& drive) {
    see(drive.speed, quantities::angular_speed);
    see(drive.ramp, quantities::time);
  }

  int variable_;
  std::optional<Quantity> found_;
};

bool names(const ConstraintSettings& constraint, int variable) {
  for (const auto& [other, coefficient] : constraint.linear) {
    if (other == variable) return true;
  }
  return false;
}

}  // namespace

Quantity variable_quantity(const ProblemFile& problem, int variable) {
  if (const auto quantity = Search(variable).in(problem.scene)) return *quantity;
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (!names(constraint, variable)) continue;
    for (const auto& [other, coefficient] : constraint.linear) {
      if (const auto quantity = Search(other).in(problem.scene)) return *quantity;
    }
  }
  return quantities::pure_number;
}

}  // namespace pleuel
