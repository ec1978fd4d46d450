#include "core/scene/grammar/tables.hpp"

namespace pleuel {

namespace {

template <class PointLoad>
void describe_point_load(Keys& keys, PointLoad& s, std::string_view value) {
  keys.about("On a point of a body: value times a unit vector along direction.");
  keys.other("body", "name", "Not \"ground\"; a torque needs a body that can turn.");
  keys.point("at", s.at, quantities::length, "Where it acts at the start {}.");
  keys.unit_vector("direction", s.direction, "Global axes at the start; of any length.");
  keys.other("value", "load_function", value);
  keys.flag(optional_key("follows"), s.follows_body, "Whether the direction turns with the body.");
}

}  // namespace

void describe(Keys& keys, PointForce& s) {
  describe_point_load(keys, s, "[N]");
  keys.point(optional_key("to"), s.to, quantities::length,
             "The force is spread evenly from at to here, along a beam {}.");
}

void describe(Keys& keys, PointTorque& s) {
  describe_point_load(keys, s, "[N m]");
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
  keys.number("stiffness", s.stiffness, {along.stiffness, Range::positive}, "{}.");
  keys.number("rounding", s.rounding, {along.coordinate, Range::positive}, "{}.");
}

}  // namespace pleuel
