#include "core/scene/packed_problem.hpp"

#include <set>

#include "core/scene/invariants_file.hpp"

/// Each names all members of its struct: a new one does not compile unnoticed.
namespace pleuel {

// ---- numbers

template <class Archive>
void transfer(Archive& archive, ExpressionStep& step) {
  auto& [operation, constant, first, second] = step;
  archive(operation, constant, first, second);
}

template <class Archive>
void transfer(Archive& archive, ExpressionArgument& argument) {
  auto& [kind, index] = argument;
  archive(kind, index);
}

template <class Archive>
void transfer(Archive& archive, Expression& expression) {
  auto& [text, quantity, unit, arguments, steps, path] = expression;
  archive(text, quantity, unit, arguments, steps, path);
}

template <class Archive>
void transfer(Archive& archive, Number& number) {
  auto& [constant, variable, factor, expression] = number;
  archive(constant, variable, factor, expression);
}

template <class Archive>
void transfer(Archive& archive, RangedFormula& formula) {
  auto& [number, range, place, rule] = formula;
  archive(number, range, place, rule);
}

void transfer(Packer& archive, Quantity& quantity) {
  std::string name(quantity.name), unit(quantity.unit);
  archive(name, unit);
}

/// Names of quantities live as long as the program.
void transfer(Unpacker& archive, Quantity& quantity) {
  static std::set<std::string> names;
  std::string name, unit;
  archive(name, unit);
  quantity = {*names.insert(name).first, *names.insert(unit).first};
}

// ---- functions of time

template <class Archive>
void transfer(Archive& archive, ConstantFunction& function) {
  auto& [value] = function;
  archive(value);
}

template <class Archive>
void transfer(Archive& archive, ConstantSpeedDrive& function) {
  auto& [speed] = function;
  archive(speed);
}

template <class Archive>
void transfer(Archive& archive, RampToSpeedDrive& function) {
  auto& [speed, ramp] = function;
  archive(speed, ramp);
}

template <class Archive>
void transfer(Archive& archive, PolynomialFunction& function) {
  auto& [coefficients] = function;
  archive(coefficients);
}

template <class Archive>
void transfer(Archive& archive, HarmonicFunction& function) {
  auto& [amplitude, frequency, phase, offset] = function;
  archive(amplitude, frequency, phase, offset);
}

template <class Archive>
void transfer(Archive& archive, TableFunction& function) {
  auto& [times, values, interpolation, repetition, argument] = function;
  archive(times, values, interpolation, repetition, argument);
}

template <class Archive>
void transfer(Archive& archive, RampFunction& function) {
  auto& [from, to, begin, end, rounding] = function;
  archive(from, to, begin, end, rounding);
}

template <class Archive>
void transfer(Archive& archive, HalfSineFunction& function) {
  auto& [amplitude, offset, begin, duration, period] = function;
  archive(amplitude, offset, begin, duration, period);
}

template <class Archive>
void transfer(Archive& archive, ExpressionFunction& function) {
  auto& [expression, variables] = function;
  archive(expression, variables);
}

template <class Archive>
void transfer(Archive& archive, FrictionLaw& law) {
  auto& [value, speed] = law;
  archive(value, speed);
}

template <class Archive>
void transfer(Archive& archive, ClearanceLaw& law) {
  auto& [lower, upper, stiffness, rounding] = law;
  archive(lower, upper, stiffness, rounding);
}

// ---- sections and bodies

template <class Archive>
void transfer(Archive& archive, Material& material) {
  auto& [name, young, poisson, density, strength, ultimate_strength, endurance_limit,
         fatigue_strength, fatigue_exponent] = material;
  archive(name, young, poisson, density, strength, ultimate_strength, endurance_limit,
          fatigue_strength, fatigue_exponent);
}

template <class Archive>
void transfer(Archive& archive, RectangleSection& section) {
  auto& [width, height] = section;
  archive(width, height);
}

template <class Archive>
void transfer(Archive& archive, CircleSection& section) {
  auto& [diameter] = section;
  archive(diameter);
}

template <class Archive>
void transfer(Archive& archive, TubeSection& section) {
  auto& [outer_diameter, thickness] = section;
  archive(outer_diameter, thickness);
}

template <class Archive>
void transfer(Archive& archive, EllipseSection& section) {
  auto& [width, height] = section;
  archive(width, height);
}

template <class Archive>
void transfer(Archive& archive, BoxSection& section) {
  auto& [width, height, thickness] = section;
  archive(width, height, thickness);
}

template <class Archive>
void transfer(Archive& archive, ISection& section) {
  auto& [width, height, flange_thickness, web_thickness] = section;
  archive(width, height, flange_thickness, web_thickness);
}

template <class Archive>
void transfer(Archive& archive, GeneralStressPoint& point) {
  auto& [y, z, shear] = point;
  archive(y, z, shear);
}

template <class Archive>
void transfer(Archive& archive, GeneralSection& section) {
  auto& [area, inertia_y, inertia_z, torsion, points, shear_area_y, shear_area_z] = section;
  archive(area, inertia_y, inertia_z, torsion, points, shear_area_y, shear_area_z);
}

template <class Archive>
void transfer(Archive& archive, Segment& segment) {
  auto& [section, elements, fraction] = segment;
  archive(section, elements, fraction);
}

template <class Archive>
void transfer(Archive& archive, Damping& damping) {
  auto& [mass, stiffness, modal] = damping;
  archive(mass, stiffness, modal);
}

template <class Archive>
void transfer(Archive& archive, CraigBampton& reduction) {
  auto& [modes, frequency, more_modes] = reduction;
  archive(modes, frequency, more_modes);
}

template <class Archive>
void transfer(Archive& archive, BeamPart& part) {
  auto& [body, begin, end, first_element] = part;
  archive(body, begin, end, first_element);
}

template <class Archive>
void transfer(Archive& archive, BeamBody& beam) {
  auto& [from, to, material, segments, frame, damping, reference, is_rigid, has_shear, reduction,
         frames, part] = beam;
  archive(from, to, material, segments, frame, damping, reference, is_rigid, has_shear, reduction,
          frames, part);
}

template <class Archive>
void transfer(Archive& archive, RigidBody& body) {
  auto& [at, mass, inertia] = body;
  archive(at, mass, inertia);
}

template <class Archive>
void transfer(Archive& archive, PointMass& body) {
  auto& [at, mass] = body;
  archive(at, mass);
}

/// Texts of invariants read back exactly.
void transfer(Packer& archive, InvariantsFile& file) {
  std::string text = write_invariants(file);
  archive(text);
}

void transfer(Unpacker& archive, InvariantsFile& file) {
  std::string text;
  archive(text);
  file = read_invariants_text(text, "invariants of another process");
}

template <class Archive>
void transfer(Archive& archive, ImportedVariable& variable) {
  auto& [number, quantity, in_design] = variable;
  archive(number, quantity, in_design);
}

template <class Archive>
void transfer(Archive& archive, ImportedBody& body) {
  auto& [from, to, reference, source, file, variables, is_linear] = body;
  archive(from, to, reference, source, file, variables, is_linear);
}

template <class Archive>
void transfer(Archive& archive, InitialDeflection& deflection) {
  auto& [at, direction, displacement, rate] = deflection;
  archive(at, direction, displacement, rate);
}
template <class Archive>
void transfer(Archive& archive, Body& body) {
  auto& [name, shape, velocity, angular_velocity, initial_deflections] = body;
  archive(name, shape, velocity, angular_velocity, initial_deflections);
}

// ---- joints and loads

template <class Archive>
void transfer(Archive& archive, Drive& drive) {
  auto& [motion, coordinate] = drive;
  archive(motion, coordinate);
}

template <class Archive>
void transfer(Archive& archive, Joint& joint) {
  auto& [name, type, bodies, at, axis, second_axis, to, drive] = joint;
  archive(name, type, bodies, at, axis, second_axis, to, drive);
}

template <class Archive>
void transfer(Archive& archive, JointCoordinate& coordinate) {
  auto& [joint, which] = coordinate;
  archive(joint, which);
}

template <class Archive>
void transfer(Archive& archive, PointForce& force) {
  auto& [body, at, direction, value, follows_body, over] = force;
  archive(body, at, direction, value, follows_body, over);
}

template <class Archive>
void transfer(Archive& archive, PointTorque& torque) {
  auto& [body, at, direction, value, follows_body, over] = torque;
  archive(body, at, direction, value, follows_body, over);
}

template <class Archive>
void transfer(Archive& archive, SpringDamper& spring) {
  auto& [bodies, at, stiffness, damping, free_length, resistance] = spring;
  archive(bodies, at, stiffness, damping, free_length, resistance);
}

template <class Archive>
void transfer(Archive& archive, MotorControl& control) {
  auto& [target, proportional, derivative] = control;
  archive(target, proportional, derivative);
}

template <class Archive>
void transfer(Archive& archive, JointForce& force) {
  auto& [joint, coordinate, stiffness, damping, rest, motor, control, resistance] = force;
  archive(joint, coordinate, stiffness, damping, rest, motor, control, resistance);
}

template <class Archive>
void transfer(Archive& archive, Load& load) {
  auto& [name, element] = load;
  archive(name, element);
}

template <class Archive>
void transfer(Archive& archive, Scene& scene) {
  auto& [gravity, materials, bodies, joints, loads, formulas] = scene;
  archive(gravity, materials, bodies, joints, loads, formulas);
}

// ---- settings

template <class Archive>
void transfer(Archive& archive, BeamEstimates& estimates) {
  auto& [elasticity, axial, torsional, stiffening, rotary] = estimates;
  archive(elasticity, axial, torsional, stiffening, rotary);
}

template <class Archive>
void transfer(Archive& archive, MeasuredEffect& effect) {
  auto& [is_needed, change, response] = effect;
  archive(is_needed, change, response);
}

template <class Archive>
void transfer(Archive& archive, EffectDecisions& decisions) {
  auto& [estimates, measured] = decisions;
  archive(estimates, measured);
}

template <class Archive>
void transfer_effects(Archive& archive, EffectSettings& effects) {
  auto& [spatial, stiffening, rotary, elasticity, axial, torsional, tolerance, decisions] = effects;
  archive(spatial, stiffening, rotary, elasticity, axial, torsional, tolerance, decisions);
}

void transfer(Packer& archive, EffectSettings& effects) {
  transfer_effects(archive, effects);
}

void transfer(Unpacker& archive, EffectSettings& effects) {
  transfer_effects(archive, effects);
}

template <class Archive>
void transfer(Archive& archive, Formulation& formulation) {
  auto& [constraints, baumgarte, is_projected] = formulation;
  archive(constraints, baumgarte, is_projected);
}

template <class Archive>
void transfer(Archive& archive, TimeIntegration& integration) {
  auto& [end_time, step, spectral_radius, newton_tolerance, max_newton_iterations, scheme,
         formulation, local_error, smallest_step, period, instants] = integration;
  archive(end_time, step, spectral_radius, newton_tolerance, max_newton_iterations, scheme,
          formulation, local_error, smallest_step, period, instants);
}

/// Of a struct with a base there is no list of all members: what is not named here is seen here.
struct NamedSimulationSettings : TimeIntegration {
  bool quasi_static_start, checks_resolution;
};
static_assert(sizeof(NamedSimulationSettings) == sizeof(SimulationSettings));

template <class Archive>
void transfer(Archive& archive, SimulationSettings& settings) {
  archive(static_cast<TimeIntegration&>(settings), settings.quasi_static_start,
          settings.checks_resolution);
}

template <class Archive>
void transfer(Archive& archive, InvariantDifferentiation& differentiation) {
  auto& [derivatives, step] = differentiation;
  archive(derivatives, step);
}

template <class Archive>
void transfer(Archive& archive, SensitivitySettings& settings) {
  auto& [method, difference_step, invariants, memory] = settings;
  archive(method, difference_step, invariants, memory);
}

template <class Archive>
void transfer(Archive& archive, SizeChoice& choice) {
  auto& [value, text] = choice;
  archive(value, text);
}

template <class Archive>
void transfer(Archive& archive, DesignVariable& variable) {
  auto& [name, start, lower, upper, unit, quantity, choices] = variable;
  archive(name, start, lower, upper, unit, quantity, choices);
}

template <class Archive>
void transfer(Archive& archive, ResponseSettings& response) {
  auto& [name, type, bodies, segment, station, part, criterion, section_part, at, place, chord,
         side, against, direction, along, joint, coordinate, load, mode, level, over_time, from, to,
         expression, unit, unit_scale] = response;
  archive(name, type, bodies, segment, station, part, criterion, section_part, at, place, chord,
          side, against, direction, along, joint, coordinate, load, mode, level, over_time, from,
          to, expression, unit, unit_scale);
}

template <class Archive>
void transfer(Archive& archive, Objective& objective) {
  auto& [response, aim, over_cases, weights] = objective;
  archive(response, aim, over_cases, weights);
}

template <class Archive>
void transfer(Archive& archive, ConstraintSettings& constraint) {
  auto& [name, response, linear, lower, upper, deviations, cases] = constraint;
  archive(name, response, linear, lower, upper, deviations, cases);
}

template <class Archive>
void transfer(Archive& archive, OptimizerSettings& settings) {
  auto& [backend, names_backend, tolerance, max_iterations, starts, given_starts] = settings;
  archive(backend, names_backend, tolerance, max_iterations, starts, given_starts);
}

template <class Archive>
void transfer(Archive& archive, ParetoSettings& settings) {
  auto& [constraint, from, to, points, gap, most_points, goals] = settings;
  archive(constraint, from, to, points, gap, most_points, goals);
}

template <class Archive>
void transfer(Archive& archive, AccuracySettings& settings) {
  auto& [steps, elements, target, chooses_setting, responses] = settings;
  archive(steps, elements, target, chooses_setting, responses);
}

template <class Archive>
void transfer(Archive& archive, UncertainParameter& parameter) {
  auto& [variable, deviation, interval] = parameter;
  archive(variable, deviation, interval);
}

template <class Archive>
void transfer(Archive& archive, UncertaintySettings& settings) {
  auto& [parameters, samples, seed] = settings;
  archive(parameters, samples, seed);
}

template <class Archive>
void transfer(Archive& archive, OfCase& number) {
  auto& [load_case, index] = number;
  archive(load_case, index);
}

template <class Archive>
void transfer_problem(Archive& archive, ProblemFile& problem) {
  auto& [name, description, scene, effects, simulation, sensitivity, variables, responses,
         objective, constraints, optimizer, pareto, accuracy, uncertainty, load_case, case_range,
         cases, case_responses, case_constraints, case_weights] = problem;
  archive(name, description, scene, effects, simulation, sensitivity, variables, responses,
          objective, constraints, optimizer, pareto, accuracy, uncertainty, load_case, case_range,
          cases, case_responses, case_constraints, case_weights);
}

void transfer(Packer& archive, ProblemFile& problem) {
  transfer_problem(archive, problem);
}

void transfer(Unpacker& archive, ProblemFile& problem) {
  transfer_problem(archive, problem);
}

}  // namespace pleuel
