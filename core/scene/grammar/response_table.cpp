#include "core/scene/grammar/response_table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/magnitude_direction.hpp"
#include "core/scene/names_of.hpp"
#include "core/scene/response_kind.hpp"
#include "core/scene/response_names.hpp"

/// A function for each kind of response.
namespace pleuel::response_tables {

namespace {

using R = ResponseSettings;
using Scope = ResponseScope;

constexpr Choice<int> axes[] = {{"x", 0}, {"y", 1}, {"z", 2}};
constexpr Choice<int> axes_or_magnitude[] = {
    {"x", 0}, {"y", 1}, {"z", 2}, {"magnitude", magnitude_direction}};
constexpr Choice<int> frame_axes[] = {{"y", 1}, {"z", 2}, {"x", 0}, {"resultant", -1}};
constexpr Choice<int> chord_axes[] = {{"y", 1}, {"z", 2}, {"resultant", -1}};
constexpr Choice<StressPart> stress_parts[] = {
    {"von-mises", StressPart::von_mises}, {"normal", StressPart::normal},
    {"axial", StressPart::axial},         {"bending", StressPart::bending},
    {"shear", StressPart::shear},         {"utilization", StressPart::utilization}};
constexpr Choice<StressPart> imported_stress_parts[] = {{"von-mises", StressPart::von_mises},
                                                        {"normal", StressPart::normal},
                                                        {"utilization", StressPart::utilization}};
constexpr Choice<SectionForcePart> section_parts[] = {
    {"axial", SectionForcePart::axial},       {"moment-y", SectionForcePart::moment_y},
    {"moment-z", SectionForcePart::moment_z}, {"torque", SectionForcePart::torque},
    {"shear-y", SectionForcePart::shear_y},   {"shear-z", SectionForcePart::shear_z}};
constexpr Choice<SectionSide> sides[] = {{"before", SectionSide::before},
                                         {"behind", SectionSide::behind}};
constexpr Choice<DeflectionReference> references[] = {
    {"frame", DeflectionReference::frame},
    {"chord", DeflectionReference::chord},
    {"rigid-mechanism", DeflectionReference::rigid_mechanism}};
constexpr Choice<DriftLevel> levels[] = {{"position", DriftLevel::position},
                                         {"velocity", DriftLevel::velocity}};
constexpr WholeRange mode_numbers = {1, 1000};
constexpr int most_segments = 10000;

// Time.

void window(Keys& keys, R& r, const Scope& scope) {
  const double end = scope.end_time;
  keys.fixed(optional_key("from"), r.from, {quantities::time, Range::not_negative},
             "Start of the window of time {}, before the end of the simulation; default 0.");
  keys.must("from", r.from.value_or(0.0) < end,
            fmt::format("must be before the end of the simulation, {:g} [s]", end),
            Shown::rule_and_value);
  keys.fixed(optional_key("to"), r.to, {quantities::time, Range::positive},
             "End of the window of time {}, after its start; by default the end of the "
             "simulation.");
  keys.must("to", r.to.value_or(end) <= end,
            fmt::format("must not be after the end of the simulation, {:g} [s]", end),
            Shown::rule_and_value);
  keys.must("to", r.to.value_or(end) > r.from.value_or(0.0), "must be later than \"from\"",
            Shown::rule_and_value);
}

void history(Keys& keys, R& r, const Scope& scope) {
  keys.choice("over_time", r.over_time, over_time_kinds, "How the history becomes one number.");
  window(keys, r, scope);
}

// Bodies. Null where the table is not read: there are no bodies then.

const Body* body(Keys& keys, const Key& key, R& r, const Scope& scope,
                 std::string_view sentence = "") {
  std::string name;
  keys.name(key, "body", names_of(scope.scene.bodies), name, sentence);
  if (!name.empty()) r.bodies = {name};
  return find_named(scope.scene.bodies, name);
}

template <class Shape>
const Shape* shape_of(const Body* body) {
  return body == nullptr ? nullptr : std::get_if<Shape>(&body->shape);
}

const BeamBody* elastic_beam(Keys& keys, const Body* body) {
  const auto* beam = shape_of<BeamBody>(body);
  if (body == nullptr) return nullptr;
  keys.must("body", beam != nullptr,
            fmt::format("must name a beam, but \"{}\" is none", body->name));
  keys.must("body", beam == nullptr || !beam->is_rigid,
            fmt::format("must name an elastic beam, but \"{}\" is rigid", body->name));
  return beam;
}

const BeamBody* elastic_beam(Keys& keys, const Key& key, R& r, const Scope& scope) {
  return elastic_beam(keys, body(keys, key, r, scope, "An elastic beam."));
}

/// The beams that a stress is the largest of: of one body a segment, a place or all of it, or all of
/// several bodies.
std::vector<const BeamBody*> beams(Keys& keys, const Body* one, R& r, const Scope& scope) {
  std::vector<const BeamBody*> found;
  const BeamBody* beam = elastic_beam(keys, one);
  if (beam != nullptr) found.push_back(beam);
  std::vector<std::string> several;
  if (r.type != ResponseType::fatigue_damage) {
    keys.names(optional_key("bodies"), "body", names_of(scope.scene.bodies), several,
               "Elastic beams: the largest of all.");
  }
  for (std::size_t i = 0; i < several.size(); ++i) {
    const auto* other = shape_of<BeamBody>(find_named(scope.scene.bodies, several[i]));
    keys.must_item("bodies", i, other != nullptr && !other->is_rigid,
                   fmt::format("must name an elastic beam, but \"{}\" is none", several[i]));
    found.push_back(other);
  }
  if (!several.empty()) r.bodies = several;
  for (const char* word : {"segment", "at"}) {
    keys.must(word, several.empty(), "is for one \"body\", not for several");
  }
  keys.exclusive("segment", "at");
  const int segments = beam == nullptr ? most_segments : int_size(beam->segments);
  keys.whole(optional_key("segment"), r.segment, {0, segments - 1},
             "Counted from 0; by default the whole beam.");
  keys.place(optional_key("at"), r.station,
             "Only at this place along the beam, from 0 to 1; not with segment.");
  return found;
}

void body_or_bodies(Keys& keys) {
  keys.exclusive("body", "bodies");
  keys.one_at_least({"body", "bodies"});
}

/// A component, or the component along a vector.
template <std::size_t count>
void component(Keys& keys, R& r, const Choice<int> (&choices)[count], std::string_view sentence) {
  keys.choice_or_vector("direction", r.direction, choices, r.along, sentence);
  if (r.along) r.direction = magnitude_direction;
}

/// A magnitude is no linear function of what changes: its rate is another number.
void component_of_rate(Keys& keys, R& r, std::string_view sentence) {
  keys.refused_choice("direction", "magnitude",
                      fmt::format("must be \"x\", \"y\", \"z\" or a vector, as the magnitude of "
                                  "the {} is no rate of that of the {}",
                                  kind_of(r.type).word, kind_of(observed_type(r.type)).word));
  component(keys, r, axes, sentence);
}

/// The axis that a mode has to be along.
void mode_axis(Keys& keys, R& r, std::string_view sentence) {
  int axis = -1;
  keys.choice_or_vector(optional_key("direction"), axis, axes, r.mode.axis, sentence);
  if (axis < 0) return;
  r.mode.axis.emplace();
  (*r.mode.axis)[axis] = 1.0;
}

/// A place along a beam, or one of an imported body by its name.
void place(Keys& keys, const Body* body, R& r, std::string_view sentence = "") {
  const auto* imported = shape_of<ImportedBody>(body);
  if (imported != nullptr) {
    keys.name("at", "place", names_of(imported->file->constants.places), r.place, sentence);
  } else if (shape_of<BeamBody>(body) != nullptr) {
    keys.place("at", r.at, sentence);
  } else {
    keys.other("at", "named_place", sentence);
  }
}

// Of beams.

/// What the points of stress of a file are good for: they know nothing of sections.
void imported_stress(Keys& keys, const ImportedBody& body, R& r) {
  const std::optional<StressRecovery>& stress = body.file->constants.stress;
  keys.must("body", stress.has_value(),
            fmt::format("names a body whose file {} has no block \"stress\"", body.source));
  for (const char* word : {"bodies", "segment", "at"}) {
    keys.refused(word, "is for beams only; the points of stress of a file are one set");
  }
  keys.choice(optional_key("part"), r.part, imported_stress_parts, "");
  keys.must("part", r.part != StressPart::utilization || (stress && stress->strength != 0.0),
            fmt::format("needs a strength, which the file {} does not give", body.source));
}

void stress(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Stress [Pa], the largest over a beam, over one of its segments or at a place; utilization "
      "is "
      "a number without unit.");
  body_or_bodies(keys);
  const Body* one = body(keys, optional_key("body"), r, scope, "An elastic beam.");
  if (const auto* imported = shape_of<ImportedBody>(one)) {
    imported_stress(keys, *imported, r);
  } else {
    const std::vector<const BeamBody*> all = beams(keys, one, r, scope);
    keys.choice(optional_key("part"), r.part, stress_parts,
                "normal: signed, axial and bending; axial: normal force over area; bending: "
                "without it; shear: of torsion; utilization: von Mises stress over the strength of "
                "the material.");
    for (const BeamBody* beam : all) {
      const Material* material = find_named(scope.scene.materials, beam->material);
      const bool has_strength = material != nullptr && material->strength.has_value();
      keys.must(
          "part", r.part != StressPart::utilization || has_strength,
          fmt::format("needs the strength of the material \"{}\", which has none", beam->material));
    }
  }
  history(keys, r, scope);
}

bool has_general_section(const BeamBody& beam) {
  return std::any_of(beam.segments.begin(), beam.segments.end(), [](const Segment& segment) {
    return std::holds_alternative<GeneralSection>(segment.section);
  });
}

void shear_stress(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Shear stress [Pa] of shear forces and torsion, the largest over a beam, over one of its "
      "segments or at a place. The sections are not of the type general.");
  body_or_bodies(keys);
  const Body* one = body(keys, optional_key("body"), r, scope, "An elastic beam.");
  const std::vector<const BeamBody*> all = beams(keys, one, r, scope);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_known = !has_general_section(*all[i]);
    const char* rule =
        "names a beam with a general section, whose properties do not tell where shear forces act "
        "in it; \"section-force\" gives the forces";
    keys.must("body", is_known, rule);
    if (one == nullptr) keys.must_item("bodies", i, is_known, rule);
  }
  history(keys, r, scope);
}

/// What a criterion needs of a material, and what the endurance or the damage does.
void fatigue_data(Keys& keys, const R& r, const Material& material) {
  const auto need = [&](bool is_asked, const auto& number, const char* word) {
    keys.must("criterion", !is_asked || number,
              fmt::format("needs the \"{}\" of the material \"{}\", which has none: give it in "
                          "/scene/materials",
                          word, material.name));
  };
  const bool is_damage = r.type == ResponseType::fatigue_damage;
  const bool is_soderberg = r.criterion == FatigueCriterion::soderberg;
  need(!is_damage, material.endurance_limit, "endurance_limit");
  need(is_damage, material.fatigue_strength, "fatigue_strength");
  need(is_damage, material.fatigue_exponent, "fatigue_exponent");
  need(is_soderberg, material.strength, "strength");
  need(!is_soderberg, material.ultimate_strength, "ultimate_strength");
}

void fatigue(Keys& keys, R& r, const Scope& scope) {
  const bool is_damage = r.type == ResponseType::fatigue_damage;
  keys.about(is_damage
                 ? "Damage by all cycles of normal stress of a point in the simulation or a window "
                   "of it, by rainflow counting, Basquin's line and the sum of Palmgren and Miner: "
                   "the largest of all points of one beam."
                 : "Utilization of the material by the cycle between the largest and the smallest "
                   "normal stress of a point, in the simulation or a window of it: the largest of "
                   "all points. Its inverse is the factor of safety on the load.");
  keys.refused(
      "over_time",
      "is not for a fatigue, which looks at the largest and the smallest stress of cycles");
  if (is_damage) {
    keys.refused("bodies", "is not for a fatigue-damage: give one \"body\"");
  } else {
    body_or_bodies(keys);
  }
  keys.choice("criterion", r.criterion, fatigue_criteria,
              "How much mean stress a cycle bears beside its amplitude: a straight line to the "
              "ultimate strength (goodman) or to the strength (soderberg), or a parabola to the "
              "ultimate strength (gerber). Compression as a mean neither harms nor helps.");
  r.over_time = OverTime::final;
  const Key key = is_damage ? Key("body") : optional_key("body");
  const Body* one = body(keys, key, r, scope, "An elastic beam.");
  for (const BeamBody* beam : beams(keys, one, r, scope)) {
    const Material* material = find_named(scope.scene.materials, beam->material);
    if (material != nullptr) fatigue_data(keys, r, *material);
  }
  window(keys, r, scope);
}

void section_force(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Section force [N, N m] of a beam, local axes: axial (positive: tension), moment-z (bends it "
      "in the plane of its local x and y), moment-y, torque, shear-y, shear-z (across it).");
  elastic_beam(keys, "body", r, scope);
  double at = 0.0;
  keys.place("at", at, "");
  r.station = at;
  keys.choice("part", r.section_part, section_parts, "");
  keys.choice(optional_key("side"), r.side, sides,
              "Where a joint or load acts at the place: only that side of it. Default: "
              "both.");
  history(keys, r, scope);
}

void buckling(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      r.type == ResponseType::buckling
          ? "Compressive force of a beam over the Euler load of the same beam pinned at both "
            "ends."
          : "Section forces of a beam, which its joints hold sideways, over those at which it "
            "buckles out of the plane in which it bends, sideways as a column, by twisting "
            "under its bending moment, or both; 0 where nothing buckles.");
  elastic_beam(keys, "body", r, scope);
  history(keys, r, scope);
}

/// The places at both ends of a chord of an imported body.
void chord(Keys& keys, const ImportedBody* imported, R& r) {
  if (imported == nullptr || r.against != DeflectionReference::chord) {
    keys.must("chord", false,
              "is for imported bodies with \"against\": \"chord\"; that of a beam is through its "
              "ends");
    keys.other(optional_key("chord"), "two_places",
               "Of an imported body: the places at both ends of its chord.");
    return;
  }
  const std::vector<BodyPlace>& places = imported->file->constants.places;
  std::array<std::string, 2> ends;
  keys.two_names("chord", "place", names_of(places), ends, "");
  const auto *first = find_named(places, ends[0]), *second = find_named(places, ends[1]);
  const bool is_apart =
      first == nullptr || second == nullptr || (second->position - first->position).norm() > 0.0;
  keys.must("chord", is_apart, "must name two places that are apart from each other");
  r.chord = ends;
}

void deflection(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Deflection [m] of a point of a beam against its frame or chord; or displacement of a place, "
      "global axes, against the same place in the same mechanism without elasticity.");
  const Body* one = body(keys, "body", r, scope, "An elastic beam.");
  const auto* imported = shape_of<ImportedBody>(one);
  if (imported == nullptr) elastic_beam(keys, one);
  place(keys, one, r);
  keys.choice(optional_key("against"), r.against, references,
              "The body frame, the straight line through both ends, or the same mechanism without "
              "elasticity.");
  chord(keys, imported, r);
  if (r.against == DeflectionReference::rigid_mechanism) {
    keys.choice("direction", r.direction, axes, "");
  } else if (r.against == DeflectionReference::chord) {
    keys.choice(optional_key("direction"), r.direction, chord_axes, "");
  } else {
    keys.choice(optional_key("direction"), r.direction, frame_axes,
                "Local y or z, their resultant, or x along the beam (against the frame); against "
                "the rigid mechanism one of the global axes.");
  }
  history(keys, r, scope);
}

// Of points and frames.

void motion(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Of a point of a body: a coordinate of its position [m], its velocity [m/s], acceleration "
      "[m/s^2] or jerk [m/s^3], the rate of the acceleration.");
  const Body* one = body(keys, "body", r, scope);
  const bool has_places = one == nullptr || shape_of<BeamBody>(one) != nullptr ||
                          shape_of<ImportedBody>(one) != nullptr;
  const char* sentence = "For beams, from 0 to 1, and for imported bodies, a name; only for them.";
  if (one == nullptr) {
    keys.other(optional_key("at"), "named_place", sentence);
  } else if (has_places) {
    place(keys, one, r, sentence);
  } else {
    keys.refused("at", fmt::format("is for beams only, but \"{}\" is none", one->name));
  }
  const char* direction = "Global axis, or the component along a vector (of any length).";
  if (r.type == ResponseType::jerk) {
    component_of_rate(keys, r, direction);
  } else if (r.type == ResponseType::position) {
    component(keys, r, axes, direction);
  } else {
    component(keys, r, axes_or_magnitude,
              "Global axis, the length of the vector, or its component along a vector (of any "
              "length).");
  }
  history(keys, r, scope);
}

void turning(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Of a body frame, global axes: its angle [rad] about an axis, angular velocity [rad/s], "
      "angular acceleration [rad/s^2] or angular jerk [rad/s^3], the rate of the acceleration.");
  const Body* one = body(keys, "body", r, scope);
  if (one != nullptr) {
    keys.must("body", shape_of<PointMass>(one) == nullptr,
              fmt::format("must name a body that can turn, but \"{}\" is a point mass", one->name));
  }
  if (r.type == ResponseType::angle) {
    keys.choice("direction", r.direction, axes, "");
  } else if (r.type == ResponseType::angular_jerk) {
    component_of_rate(keys, r, "");
  } else {
    component(keys, r, axes_or_magnitude, "");
  }
  history(keys, r, scope);
}

/// The axis of a joint with the ground that a body slides or turns in.
void guide_axis(Keys& keys, const std::string& name, R& r, const Scope& scope) {
  const Joint* joint = find_named(scope.scene.joints, name);
  if (joint == nullptr) return;
  const bool is_guide = kind_of(joint->type).has_axis() && joint->bodies[0] == ground_name;
  keys.must("joint", is_guide,
            fmt::format("must name a joint with an axis and \"ground\" as its first body, but "
                        "\"{}\" is none",
                        name));
  const auto& [x, y, z] = joint->axis;
  const double length = std::hypot(x, y, z);
  r.along = {x / length, y / length, z / length};
}

void transmission_angle(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "The acute angle [rad] at which one member pushes another, between the x axes of their "
      "frames, or between a member and the normal of a guide; 0 is a dead centre.");
  keys.exclusive("bodies", "body");
  keys.exclusive("bodies", "joint");
  keys.one_at_least({"bodies", "joint"});
  keys.together("body", "joint");
  const auto turns = [&](const std::string& name) {
    return shape_of<PointMass>(find_named(scope.scene.bodies, name)) == nullptr;
  };
  const char* rule = "must not be a point mass, which does not turn";
  std::array<std::string, 2> both;
  keys.two_names(optional_key("bodies"), "body", names_of(scope.scene.bodies), both, "");
  for (std::size_t i = 0; i < 2; ++i) keys.must_item("bodies", i, turns(both[i]), rule);
  if (!both[0].empty()) r.bodies = {both[0], both[1]};
  if (const Body* one = body(keys, optional_key("body"), r, scope)) {
    keys.must("body", turns(one->name), rule);
  }
  std::string joint;
  keys.name(optional_key("joint"), "joint", names_of(scope.scene.joints), joint,
            "A joint with an axis, and the ground as its first body.");
  guide_axis(keys, joint, r, scope);
  history(keys, r, scope);
}

// Of joints and loads.

void drive_effort(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Torque [N m] (of the drive of an angle) or force [N] (of a displacement) that the drive of "
      "a "
      "joint exerts on its second body, or its power [W]; an integral of the power is an energy "
      "[J].");
  keys.name("joint", "joint", names_of(scope.scene.joints), r.joint, "A joint with a drive.");
  if (const Joint* joint = find_named(scope.scene.joints, r.joint)) {
    keys.must("joint", joint->drive.has_value(),
              fmt::format("names the joint \"{}\", which has no drive", joint->name));
    const bool is_angle = joint->drive && joint->drive->coordinate == DrivenCoordinate::angle;
    keys.must("joint", r.type != ResponseType::drive_torque || is_angle,
              fmt::format("names the joint \"{}\", whose drive has a drive-force", joint->name));
    keys.must("joint", r.type != ResponseType::drive_force || !is_angle,
              fmt::format("names the joint \"{}\", whose drive has a drive-torque", joint->name));
  }
  history(keys, r, scope);
}

void joint_motion(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Of the second body of a joint against the first: angle [rad] or displacement [m] from that "
      "at the start, its rate [rad/s] or [m/s], or the rate of that [rad/s^2] or [m/s^2].");
  keys.name("joint", "joint", names_of(scope.scene.joints), r.joint, "");
  keys.other(optional_key("coordinate"), "coordinate", "");
  history(keys, r, scope);
}

void reaction(Keys& keys, R& r, const Scope& scope) {
  keys.about("Force [N] or moment [N m] that a joint transmits.");
  keys.name("joint", "joint", names_of(scope.scene.joints), r.joint, "");
  keys.choice("direction", r.direction, axes_or_magnitude,
              "Global axis, or the length of the vector.");
  history(keys, r, scope);
}

/// Names a load. @returns null if there is none
const Load* load(Keys& keys, R& r, const Scope& scope) {
  keys.name("load", "load", names_of(scope.scene.loads), r.load, "");
  return find_named(scope.scene.loads, r.load);
}

void spring_state(Keys& keys, R& r, const Scope& scope) {
  keys.about(r.type == ResponseType::spring_length
                 ? "Length [m] of a load of the type spring."
                 : "What a load of the type spring pulls with [N], with its damper.");
  if (const Load* one = load(keys, r, scope)) {
    keys.must(
        "load", std::holds_alternative<SpringDamper>(one->element),
        fmt::format("must name a load of the type \"spring\", but \"{}\" is none", one->name));
  }
  history(keys, r, scope);
}

void motor_power(Keys& keys, R& r, const Scope& scope) {
  keys.about("What the motor of a load in a joint supplies [W].");
  if (const Load* one = load(keys, r, scope)) {
    const auto* force = std::get_if<JointForce>(&one->element);
    keys.must(
        "load", force != nullptr && (force->motor || force->control),
        fmt::format("must name a load with a motor in a joint, but \"{}\" has none", one->name));
  }
  history(keys, r, scope);
}

template <class Element>
bool is_damper(const Load& load) {
  const auto* element = std::get_if<Element>(&load.element);
  if (element == nullptr) return false;
  const Number& damping = element->damping;
  return element->resistance || damping.is_bound() || damping.constant != 0.0;
}

void damper_power(Keys& keys, R& r, const Scope& scope) {
  keys.about("What the damper of a load takes [W]: damping, and resistance to a rate, times rate.");
  if (const Load* one = load(keys, r, scope)) {
    keys.must(
        "load", is_damper<SpringDamper>(*one) || is_damper<JointForce>(*one),
        fmt::format("must name a load with \"damping\" or \"resistance\", but \"{}\" has none",
                    one->name));
  }
  history(keys, r, scope);
}

// Of the mechanism.

void mass(Keys& keys, R& r, const Scope& scope) {
  keys.about("Mass [kg] of the bodies named, or of all.");
  keys.refused("over_time", "is not for a mass, which does not change in time");
  keys.exclusive("body", "bodies");
  body(keys, optional_key("body"), r, scope);
  keys.names(optional_key("bodies"), "body", names_of(scope.scene.bodies), r.bodies, "");
}

void frequency(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Natural frequency [rad/s], in space whatever the motion has: of an elastic beam in its "
      "frame, or without a body of the whole mechanism at its initial configuration; a mode that "
      "grows as exp(g t) is -g.");
  keys.refused("over_time", "is not for a frequency, which does not change in time");
  const Body* one = body(keys, optional_key("body"), r, scope, "An elastic beam.");
  if (shape_of<ImportedBody>(one) == nullptr) elastic_beam(keys, one);
  int mode = r.mode.number + 1;
  keys.whole(optional_key("mode"), mode, mode_numbers, "Counted from 1, the lowest.");
  r.mode.number = mode - 1;
  mode_axis(keys, r,
            "Only modes that are motion along this axis, or this vector, count: more than half of "
            "their kinetic energy. Of a body in its own axes, else in global ones.");
}

void damped_mode(Keys& keys, R& r, const Scope&) {
  const bool is_ratio = r.type == ResponseType::damping_ratio;
  keys.about(
      "Of small vibrations of the whole mechanism about its initial configuration, exp(s t): "
      "damping-ratio is -Re s/|s|, growth-rate is Re s [1/s]. Of the mode that is damped least, or "
      "grows fastest.");
  keys.refused("over_time", "is not for a number of a mode, which does not change in time");
  std::optional<int> mode;
  if (is_ratio) {
    keys.whole(optional_key("mode"), mode, mode_numbers,
               "That of this vibration, counted from 1, the slowest.");
  }
  r.mode.of = is_ratio ? ModeNumber::damping_ratio : ModeNumber::growth_rate;
  r.mode.number = mode ? *mode - 1 : ModeChoice::worst;
  mode_axis(keys, r,
            "Only modes that are motion along this global axis, or this vector, count: more than "
            "half of their kinetic energy.");
}

void energy(Keys& keys, R& r, const Scope& scope) {
  keys.about("Energy [J] of one body or, by default, of all.");
  const Body* one =
      body(keys, optional_key("body"), r, scope, "For an elastic energy an elastic beam.");
  const bool is_elastic = r.type == ResponseType::elastic_energy;
  if (is_elastic && shape_of<ImportedBody>(one) == nullptr) elastic_beam(keys, one);
  history(keys, r, scope);
}

void energy_balance(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "What is missing in the balance of energy and work [J] between the ends of the simulation or "
      "of the window: an error of the time integration.");
  keys.refused("over_time", "is not for an energy-balance, which compares two times");
  r.over_time = OverTime::final;
  window(keys, r, scope);
}

void drift(Keys& keys, R& r, const Scope& scope) {
  keys.about(
      "Error of the equations of joints and drives [m, rad or a cosine], or of their rates; "
      "max-abs "
      "is that of the worst equation.");
  keys.choice(optional_key("level"), r.level, levels, "Of the equations or of their rates.");
  history(keys, r, scope);
}

void expression(Keys& keys, R& r, const Scope&) {
  keys.about("A formula of other responses, design variables and constants.");
  std::string value;
  keys.text("value", value,
            "Such as \"x_max - x_min\" or \"'tip deflection'/(2 mm) + mass/(1 kg)\".");
  keys.text(optional_key("unit"), r.unit, "In which reports show it; it must fit the formula.");
}

using Table = void (*)(Keys&, R&, const Scope&);

/// In the order of ResponseType.
constexpr Table tables[] = {mass,          stress,
                            deflection,    motion,
                            motion,        motion,
                            drive_effort,  drive_effort,
                            drive_effort,  reaction,
                            reaction,      frequency,
                            buckling,      energy,
                            energy,        energy_balance,
                            drift,         expression,
                            section_force, turning,
                            joint_motion,  joint_motion,
                            spring_state,  spring_state,
                            motor_power,   damper_power,
                            turning,       turning,
                            fatigue,       shear_stress,
                            fatigue,       buckling,
                            motion,        turning,
                            joint_motion,  damped_mode,
                            damped_mode,   transmission_angle};
static_assert(std::size(tables) == std::size(response_kinds));

}  // namespace

}  // namespace pleuel::response_tables

namespace pleuel {

void describe(Keys& keys, ResponseSettings& response, const ResponseScope& scope) {
  response_tables::tables[static_cast<std::size_t>(response.type)](keys, response, scope);
}

}  // namespace pleuel
