#pragma once

#include "core/scene/number_keys.hpp"

/// Every number of a scene that may be bound to a design variable, with what it measures.
/// `visit(number, quantity)` is called for those of the tables (number_keys.hpp), and for lists of
/// numbers. Structs with such lists are taken apart by all their members: one that is added does not
/// compile before it is looked at here, where a number that is left out would have no derivatives.
namespace pleuel {

namespace visiting {

template <class Numbers, class Visit>
void all(const Numbers& numbers, const Quantity& quantity, Visit& visit) {
  for (const Number& number : numbers) visit(number, quantity);
}

/// Those of the struct's table.
template <class Struct, class Visit, class... Measures>
void keyed(const Struct& object, Visit& visit, const Measures&... measures) {
  for (const NumberKey<Struct>& key : number_keys(KeysOf<Struct>(), measures...)) {
    if (const Number* number = key.of(object)) visit(*number, key.quantity);
  }
}

}  // namespace visiting

template <class Visit>
void visit_numbers(const Section& section, Visit&& visit) {
  std::visit([&](const auto& s) { visiting::keyed(s, visit); }, section);
  if (const auto* general = std::get_if<GeneralSection>(&section)) {
    for (const GeneralStressPoint& point : general->points) visiting::keyed(point, visit);
  }
}

template <class Visit>
void visit_numbers(const Material& material, Visit&& visit) {
  visiting::keyed(material, visit);
}

namespace visiting {

template <class Visit>
struct FunctionNumbers {
  const Quantity& value;
  Visit& visit;

  template <class Function>
  void operator()(const Function& function) const {
    keyed(function, visit, value);
  }
  void operator()(const PolynomialFunction& polynomial) const {
    Quantity quantity = value;
    for (const Number& coefficient : polynomial.coefficients) {
      if (&coefficient != polynomial.coefficients.data()) quantity = per_time(quantity);
      visit(coefficient, quantity);
    }
  }
  void operator()(const TableFunction& table) const { all(table.values, value, visit); }
  /// What a variable measures in a formula is not known here (NumberReader::quantity_of).
  void operator()(const ExpressionFunction& formula) const {
    all(formula.variables, quantities::pure_number, visit);
  }
};

}  // namespace visiting

/// @param value  what the function itself measures
template <class Visit>
void visit_numbers(const TimeFunction& function, const Quantity& value, Visit&& visit) {
  std::visit(visiting::FunctionNumbers<std::remove_reference_t<Visit>>{value, visit}, function);
}

namespace visiting {

template <class Visit>
struct ShapeNumbers {
  Visit& visit;

  void operator()(const BeamBody& beam) const {
    const auto& [from, to, material, segments, frame, damping, reference, is_rigid, has_shear,
                 reduction, held, frames, pieces, part] = beam;
    all(from, quantities::length, visit);
    all(to, quantities::length, visit);
    for (const Segment& segment : segments) visit_numbers(segment.section, visit);
    keyed(damping, visit);
  }
  void operator()(const RigidBody& body) const {
    const auto& [at, mass, inertia] = body;
    all(at, quantities::length, visit);
    keyed(body, visit);
    all(inertia, quantities::inertia, visit);
  }
  void operator()(const ImportedBody& body) const {
    const auto& [from, to, reference, source, file, variables, is_linear] = body;
    all(from, quantities::length, visit);
    all(to, quantities::length, visit);
    for (const ImportedVariable& of : variables) visit(of.number, of.quantity);
  }
  void operator()(const PointMass& body) const {
    const auto& [at, mass] = body;
    all(at, quantities::length, visit);
    keyed(body, visit);
  }
};

}  // namespace visiting

template <class Visit>
void visit_numbers(const Body& body, Visit&& visit) {
  const auto& [name, shape, velocity, angular_velocity, initial_deflections] = body;
  std::visit(visiting::ShapeNumbers<std::remove_reference_t<Visit>>{visit}, shape);
  visiting::all(velocity, quantities::speed, visit);
  visiting::all(angular_velocity, quantities::angular_speed, visit);
  for (const InitialDeflection& one : initial_deflections) {
    visiting::all(one.at, quantities::length, visit);
    visiting::keyed(one, visit);
  }
}

inline Quantity driven_quantity(DrivenCoordinate coordinate) {
  return coordinate == DrivenCoordinate::angle ? quantities::angle : quantities::length;
}

template <class Visit>
void visit_numbers(const Joint& joint, Visit&& visit) {
  const auto& [name, type, bodies, at, axis, second_axis, to, drive] = joint;
  visiting::all(at, quantities::length, visit);
  visiting::all(to, quantities::length, visit);
  if (drive) visit_numbers(drive->motion, driven_quantity(drive->coordinate), visit);
}

namespace visiting {

template <class Visit>
struct LoadNumbers {
  Visit& visit;

  void operator()(const PointForce& force) const {
    const auto& [body, at, direction, value, follows_body, over] = force;
    all(at, quantities::length, visit);
    visit_numbers(value, quantities::force, visit);
  }
  void operator()(const PointTorque& torque) const {
    const auto& [body, at, direction, value, follows_body, over] = torque;
    all(at, quantities::length, visit);
    visit_numbers(value, quantities::torque, visit);
  }
  void operator()(const SpringDamper& spring) const {
    const auto& [bodies, at, stiffness, damping, free_length, resistance] = spring;
    for (const Point& point : at) all(point, quantities::length, visit);
    keyed(spring, visit);
    if (resistance) visit_numbers(*resistance, quantities::force, visit);
  }
  void operator()(const JointForce& force) const {
    const auto& [joint, coordinate, stiffness, damping, rest, motor, control, resistance] = force;
    const AlongCoordinate measures = along(coordinate);
    keyed(force, visit, measures);
    if (motor) visit_numbers(*motor, measures.force, visit);
    if (control) {
      visit_numbers(control->target, measures.coordinate, visit);
      keyed(*control, visit, measures);
    }
    if (resistance) visit_numbers(*resistance, measures.force, visit);
  }
};

}  // namespace visiting

template <class Visit>
void visit_numbers(const Load& load, Visit&& visit) {
  std::visit(visiting::LoadNumbers<std::remove_reference_t<Visit>>{visit}, load.element);
}

template <class Visit>
void visit_numbers(const Scene& scene, Visit&& visit) {
  visiting::all(scene.gravity, quantities::acceleration, visit);
  for (const Material& material : scene.materials) visit_numbers(material, visit);
  for (const Body& body : scene.bodies) visit_numbers(body, visit);
  for (const Joint& joint : scene.joints) visit_numbers(joint, visit);
  for (const Load& load : scene.loads) visit_numbers(load, visit);
}

}  // namespace pleuel
