#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/grammar/response_keys.hpp"
#include "core/scene/kind_table.hpp"

namespace pleuel::response_tables {

namespace {

constexpr Choice<int> frame_axes[] = {{"y", 1}, {"z", 2}, {"x", 0}, {"resultant", -1}};
constexpr Choice<int> chord_axes[] = {{"y", 1}, {"z", 2}, {"resultant", -1}};
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

}  // namespace

void describe(Keys& keys, SectionForceResponse& force, R& r, const Scope& scope) {
  keys.about(
      "Section force [N, N m] of a beam, local axes: axial (positive: tension), moment-z (bends it "
      "in the plane of its local x and y), moment-y, torque, shear-y, shear-z (across it).");
  elastic_beam(keys, body(keys, "body", force.body, scope, "An elastic beam."));
  keys.place("at", force.station.emplace(), "");
  keys.choice("part", force.part, section_parts, "");
  keys.choice(optional_key("side"), force.side, sides,
              "Where a joint or load acts at the place: only that side of it. Default: "
              "both.");
  history(keys, r, scope);
}

namespace {

/// The places at both ends of a chord of an imported body.
std::array<std::string, 2> chord_of_places(Keys& keys, const ImportedBody& imported) {
  const std::vector<BodyPlace>& places = imported.file->constants.places;
  std::array<std::string, 2> ends;
  keys.two_names("chord", "place", names_of(places), ends, "");
  const auto *first = find_named(places, ends[0]), *second = find_named(places, ends[1]);
  const bool is_apart =
      first == nullptr || second == nullptr || (second->position - first->position).norm() > 0.0;
  keys.must("chord", is_apart, "must name two places that are apart from each other");
  return ends;
}

/// A beam has its chord through its ends.
void no_chord(Keys& keys, const std::string& rule, std::string_view sentence) {
  keys.must("chord", false, rule);
  keys.other(optional_key("chord"), "two_places", sentence);
}

}  // namespace

void describe(Keys& keys, BucklingResponse& buckling, R& r, const Scope& scope) {
  keys.about(
      "Compressive force of a beam over the Euler load of the same beam pinned at both "
      "ends; or of the stiffening of an imported body over the force under which the body, "
      "pinned at both ends of its chord, buckles.");
  const Body* one = body(keys, "body", buckling.body, scope, "An elastic beam.");
  if (const auto* imported = shape_of<ImportedBody>(one)) {
    keys.must(
        "body", imported->file->constants.stretching.has_value(),
        fmt::format("names a body whose file {} has no block \"stiffening\"", imported->source));
    buckling.chord = chord_of_places(keys, *imported);
  } else {
    elastic_beam(keys, one);
    no_chord(keys, "is for imported bodies; a beam is pinned at its ends",
             "Of an imported body: the places at both ends of its stiffening.");
  }
  history(keys, r, scope);
}

void describe(Keys& keys, LateralBucklingResponse& buckling, R& r, const Scope& scope) {
  keys.about(
      "Section forces of a beam, which its joints hold sideways, over those at which it "
      "buckles out of the plane in which it bends, sideways as a column, by twisting "
      "under its bending moment, or both; 0 where nothing buckles.");
  elastic_beam(keys, body(keys, "body", buckling.body, scope, "An elastic beam."));
  history(keys, r, scope);
}

void describe(Keys& keys, DeflectionResponse& deflection, R& r, const Scope& scope) {
  keys.about(
      "Deflection [m] of a point of a beam against its frame or chord; or displacement of a place, "
      "global axes, against the same place in the same mechanism without elasticity.");
  const Body* one = body(keys, "body", deflection.point.body, scope, "An elastic beam.");
  const auto* imported = shape_of<ImportedBody>(one);
  if (imported == nullptr) elastic_beam(keys, one);
  place(keys, one, deflection.point);
  keys.choice(optional_key("against"), deflection.against, references,
              "The body frame, the straight line through both ends, or the same mechanism without "
              "elasticity.");
  if (imported != nullptr && deflection.against == DeflectionReference::chord) {
    deflection.chord = chord_of_places(keys, *imported);
  } else {
    no_chord(keys,
             "is for imported bodies with \"against\": \"chord\"; that of a beam is through its "
             "ends",
             "Of an imported body: the places at both ends of its chord.");
  }
  if (deflection.against == DeflectionReference::rigid_mechanism) {
    keys.choice("direction", deflection.direction, axes, "");
  } else if (deflection.against == DeflectionReference::chord) {
    keys.choice(optional_key("direction"), deflection.direction, chord_axes, "");
  } else {
    keys.choice(optional_key("direction"), deflection.direction, frame_axes,
                "Local y or z, their resultant, or x along the beam (against the frame); against "
                "the rigid mechanism one of the global axes.");
  }
  history(keys, r, scope);
}

}  // namespace pleuel::response_tables
