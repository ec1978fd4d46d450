#pragma once

#include "core/scene/scene.hpp"
#include "core/scene/units.hpp"

/// Every number of a scene that may be bound to a design variable, with what it measures: the only
/// list of them. `visit(number, quantity)` is called in the order of the structs. Structs are taken
/// apart by all their members: one that is added does not compile before it is looked at here, where
/// a number that is left out would have no derivatives.
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
    if (s.shear_area_y) visit(*s.shear_area_y, quantities::area);
    if (s.shear_area_z) visit(*s.shear_area_z, quantities::area);
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
  const auto& [name, young, poisson, density, strength, ultimate, endurance, fatigue, exponent] =
      material;
  visit(young, quantities::stress);
  visit(poisson, quantities::pure_number);
  visit(density, quantities::density);
  for (auto* limit : {&strength, &ultimate, &endurance, &fatigue}) {
    if (*limit) visit(**limit, quantities::stress);
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

namespace visiting {

template <class Visit>
struct ShapeNumbers {
  Visit& visit;

  void operator()(const BeamBody& beam) const {
    const auto& [from, to, material, segments, frame, damping, reference, is_rigid, has_shear,
                 reduction, frames, part] = beam;
    all(from, quantities::length, visit);
    all(to, quantities::length, visit);
    for (const Segment& segment : segments) visit_numbers(segment.section, visit);
    visit(damping.mass, quantities::rate);
    visit(damping.stiffness, quantities::time);
    visit(damping.modal, quantities::pure_number);
  }
  void operator()(const RigidBody& body) const {
    const auto& [at, mass, inertia] = body;
    all(at, quantities::length, visit);
    visit(mass, quantities::mass);
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
    visit(mass, quantities::mass);
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
    visit(one.displacement, quantities::length);
    visit(one.rate, quantities::speed);
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
    visit(stiffness, quantities::spring_stiffness);
    visit(damping, quantities::damping_constant);
    if (free_length) visit(*free_length, quantities::length);
    if (resistance) visit_numbers(*resistance, quantities::force, visit);
  }
  void operator()(const JointForce& force) const {
    const auto& [joint, coordinate, stiffness, damping, rest, motor, control, resistance] = force;
    const AlongCoordinate measures = along(coordinate);
    visit(stiffness, measures.stiffness);
    visit(damping, measures.damping);
    visit(rest, measures.coordinate);
    if (motor) visit_numbers(*motor, measures.force, visit);
    if (control) {
      visit_numbers(control->target, measures.coordinate, visit);
      visit(control->proportional, measures.stiffness);
      visit(control->derivative, measures.damping);
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
