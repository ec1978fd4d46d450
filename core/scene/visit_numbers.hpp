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

/// What numbers of a force element measure that acts along an angle or a displacement.
struct AlongCoordinate {
  Quantity coordinate, rate, force, stiffness, damping;
};
inline AlongCoordinate along(DrivenCoordinate coordinate) {
  if (coordinate == DrivenCoordinate::angle) {
    return {quantities::angle, quantities::angular_speed, quantities::torque,
            quantities::torsional_stiffness, quantities::torsional_damping};
  }
  return {quantities::length, quantities::speed, quantities::force, quantities::spring_stiffness,
          quantities::damping_constant};
}
/// @param force  a torque or a force
inline AlongCoordinate along(const Quantity& force) {
  return along(force == quantities::torque ? DrivenCoordinate::angle
                                           : DrivenCoordinate::displacement);
}

template <class Visit>
void visit_numbers(const Section& section, Visit&& visit) {
  std::visit(visiting::SectionNumbers<std::remove_reference_t<Visit>>{visit}, section);
}

template <class Visit>
void visit_numbers(const Material& material, Visit&& visit) {
  visit(material.young, quantities::stress);
  visit(material.poisson, quantities::pure_number);
  visit(material.density, quantities::density);
  for (auto* strength : {&material.strength, &material.ultimate_strength, &material.endurance_limit,
                         &material.fatigue_strength}) {
    if (*strength) visit(**strength, quantities::stress);
  }
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
  } else if (const auto* table = std::get_if<TableFunction>(&function)) {
    visiting::all(table->values, value, visit);
  } else if (const auto* flank = std::get_if<RampFunction>(&function)) {
    visit(flank->from, value);
    visit(flank->to, value);
  } else if (const auto* wave = std::get_if<HalfSineFunction>(&function)) {
    visit(wave->amplitude, value);
    visit(wave->offset, value);
  } else if (const auto* formula = std::get_if<ExpressionFunction>(&function)) {
    // What a variable measures in a formula is not known here (NumberReader::quantity_of).
    for (const Number& number : formula->variables) visit(number, quantities::pure_number);
  } else if (const auto* friction = std::get_if<FrictionLaw>(&function)) {
    visit(friction->value, value);
    visit(friction->speed, along(value).rate);
  } else {
    const auto& clearance = std::get<ClearanceLaw>(function);
    visit(clearance.lower, along(value).coordinate);
    visit(clearance.upper, along(value).coordinate);
    visit(clearance.stiffness, along(value).stiffness);
    visit(clearance.rounding, along(value).coordinate);
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
  for (const InitialDeflection& one : body.initial_deflections) {
    visiting::all(one.at, quantities::length, visit);
    visit(one.displacement, quantities::length);
    visit(one.rate, quantities::speed);
  }
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
    if (spring->resistance) visit_numbers(*spring->resistance, quantities::force, visit);
  } else {
    const auto& joint = std::get<JointForce>(load.element);
    const AlongCoordinate measures = along(joint.coordinate);
    visit(joint.stiffness, measures.stiffness);
    visit(joint.damping, measures.damping);
    visit(joint.rest, measures.coordinate);
    if (joint.motor) visit_numbers(*joint.motor, measures.force, visit);
    if (joint.control) {
      visit_numbers(joint.control->target, measures.coordinate, visit);
      visit(joint.control->proportional, measures.stiffness);
      visit(joint.control->derivative, measures.damping);
    }
    if (joint.resistance) visit_numbers(*joint.resistance, measures.force, visit);
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
