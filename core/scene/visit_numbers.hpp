#pragma once

#include "core/scene/scene.hpp"
#include "core/scene/units.hpp"

/// Every number of a scene that may be bound to a design variable, with what it measures: the only
/// list of them. `visit(number, quantity)` is called in the order of the structs.
namespace pleuel {

namespace visiting {

template <class Numbers, class Visit>
void all(const Numbers& numbers, const Quantity& quantity, Visit& visit) {
  for (const Number& number : numbers) visit(number, quantity);
}

template <class Visit>
struct SectionNumbers {
  Visit& visit;

  void lengths(std::initializer_list<const Number*> numbers) const {
    for (const Number* number : numbers) visit(*number, quantities::length);
  }
  void operator()(const RectangleSection& s) const { lengths({&s.width, &s.height}); }
  void operator()(const CircleSection& s) const { lengths({&s.diameter}); }
  void operator()(const TubeSection& s) const { lengths({&s.outer_diameter, &s.thickness}); }
  void operator()(const EllipseSection& s) const { lengths({&s.width, &s.height}); }
  void operator()(const BoxSection& s) const { lengths({&s.width, &s.height, &s.thickness}); }
  void operator()(const ISection& s) const {
    lengths({&s.width, &s.height, &s.flange_thickness, &s.web_thickness});
  }
  void operator()(const GeneralSection& s) const {
    visit(s.area, quantities::area);
    visit(s.inertia_y, quantities::second_moment_of_area);
    visit(s.inertia_z, quantities::second_moment_of_area);
    visit(s.torsion, quantities::second_moment_of_area);
    for (const GeneralStressPoint& point : s.points) {
      lengths({&point.y, &point.z});
      visit(point.shear, quantities::torsional_shear);
    }
  }
};

}  // namespace visiting

template <class Visit>
void visit_numbers(const Section& section, Visit&& visit) {
  std::visit(visiting::SectionNumbers<std::remove_reference_t<Visit>>{visit}, section);
}

template <class Visit>
void visit_numbers(const Material& material, Visit&& visit) {
  visit(material.young, quantities::stress);
  visit(material.poisson, quantities::pure_number);
  visit(material.density, quantities::density);
  if (material.strength) visit(*material.strength, quantities::stress);
}

/// @param value  what the function itself measures
template <class Visit>
void visit_numbers(const TimeFunction& function, const Quantity& value, Visit&& visit) {
  if (const auto* constant = std::get_if<ConstantFunction>(&function)) {
    visit(constant->value, value);
  } else if (const auto* speed = std::get_if<ConstantSpeedDrive>(&function)) {
    visit(speed->speed, per_time(value));
  } else if (const auto* ramp = std::get_if<RampToSpeedDrive>(&function)) {
    visit(ramp->speed, per_time(value));
    visit(ramp->ramp, quantities::time);
  } else if (const auto* polynomial = std::get_if<PolynomialFunction>(&function)) {
    const std::vector<Number>& coefficients = polynomial->coefficients;
    Quantity quantity = value;
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
      if (i > 0) quantity = per_time(quantity);
      visit(coefficients[i], quantity);
    }
  } else if (const auto* harmonic = std::get_if<HarmonicFunction>(&function)) {
    visit(harmonic->amplitude, value);
    visit(harmonic->frequency, quantities::angular_speed);
    visit(harmonic->phase, quantities::angle);
    visit(harmonic->offset, value);
  } else {
    visiting::all(std::get<TableFunction>(function).values, value, visit);
  }
}

template <class Visit>
void visit_numbers(const Body& body, Visit&& visit) {
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    visiting::all(beam->from, quantities::length, visit);
    visiting::all(beam->to, quantities::length, visit);
    for (const Segment& segment : beam->segments) visit_numbers(segment.section, visit);
    visit(beam->damping.mass, quantities::rate);
    visit(beam->damping.stiffness, quantities::time);
    visit(beam->damping.modal, quantities::pure_number);
  } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
    visiting::all(rigid->at, quantities::length, visit);
    visit(rigid->mass, quantities::mass);
    visiting::all(rigid->inertia, quantities::inertia, visit);
  } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
    visiting::all(imported->from, quantities::length, visit);
    visiting::all(imported->to, quantities::length, visit);
    for (const ImportedVariable& of : imported->variables) visit(of.number, of.quantity);
  } else {
    const auto& point = std::get<PointMass>(body.shape);
    visiting::all(point.at, quantities::length, visit);
    visit(point.mass, quantities::mass);
  }
  visiting::all(body.velocity, quantities::speed, visit);
  visiting::all(body.angular_velocity, quantities::angular_speed, visit);
}

inline Quantity driven_quantity(DrivenCoordinate coordinate) {
  return coordinate == DrivenCoordinate::angle ? quantities::angle : quantities::length;
}

template <class Visit>
void visit_numbers(const Joint& joint, Visit&& visit) {
  visiting::all(joint.at, quantities::length, visit);
  visiting::all(joint.to, quantities::length, visit);
  if (joint.drive) {
    visit_numbers(joint.drive->motion, driven_quantity(joint.drive->coordinate), visit);
  }
}

template <class Visit>
void visit_numbers(const Load& load, Visit&& visit) {
  if (const auto* force = std::get_if<PointForce>(&load.element)) {
    visiting::all(force->at, quantities::length, visit);
    visit_numbers(force->value, quantities::force, visit);
  } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
    visiting::all(torque->at, quantities::length, visit);
    visit_numbers(torque->value, quantities::torque, visit);
  } else if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
    for (const Point& point : spring->at) visiting::all(point, quantities::length, visit);
    visit(spring->stiffness, quantities::spring_stiffness);
    visit(spring->damping, quantities::damping_constant);
    if (spring->free_length) visit(*spring->free_length, quantities::length);
  } else {
    const auto& joint = std::get<JointForce>(load.element);
    const bool is_angle = joint.coordinate == DrivenCoordinate::angle;
    visit(joint.stiffness,
          is_angle ? quantities::torsional_stiffness : quantities::spring_stiffness);
    visit(joint.damping, is_angle ? quantities::torsional_damping : quantities::damping_constant);
    visit(joint.rest, driven_quantity(joint.coordinate));
    if (joint.motor) {
      visit_numbers(*joint.motor, is_angle ? quantities::torque : quantities::force, visit);
    }
  }
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
