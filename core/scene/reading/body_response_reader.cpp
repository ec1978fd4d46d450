#include "core/scene/reading/body_response_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/magnitude_direction.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/response_names.hpp"

namespace pleuel {
namespace {

/// The name of a place of an imported body.
std::string read_place_name(const JsonNode& node, const ImportedBody& body) {
  std::vector<std::string> names;
  for (const BodyPlace& place : body.file->constants.places) names.push_back(place.name);
  return read_known_name(node, "place", names);
}

/// The places at both ends of a chord, apart from each other.
std::array<std::string, 2> read_chord(const JsonNode& node, const ImportedBody& body) {
  const std::vector<JsonNode> names = node.items(2);
  const std::array<std::string, 2> ends = {read_place_name(names[0], body),
                                           read_place_name(names[1], body)};
  const auto position = [&](const std::string& name) {
    const std::vector<BodyPlace>& places = body.file->constants.places;
    return find_named(places, name)->position;
  };
  if ((position(ends[1]) - position(ends[0])).norm() == 0.0) {
    node.fail("must name two places that are apart from each other");
  }
  return ends;
}

/// A component, the magnitude, or the component along a vector.
void read_direction_or_vector(const JsonNode& node, const ResponseContext& context,
                              ResponseSettings& response) {
  if (!node.value().is_array()) {
    response.direction = read_direction_or_magnitude(node);
    return;
  }
  response.along = context.numbers.unit_vector(node);
  response.direction = magnitude_direction;
}

double read_place(const JsonNode& node) {
  if (!node.value().is_number() || !is_within(Range::fraction, node.number())) {
    node.fail_with_value("must be a place along the beam from 0 to 1");
  }
  return node.number();
}

/// What the points of stress of a file are good for: they know nothing of sections.
void read_imported_stress(const JsonNode& node, const ImportedBody& body,
                          const ResponseContext& context, ResponseSettings& response) {
  allow_history_keys(node, {"body", "part"});
  const std::optional<StressRecovery>& stress = body.file->constants.stress;
  if (!stress) {
    node.at("body").fail(
        fmt::format("names a body whose file {} has no block \"stress\"", body.source));
  }
  if (const auto part = node.find("part")) {
    response.part = read_choice<StressPart>(*part, {{"von-mises", StressPart::von_mises},
                                                    {"normal", StressPart::normal},
                                                    {"utilization", StressPart::utilization}});
    if (response.part == StressPart::utilization && stress->strength == 0.0) {
      part->fail(fmt::format("needs a strength, which the file {} does not give", body.source));
    }
  }
  read_history(node, context, response);
}

StressPart read_stress_part(const JsonNode& node) {
  return read_choice<StressPart>(node, {{"von-mises", StressPart::von_mises},
                                        {"normal", StressPart::normal},
                                        {"axial", StressPart::axial},
                                        {"bending", StressPart::bending},
                                        {"shear", StressPart::shear},
                                        {"utilization", StressPart::utilization}});
}

void check_strength(const JsonNode& part, const std::string& name, const Scene& scene) {
  const Material* material = find_named(scene.materials, name);
  const bool has_strength = material != nullptr && material->strength.has_value();
  if (has_strength) return;
  part.fail(fmt::format("needs the strength of the material \"{}\", which has none", name));
}

/// Several elastic beams; check(node, beam) may refuse one.
template <class Check>
void read_beams(const JsonNode& list, const Scene& scene, ResponseSettings& response,
                const Check& check) {
  std::vector<std::string> bodies;
  for (const JsonNode& item : list.items()) {
    const Body& body = read_body_name(item, scene);
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || beam->is_rigid) {
      item.fail(fmt::format("must name an elastic beam, but \"{}\" is none", body.name));
    }
    if (std::find(bodies.begin(), bodies.end(), body.name) != bodies.end()) {
      item.fail(fmt::format("names the body \"{}\" a second time", body.name));
    }
    check(item, *beam);
    bodies.push_back(body.name);
  }
  if (bodies.empty()) list.fail("must name at least one body");
  response.bodies = std::move(bodies);
}

/// Of several beams at once.
void read_stress_of_beams(const JsonNode& node, const JsonNode& list,
                          const ResponseContext& context, ResponseSettings& response) {
  allow_history_keys(node, {"bodies", "part"});
  const auto part = node.find("part");
  if (part) response.part = read_stress_part(*part);
  read_beams(list, context.scene, response, [&](const JsonNode&, const BeamBody& beam) {
    if (response.part != StressPart::utilization) return;
    check_strength(*part, beam.material, context.scene);
  });
  read_history(node, context, response);
}

/// One segment or one place of a beam, or all of it.
void read_stretch(const JsonNode& node, const BeamBody& beam, ResponseSettings& response) {
  const std::optional<JsonNode> segment = node.find("segment"), place = node.find("at");
  if (segment && place) node.fail("has both \"segment\" and \"at\"");
  if (segment) {
    response.segment = segment->whole_number(0, int_size(beam.segments) - 1);
  }
  if (place) response.station = read_place(*place);
}

/// What a criterion needs of a material, and what the endurance or the damage does.
void check_fatigue_data(const JsonNode& criterion, const ResponseSettings& response,
                        const std::string& name, const Scene& scene) {
  const Material* material = find_named(scene.materials, name);
  if (material == nullptr) return;
  const auto require = [&](const auto& number, const char* key) {
    if (number) return;
    criterion.fail(
        fmt::format("needs the \"{}\" of the material \"{}\", which has none: give it in "
                    "/scene/materials",
                    key, name));
  };
  if (response.type == ResponseType::fatigue) {
    require(material->endurance_limit, "endurance_limit");
  } else {
    require(material->fatigue_strength, "fatigue_strength");
    require(material->fatigue_exponent, "fatigue_exponent");
  }
  if (response.criterion == FatigueCriterion::soderberg) {
    require(material->strength, "strength");
  } else {
    require(material->ultimate_strength, "ultimate_strength");
  }
}

}  // namespace

void read_stress(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  if (const auto list = node.find("bodies")) {
    if (node.find("body")) node.fail("has both \"body\" and \"bodies\"");
    read_stress_of_beams(node, *list, context, response);
    return;
  }
  if (const auto* imported = find_imported(node, context.scene, response)) {
    read_imported_stress(node, *imported, context, response);
    return;
  }
  allow_history_keys(node, {"body", "part", "segment", "at"});
  const BeamBody& beam = read_elastic_beam(node, context.scene, response);
  read_stretch(node, beam, response);
  if (const auto part = node.find("part")) {
    response.part = read_stress_part(*part);
    if (response.part == StressPart::utilization) {
      check_strength(*part, beam.material, context.scene);
    }
  }
  read_history(node, context, response);
}

void read_shear_stress(const JsonNode& node, const ResponseContext& context,
                       ResponseSettings& response) {
  const auto check = [&](const JsonNode& name, const BeamBody& beam) {
    const bool is_general =
        std::any_of(beam.segments.begin(), beam.segments.end(), [](const Segment& segment) {
          return std::holds_alternative<GeneralSection>(segment.section);
        });
    if (!is_general) return;
    name.fail(
        "names a beam with a general section, whose properties do not tell where shear forces act "
        "in it; \"section-force\" gives the forces");
  };
  if (const auto list = node.find("bodies")) {
    if (node.find("body")) node.fail("has both \"body\" and \"bodies\"");
    allow_history_keys(node, {"bodies"});
    read_beams(*list, context.scene, response, check);
  } else {
    allow_history_keys(node, {"body", "segment", "at"});
    const BeamBody& beam = read_elastic_beam(node, context.scene, response);
    read_stretch(node, beam, response);
    check(node.at("body"), beam);
  }
  read_history(node, context, response);
}

void read_fatigue(const JsonNode& node, const ResponseContext& context,
                  ResponseSettings& response) {
  if (const auto over_time = node.find("over_time")) {
    over_time->fail(
        "is not for a fatigue, which looks at the largest and the smallest stress of cycles");
  }
  const JsonNode criterion = node.at("criterion");
  response.criterion = read_choice(criterion, fatigue_criteria);
  response.over_time = OverTime::final;
  const auto check = [&](const JsonNode&, const BeamBody& beam) {
    check_fatigue_data(criterion, response, beam.material, context.scene);
  };
  if (const auto list = node.find("bodies")) {
    if (node.find("body")) node.fail("has both \"body\" and \"bodies\"");
    node.allow_keys({"type", "bodies", "criterion", "from", "to"});
    if (response.type == ResponseType::fatigue_damage) {
      list->fail("is not for a fatigue-damage: give one \"body\"");
    }
    read_beams(*list, context.scene, response, check);
  } else {
    node.allow_keys({"type", "body", "criterion", "segment", "at", "from", "to"});
    const BeamBody& beam = read_elastic_beam(node, context.scene, response);
    read_stretch(node, beam, response);
    check(node, beam);
  }
  read_window(node, context, response);
}

void read_section_force(const JsonNode& node, const ResponseContext& context,
                        ResponseSettings& response) {
  allow_history_keys(node, {"body", "at", "part", "side"});
  read_elastic_beam(node, context.scene, response);
  response.station = read_place(node.at("at"));
  if (const auto side = node.find("side")) {
    response.side = read_choice<SectionSide>(
        *side, {{"before", SectionSide::before}, {"behind", SectionSide::behind}});
  }
  response.section_part =
      read_choice<SectionForcePart>(node.at("part"), {{"axial", SectionForcePart::axial},
                                                      {"moment-y", SectionForcePart::moment_y},
                                                      {"moment-z", SectionForcePart::moment_z},
                                                      {"torque", SectionForcePart::torque},
                                                      {"shear-y", SectionForcePart::shear_y},
                                                      {"shear-z", SectionForcePart::shear_z}});
  read_history(node, context, response);
}

void read_turning(const JsonNode& node, const ResponseContext& context,
                  ResponseSettings& response) {
  allow_history_keys(node, {"body", "direction"});
  const JsonNode name = node.at("body");
  const Body& body = read_body_name(name, context.scene);
  if (std::holds_alternative<PointMass>(body.shape)) {
    name.fail(fmt::format("must name a body that can turn, but \"{}\" is a point mass", body.name));
  }
  response.bodies = {body.name};
  const JsonNode direction = node.at("direction");
  if (response.type == ResponseType::angle) {
    response.direction = read_choice<int>(direction, {{"x", 0}, {"y", 1}, {"z", 2}});
  } else {
    read_direction_or_vector(direction, context, response);
  }
  read_history(node, context, response);
}

void read_deflection(const JsonNode& node, const ResponseContext& context,
                     ResponseSettings& response) {
  allow_history_keys(node, {"body", "at", "direction", "against", "chord"});
  const auto* imported = find_imported(node, context.scene, response);
  if (imported != nullptr) {
    response.place = read_place_name(node.at("at"), *imported);
  } else {
    read_elastic_beam(node, context.scene, response);
    response.at = read_place(node.at("at"));
  }
  if (const auto against = node.find("against")) {
    response.against = read_choice<DeflectionReference>(
        *against, {{"frame", DeflectionReference::frame},
                   {"chord", DeflectionReference::chord},
                   {"rigid-mechanism", DeflectionReference::rigid_mechanism}});
  }
  const bool needs_ends = imported != nullptr && response.against == DeflectionReference::chord;
  if (needs_ends) {
    response.chord = read_chord(node.at("chord"), *imported);
  } else if (const auto chord = node.find("chord")) {
    chord->fail(
        "is for imported bodies with \"against\": \"chord\"; that of a beam is through its ends");
  }
  if (response.against == DeflectionReference::rigid_mechanism) {
    response.direction = read_choice<int>(node.at("direction"), {{"x", 0}, {"y", 1}, {"z", 2}});
  } else if (const auto direction = node.find("direction")) {
    response.direction =
        response.against == DeflectionReference::frame
            ? read_choice<int>(*direction, {{"y", 1}, {"z", 2}, {"x", 0}, {"resultant", -1}})
            : read_choice<int>(*direction, {{"y", 1}, {"z", 2}, {"resultant", -1}});
  }
  read_history(node, context, response);
}

void read_buckling(const JsonNode& node, const ResponseContext& context,
                   ResponseSettings& response) {
  allow_history_keys(node, {"body"});
  read_elastic_beam(node, context.scene, response);
  read_history(node, context, response);
}

void read_motion(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  allow_history_keys(node, {"body", "at", "direction"});
  const Body& body = read_body_name(node.at("body"), context.scene);
  response.bodies = {body.name};
  const bool is_beam = std::holds_alternative<BeamBody>(body.shape);
  const auto* imported = std::get_if<ImportedBody>(&body.shape);
  const std::optional<JsonNode> place = node.find("at");
  if (place && !is_beam && imported == nullptr) {
    place->fail(fmt::format("is for beams only, but \"{}\" is none", body.name));
  }
  if (imported != nullptr) response.place = read_place_name(node.at("at"), *imported);
  if (is_beam) response.at = read_place(node.at("at"));
  const JsonNode direction = node.at("direction");
  if (response.type == ResponseType::position && !direction.value().is_array()) {
    response.direction = read_choice<int>(direction, {{"x", 0}, {"y", 1}, {"z", 2}});
  } else {
    read_direction_or_vector(direction, context, response);
  }
  read_history(node, context, response);
}

}  // namespace pleuel
