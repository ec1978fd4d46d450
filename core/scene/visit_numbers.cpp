#include "core/scene/visit_numbers.hpp"

#include "core/scene/grammar/tables.hpp"

namespace pleuel {

namespace {

class NumberVisitor : public Keys {
 public:
  explicit NumberVisitor(const NumberVisit& visit) : visit_(visit) {}

  void number(const Key&, Number& number, const Measure& measure, std::string_view) override {
    visit_(number, measure.quantity);
  }
  void fixed(const Key&, Number& number, const Measure& measure, std::string_view) override {
    visit_(number, measure.quantity);
  }
  void point(const Key&, std::array<Number, 3>& point, const Quantity& quantity,
             std::string_view) override {
    for (const Number& number : point) visit_(number, quantity);
  }
  void items(const Key&, std::string_view, std::size_t count, const ItemTable& table,
             std::string_view) override {
    for (std::size_t i = 0; i < count; ++i) table(i, *this);
  }

 private:
  const NumberVisit& visit_;
};

/// Those of the struct's table. The visitor changes nothing.
template <class Struct, class... Measures>
void keyed(const Struct& object, const NumberVisit& visit, const Measures&... measures) {
  NumberVisitor visitor(visit);
  describe(visitor, const_cast<Struct&>(object), measures...);
}

template <class Numbers>
void all(const Numbers& numbers, const Quantity& quantity, const NumberVisit& visit) {
  for (const Number& number : numbers) visit(number, quantity);
}

struct FunctionNumbers {
  const Quantity& value;
  const NumberVisit& visit;

  template <class Function>
  void operator()(const Function& function) const {
    keyed(function, visit, value);
  }
  void operator()(const FrictionLaw& law) const { keyed(law, visit, along(value)); }
  void operator()(const ClearanceLaw& law) const { keyed(law, visit, along(value)); }
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

struct ShapeNumbers {
  const NumberVisit& visit;

  void operator()(const BeamBody& beam) const {
    const auto& [from, to, material, segments, frame, damping, reference, is_rigid, has_shear,
                 reduction, held, frames, pieces, part] = beam;
    all(from, quantities::length, visit);
    all(to, quantities::length, visit);
    for (const Segment& segment : segments) visit_numbers(segment.section, visit);
    keyed(damping, visit);
  }
  void operator()(const RigidBody& body) const {
    keyed(body, visit);
    all(body.inertia, quantities::inertia, visit);
  }
  void operator()(const ImportedBody& body) const {
    keyed(body, visit);
    for (const ImportedVariable& of : body.variables) visit(of.number, of.quantity);
  }
  void operator()(const PointMass& body) const { keyed(body, visit); }
};

struct LoadNumbers {
  const NumberVisit& visit;

  void operator()(const PointLoad& load) const {
    const auto& [kind, body, at, direction, value, follows_body, over, to, whole] = load;
    all(at, quantities::length, visit);
    if (to) all(*to, quantities::length, visit);
    if (whole) {
      for (const Point& point : *whole) all(point, quantities::length, visit);
    }
    visit_numbers(value, load.is_force() ? quantities::force : quantities::torque, visit);
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

}  // namespace

void visit_numbers(const Section& section, const NumberVisit& visit) {
  keyed(section, visit);
}

void visit_numbers(const Material& material, const NumberVisit& visit) {
  keyed(material, visit);
}

void visit_numbers(const TimeFunction& function, const Quantity& value, const NumberVisit& visit) {
  std::visit(FunctionNumbers{value, visit}, function);
}

void visit_numbers(const Body& body, const NumberVisit& visit) {
  const auto& [name, shape, velocity, angular_velocity, initial_deflections] = body;
  std::visit(ShapeNumbers{visit}, shape);
  all(velocity, quantities::speed, visit);
  all(angular_velocity, quantities::angular_speed, visit);
  for (const InitialDeflection& one : initial_deflections) keyed(one, visit);
}

void visit_numbers(const Joint& joint, const NumberVisit& visit) {
  const auto& [name, type, bodies, at, axis, second_axis, to, drive] = joint;
  all(at, quantities::length, visit);
  all(to, quantities::length, visit);
  if (drive) visit_numbers(drive->motion, driven_quantity(drive->coordinate), visit);
}

void visit_numbers(const Load& load, const NumberVisit& visit) {
  std::visit(LoadNumbers{visit}, load.element);
}

void visit_numbers(const Scene& scene, const NumberVisit& visit) {
  all(scene.gravity, quantities::acceleration, visit);
  for (const Material& material : scene.materials) visit_numbers(material, visit);
  for (const Body& body : scene.bodies) visit_numbers(body, visit);
  for (const Joint& joint : scene.joints) visit_numbers(joint, visit);
  for (const Load& load : scene.loads) visit_numbers(load, visit);
}

}  // namespace pleuel
