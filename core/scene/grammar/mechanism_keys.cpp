#include <Eigen/Core>
#include <fmt/format.h>

#include "core/scene/grammar/tables.hpp"
#include "core/scene/joint_kind.hpp"

namespace pleuel {

namespace {

std::string refusal(const JointKey& key, const JointKind& kind) {
  std::vector<std::string_view> owners;
  for (const JointKind& other : joint_kinds) {
    if (key.is_of(other)) owners.push_back(other.word);
  }
  if (owners.size() == 1) return fmt::format("is for {} joints only", owners.front());
  return fmt::format("is not for a {} joint, which has no {}", kind.word, key.word);
}

/// Up to rounding.
bool are_normal(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const Eigen::Vector3d first(a.data()), second(b.data());
  return std::abs(first.stableNormalized().dot(second.stableNormalized())) <= 1e-9;
}

const char* drive_definition(const JointKind& kind) {
  const bool has_displacement = kind.has_displacement() || kind.has_length();
  if (kind.has_angle() && has_displacement) return "drive_of_one";
  return kind.has_angle() || has_displacement ? "drive" : "nothing";
}

}  // namespace

void describe(Keys& keys, Joint& s) {
  const JointKind& kind = kind_of(s.type);
  for (const JointKey& key : joint_keys) {
    if (!key.is_of(kind)) keys.refused(key.word.data(), refusal(key, kind));
  }
  keys.other("bodies", "two_bodies", "");
  keys.point("at", s.at, quantities::length,
             kind.has_length() ? "The point of the first body at the start {}."
                               : "Where the joint is at the start {}.");
  if (kind.has_length()) {
    keys.point("to", s.to, quantities::length, "The point of the second body {}.");
  }
  // A direction of sliding has no sensible default; the axis of rotation of a planar mechanism has.
  if (kind.only_turns_about_axis()) {
    keys.direction(optional_key("axis"), s.axis, "Of rotation; default z.");
  } else if (kind.has_axis()) {
    keys.direction("axis", s.axis,
                   kind.has_second_axis()    ? "Fixed in the first body."
                   : kind.has_displacement() ? "Of sliding."
                                             : "Normal of the plane.");
  }
  if (kind.has_second_axis()) {
    keys.direction("second_axis", s.second_axis, "Fixed in the second body, normal to \"axis\".");
    keys.must("second_axis", are_normal(s.axis, s.second_axis), "must be normal to \"axis\"",
              Shown::rule_and_value);
  }
  keys.other(optional_key("drive"), drive_definition(kind), "");
}

void describe(Keys& keys, PointLoad& s) {
  keys.about("On a point of a body: value times a unit vector along direction.");
  keys.other("body", "name", "Not \"ground\"; a torque needs a body that can turn.");
  keys.point("at", s.at, quantities::length, "Where it acts at the start {}.");
  keys.unit_vector("direction", s.direction, "Global axes at the start; of any length.");
  keys.other("value", "load_function", s.is_force() ? "[N]" : "[N m]");
  keys.flag(optional_key("follows"), s.follows_body, "Whether the direction turns with the body.");
  if (!s.is_force()) return;
  keys.point(optional_key("to"), s.to, quantities::length,
             "The force is spread evenly from at to here, along a beam {}.");
}

void describe(Keys& keys, SpringDamper& s) {
  keys.about("Between two points: force k (l - l0) + c dl/dt + resistance along their connection.");
  keys.other("bodies", "two_bodies", "");
  keys.other("at", "two_points", "");
  keys.one_at_least({"stiffness", "resistance"});
  keys.number(optional_key("stiffness"), s.stiffness,
              {quantities::spring_stiffness, Range::not_negative},
              "k {}; needed where there is no resistance.");
  keys.other(optional_key("resistance"), "resistance",
             "[N], over elongation (length less free length) and speed.");
  keys.number(optional_key("damping"), s.damping,
              {quantities::damping_constant, Range::not_negative}, "c {}.");
  keys.number(optional_key("free_length"), s.free_length, {quantities::length, Range::not_negative},
              "l0 {}; by default the distance at the start.");
}

void describe(Keys& keys, JointForce& s, const AlongCoordinate& along) {
  keys.about(
      "In a joint, on its coordinate s: -k (s - s0) - c ds/dt - resistance(s - s0, ds/dt) + motor "
      "on the second body, the opposite on the first.");
  keys.other("joint", "name",
             "Name of a joint: revolute, universal, planar (s is an angle), prismatic, "
             "point-on-line (a displacement) or cylindrical.");
  keys.other(optional_key("coordinate"), "coordinate", "");
  keys.one_at_least({"stiffness", "damping", "resistance", "motor"});
  keys.number(optional_key("stiffness"), s.stiffness, {along.stiffness, Range::not_negative},
              "k {}.");
  keys.number(optional_key("damping"), s.damping, {along.damping, Range::not_negative}, "c {}.");
  keys.needs_one("rest", {"stiffness", "resistance"},
                 "is the rest position of a spring, and needs \"stiffness\" or \"resistance\"");
  keys.number(optional_key("rest"), s.rest, {along.coordinate},
              "s0 {}, against the position at the start.");
  keys.other(optional_key("resistance"), "resistance",
             "[N m] or [N], over s - s0 (angle or displacement) and speed.");
  keys.other(optional_key("motor"), "load_function",
             "[N m] or [N]; not on a coordinate that is driven. A formula or a table of angle "
             "(displacement) and speed, or the type control, too.");
}

void describe(Keys& keys, MotorControl& s, const AlongCoordinate& along) {
  keys.about(
      "A motor that follows a motion: proportional (target - s) + derivative (d target/dt - "
      "ds/dt).");
  keys.other("target", "drive", "[rad] or [m], without the key coordinate.");
  keys.number("proportional", s.proportional, {along.stiffness, Range::not_negative}, "{}.");
  keys.number(optional_key("derivative"), s.derivative, {along.damping, Range::not_negative},
              "{}.");
}

void describe(Keys& keys, FrictionLaw& s, const AlongCoordinate& along) {
  keys.about("value * tanh(rate/speed): dry friction without its jump.");
  keys.number("value", s.value, {along.force, Range::not_negative}, "{}.");
  keys.number("speed", s.speed, {along.rate, Range::positive},
              "At which three quarters of the value act {}.");
}

void describe(Keys& keys, ClearanceLaw& s, const AlongCoordinate& along) {
  keys.about(
      "No force between lower and upper; outside a spring, whose stiffness rises to its value "
      "within the rounding.");
  keys.one_at_least({"lower", "upper"});
  keys.number(optional_key("lower"), s.lower, {along.coordinate}, "{}; default: no stop there.");
  keys.number(optional_key("upper"), s.upper, {along.coordinate}, "{}; default: no stop there.");
  const bool is_bound = s.lower.is_bound() || s.upper.is_bound();
  keys.must("upper", is_bound || s.lower.constant <= s.upper.constant,
            "must not be less than \"lower\"", Shown::rule_and_value);
  keys.number("stiffness", s.stiffness, {along.stiffness, Range::positive}, "{}.");
  keys.number("rounding", s.rounding, {along.coordinate, Range::positive}, "{}.");
}

namespace {

constexpr Measure instant = {quantities::time};
constexpr Measure duration = {quantities::time, Range::positive};

}  // namespace

void describe(Keys& keys, ConstantFunction& s, const Quantity& value) {
  keys.about("The same value at all times.");
  keys.number("value", s.value, {value}, "");
}

void describe(Keys& keys, ConstantSpeedDrive& s, const Quantity& value) {
  keys.number("speed", s.speed, {per_time(value)}, "{}");
}

void describe(Keys& keys, RampToSpeedDrive& s, const Quantity& value) {
  keys.number("speed", s.speed, {per_time(value)}, "Speed W after the ramp {}.");
  keys.number("ramp", s.ramp, duration,
              "Duration T of the smooth ramp {}: the acceleration is (W/T)(1 - cos(2 pi t/T)).");
}

void describe(Keys& keys, HarmonicFunction& s, const Quantity& value) {
  keys.about("offset + amplitude * sin(frequency * t + phase)");
  keys.number("amplitude", s.amplitude, {value}, "");
  keys.number("frequency", s.frequency, {quantities::angular_frequency, Range::positive},
              "{}: a plain number is in rad/s; \"40 Hz\" is 40 cycles a second.");
  keys.number(optional_key("phase"), s.phase, {quantities::angle}, "{}.");
  keys.number(optional_key("offset"), s.offset, {value}, "");
}

void describe(Keys& keys, RampFunction& s, const Quantity& value) {
  keys.about("A straight line between two values; with rounding twice differentiable.");
  keys.number(optional_key("from"), s.from, {value}, "");
  keys.number("to", s.to, {value}, "");
  keys.fixed(optional_key("begin"), s.begin, instant, "{}.");
  keys.fixed("end", s.end, instant, "{}.");
  keys.must("end", s.end > s.begin, "must be later than \"begin\"", Shown::rule_and_value);
}

void describe(Keys& keys, HalfSineFunction& s, const Quantity& value) {
  keys.about("offset + amplitude * sin(pi (t - begin)/duration) while it lasts, else offset.");
  keys.number("amplitude", s.amplitude, {value}, "");
  keys.number(optional_key("offset"), s.offset, {value}, "");
  keys.fixed(optional_key("begin"), s.begin, instant, "{}.");
  keys.fixed("duration", s.duration, duration, "{}.");
  describe_period(keys, s.period, s.duration);
}

void describe_period(Keys& keys, double& period, double least) {
  keys.fixed(optional_key("period"), period, duration,
             "After which it is repeated [s], at least the duration; default: once.");
  keys.must("period", period >= least * (1.0 - 1e-9),
            fmt::format("must be at least as long as what is repeated, {:g} s", least),
            Shown::rule_and_value);
}

namespace {

constexpr Measure size = {quantities::length, Range::positive};

}  // namespace

const std::vector<ObjectKind<Section>>& section_kinds() {
  static const std::vector<ObjectKind<Section>> kinds = {
      {"rectangle", RectangleSection()}, {"circle", CircleSection()}, {"tube", TubeSection()},
      {"ellipse", EllipseSection()},     {"box", BoxSection()},       {"i", ISection()},
      {"general", GeneralSection()}};
  return kinds;
}

void describe(Keys& keys, Section& section) {
  std::visit([&](auto& kind) { describe(keys, kind); }, section);
}

void describe(Keys& keys, RectangleSection& s) {
  keys.number("width", s.width, size, "Along local z {}; out of the plane of a planar mechanism.");
  keys.number("height", s.height, size, "Along local y {}; in the plane of a planar mechanism.");
}

void describe(Keys& keys, CircleSection& s) {
  keys.number("diameter", s.diameter, size, "{}");
}

void describe(Keys& keys, TubeSection& s) {
  keys.number("outer_diameter", s.outer_diameter, size, "{}");
  keys.number("thickness", s.thickness, size, "Of the wall {}, at most the radius.");
}

void describe(Keys& keys, EllipseSection& s) {
  keys.number("width", s.width, size, "Full axis along local z {}.");
  keys.number("height", s.height, size, "Full axis along local y {}.");
}

void describe(Keys& keys, BoxSection& s) {
  keys.about("Rectangular tube.");
  keys.number("width", s.width, size, "Outer, along local z {}.");
  keys.number("height", s.height, size, "Outer, along local y {}.");
  keys.number("thickness", s.thickness, size, "Of the walls {}, at most half the shorter side.");
}

void describe(Keys& keys, ISection& s) {
  keys.about("Web along local y, flanges along local z. Warping is not modelled.");
  keys.number("width", s.width, size, "Of the flanges {}.");
  keys.number("height", s.height, size, "Over both flanges {}.");
  keys.number("flange_thickness", s.flange_thickness, size, "{}, at most half the height.");
  keys.number("web_thickness", s.web_thickness, size,
              "{}, at most the width and three times the flange thickness.");
}

void describe(Keys& keys, GeneralSection& s) {
  constexpr Measure area = {quantities::area, Range::positive};
  constexpr Measure inertia = {quantities::second_moment_of_area, Range::positive};
  keys.about("Any section, by its numbers; y and z are its principal axes.");
  keys.number("area", s.area, area, "{}");
  keys.number("inertia_y", s.inertia_y, inertia, "Integral of z^2 {}: bending along local z.");
  keys.number("inertia_z", s.inertia_z, inertia, "Integral of y^2 {}: bending along local y.");
  keys.number("torsion", s.torsion, inertia, "Torsion constant {}.");
  keys.number(optional_key("shear_area_y"), s.shear_area_y, area,
              "Area that carries a shear force along local y {}: the area times the shear "
              "coefficient. For beams with shear.");
  keys.number(optional_key("shear_area_z"), s.shear_area_z, area,
              "Of a shear force along local z {}.");
  keys.together("shear_area_y", "shear_area_z");
  keys.list("points", "point", s.points, "Where stress is evaluated.");
}

void describe(Keys& keys, GeneralStressPoint& s) {
  keys.fixed("y", s.y, {quantities::length}, "{}");
  keys.fixed("z", s.z, {quantities::length}, "{}");
  keys.fixed("shear", s.shear, {quantities::torsional_shear, Range::not_negative},
             "Torsional shear stress per torque {}.");
}

}  // namespace pleuel
