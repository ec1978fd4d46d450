#include "core/scene/reading/body_response_reader.hpp"

#include <fmt/format.h>

#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

/// The name of a place of an imported body.
std::string read_place_name(const JsonNode& node, const ImportedBody& body) {
  std::vector<std::string> names;
  for (const BodyPlace& place : body.file->constants.places) names.push_back(place.name);
  return read_known_name(node, "place", names);
}

double read_place(const JsonNode& node) {
  if (!is_within(Range::fraction, node.number())) {
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

}  // namespace

void read_stress(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  if (const auto* imported = find_imported(node, context.scene, response)) {
    read_imported_stress(node, *imported, context, response);
    return;
  }
  allow_history_keys(node, {"body", "part", "segment", "at"});
  const BeamBody& beam = read_elastic_beam(node, context.scene, response);
  const std::optional<JsonNode> segment = node.find("segment"), place = node.find("at");
  if (segment && place) node.fail("has both \"segment\" and \"at\"");
  if (segment) {
    response.segment = segment->whole_number(0, static_cast<int>(beam.segments.size()) - 1);
  }
  if (place) response.station = read_place(*place);
  if (const auto part = node.find("part")) {
    response.part = read_choice<StressPart>(*part, {{"von-mises", StressPart::von_mises},
                                                    {"normal", StressPart::normal},
                                                    {"axial", StressPart::axial},
                                                    {"bending", StressPart::bending},
                                                    {"shear", StressPart::shear},
                                                    {"utilization", StressPart::utilization}});
    const Material* material = find_named(context.scene.materials, beam.material);
    const bool has_strength = material != nullptr && material->strength.has_value();
    if (response.part == StressPart::utilization && !has_strength) {
      part->fail(
          fmt::format("needs the strength of the material \"{}\", which has none", beam.material));
    }
  }
  read_history(node, context, response);
}

void read_deflection(const JsonNode& node, const ResponseContext& context,
                     ResponseSettings& response) {
  allow_history_keys(node, {"body", "at", "direction", "against"});
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
    if (imported != nullptr && response.against == DeflectionReference::chord) {
      against->fail("is for beams: an imported body has no chord");
    }
  }
  if (response.against == DeflectionReference::rigid_mechanism) {
    response.direction = read_choice<int>(node.at("direction"), {{"x", 0}, {"y", 1}, {"z", 2}});
  } else if (const auto direction = node.find("direction")) {
    response.direction = read_choice<int>(*direction, {{"y", 1}, {"z", 2}});
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
  response.direction = response.type == ResponseType::position
                           ? read_choice<int>(direction, {{"x", 0}, {"y", 1}, {"z", 2}})
                           : read_direction_or_magnitude(direction);
  read_history(node, context, response);
}

}  // namespace pleuel
