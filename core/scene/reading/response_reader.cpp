#include "core/scene/reading/response_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

constexpr int most_modes = 1000;
constexpr int magnitude = -1;  // ResponseSettings::direction

const Body& read_body_name(const JsonNode& node, const Scene& scene) {
  return *find_named(scene.bodies, read_known_name(node, "body", names_of(scene.bodies)));
}

/// The beam that the key "body" names, as the one body of the response.
const BeamBody& read_elastic_beam(const JsonNode& node, const Scene& scene,
                                  ResponseSettings& response) {
  const JsonNode name = node.at("body");
  const Body& body = read_body_name(name, scene);
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  if (beam == nullptr) name.fail(fmt::format("must name a beam, but \"{}\" is none", body.name));
  if (beam->is_rigid) {
    name.fail(fmt::format("must name an elastic beam, but \"{}\" is rigid", body.name));
  }
  response.bodies = {body.name};
  return *beam;
}

/// The body that the key "body" names, if it is imported, as the one body of the response.
const ImportedBody* find_imported(const JsonNode& node, const Scene& scene,
                                  ResponseSettings& response) {
  const Body& body = read_body_name(node.at("body"), scene);
  const auto* imported = std::get_if<ImportedBody>(&body.shape);
  if (imported != nullptr) response.bodies = {body.name};
  return imported;
}

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

// Responses with a history.

void allow_history_keys(const JsonNode& node, std::vector<std::string_view> keys) {
  keys.insert(keys.begin(), "type");
  keys.insert(keys.end(), {"over_time", "from", "to"});
  node.allow_keys(keys);
}

OverTime read_over_time(const JsonNode& node) {
  return read_choice<OverTime>(node, {{"max", OverTime::max},
                                      {"min", OverTime::min},
                                      {"max-abs", OverTime::max_abs},
                                      {"rms", OverTime::rms},
                                      {"mean", OverTime::mean},
                                      {"integral", OverTime::integral},
                                      {"final", OverTime::final}});
}

void read_window(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  const std::optional<JsonNode> from = node.find("from"), to = node.find("to");
  const double end = context.simulation.end_time;
  if (from) {
    response.from = context.numbers.fixed(*from, quantities::time, Range::not_negative);
    if (*response.from >= end) {
      from->fail_with_value(fmt::format("must be before the end of the simulation, {:g} [s]", end));
    }
  }
  if (!to) return;
  response.to = context.numbers.fixed(*to, quantities::time, Range::positive);
  if (*response.to > end) {
    to->fail_with_value(fmt::format("must not be after the end of the simulation, {:g} [s]", end));
  }
  if (from && *response.from >= *response.to) to->fail_with_value("must be later than \"from\"");
}

void read_history(const JsonNode& node, const ResponseContext& context,
                  ResponseSettings& response) {
  response.over_time = read_over_time(node.at("over_time"));
  read_window(node, context, response);
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

int read_direction_or_magnitude(const JsonNode& node) {
  return read_choice<int>(node, {{"x", 0}, {"y", 1}, {"z", 2}, {"magnitude", magnitude}});
}

/// Position, velocity or acceleration. The magnitude of a position would depend on the origin.
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

const Joint& read_joint_name(const JsonNode& node, const Scene& scene) {
  return *find_named(scene.joints, read_known_name(node, "joint", names_of(scene.joints)));
}

/// A drive of an angle has a torque, one of a displacement a force.
void check_effort(const JsonNode& name, const Joint& joint, ResponseType type) {
  const bool is_angle = joint.drive->coordinate == DrivenCoordinate::angle;
  if (type == ResponseType::drive_torque && !is_angle) {
    name.fail(fmt::format("names the joint \"{}\", whose drive has a drive-force", joint.name));
  }
  if (type == ResponseType::drive_force && is_angle) {
    name.fail(fmt::format("names the joint \"{}\", whose drive has a drive-torque", joint.name));
  }
}

void read_drive_effort(const JsonNode& node, const ResponseContext& context,
                       ResponseSettings& response) {
  allow_history_keys(node, {"joint"});
  const JsonNode name = node.at("joint");
  const Joint& joint = read_joint_name(name, context.scene);
  if (!joint.drive) {
    name.fail(fmt::format("names the joint \"{}\", which has no drive", joint.name));
  }
  check_effort(name, joint, response.type);
  response.joint = joint.name;
  read_history(node, context, response);
}

void read_reaction(const JsonNode& node, const ResponseContext& context,
                   ResponseSettings& response) {
  allow_history_keys(node, {"joint", "direction"});
  response.joint = read_joint_name(node.at("joint"), context.scene).name;
  response.direction = read_direction_or_magnitude(node.at("direction"));
  read_history(node, context, response);
}

/// Kinetic or elastic, of one body or of all.
void read_energy(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  allow_history_keys(node, {"body"});
  if (const auto body = node.find("body")) {
    const bool is_elastic = response.type == ResponseType::elastic_energy;
    if (is_elastic && find_imported(node, context.scene, response) == nullptr) {
      read_elastic_beam(node, context.scene, response);
    } else {
      response.bodies = {read_body_name(*body, context.scene).name};
    }
  }
  read_history(node, context, response);
}

void read_energy_balance(const JsonNode& node, const ResponseContext& context,
                         ResponseSettings& response) {
  node.allow_keys({"type", "from", "to", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail("is not for an energy-balance, which compares two times");
  }
  response.over_time = OverTime::final;
  read_window(node, context, response);
}

void read_drift(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  allow_history_keys(node, {"level"});
  if (const auto level = node.find("level")) {
    response.level = read_choice<DriftLevel>(
        *level, {{"position", DriftLevel::position}, {"velocity", DriftLevel::velocity}});
  }
  read_history(node, context, response);
}

// Responses without.

void read_mass(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  node.allow_keys({"type", "body", "bodies", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail("is not for a mass, which does not change in time");
  }
  const std::optional<JsonNode> one = node.find("body"), many = node.find("bodies");
  if (one && many) node.fail("has both \"body\" and \"bodies\"");
  if (one) response.bodies = {read_body_name(*one, scene).name};
  if (!many) return;
  for (const JsonNode& item : many->items()) {
    const std::string name = read_body_name(item, scene).name;
    if (std::find(response.bodies.begin(), response.bodies.end(), name) != response.bodies.end()) {
      item.fail(fmt::format("names the body \"{}\" a second time", name));
    }
    response.bodies.push_back(name);
  }
  if (response.bodies.empty()) many->fail("must name at least one body");
}

void read_frequency(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  node.allow_keys({"type", "body", "mode", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail("is not for a frequency, which does not change in time");
  }
  if (node.find("body") && find_imported(node, scene, response) == nullptr) {
    read_elastic_beam(node, scene, response);
  }
  if (const auto mode = node.find("mode")) response.mode = mode->whole_number(1, most_modes) - 1;
}

ResponseType read_response_type(const JsonNode& node) {
  return read_choice<ResponseType>(node, {{"mass", ResponseType::mass},
                                          {"stress", ResponseType::stress},
                                          {"deflection", ResponseType::deflection},
                                          {"position", ResponseType::position},
                                          {"velocity", ResponseType::velocity},
                                          {"acceleration", ResponseType::acceleration},
                                          {"drive-torque", ResponseType::drive_torque},
                                          {"drive-force", ResponseType::drive_force},
                                          {"drive-power", ResponseType::drive_power},
                                          {"reaction-force", ResponseType::reaction_force},
                                          {"reaction-moment", ResponseType::reaction_moment},
                                          {"frequency", ResponseType::frequency},
                                          {"buckling", ResponseType::buckling},
                                          {"kinetic-energy", ResponseType::kinetic_energy},
                                          {"elastic-energy", ResponseType::elastic_energy},
                                          {"energy-balance", ResponseType::energy_balance},
                                          {"constraint-drift", ResponseType::constraint_drift}});
}

ResponseSettings read_response(const std::string& name, const JsonNode& node,
                               const ResponseContext& context) {
  ResponseSettings response;
  response.name = name;
  response.type = read_response_type(node.at("type"));
  switch (response.type) {
    case ResponseType::mass:
      read_mass(node, context.scene, response);
      break;
    case ResponseType::frequency:
      read_frequency(node, context.scene, response);
      break;
    case ResponseType::stress:
      read_stress(node, context, response);
      break;
    case ResponseType::deflection:
      read_deflection(node, context, response);
      break;
    case ResponseType::buckling:
      read_buckling(node, context, response);
      break;
    case ResponseType::position:
    case ResponseType::velocity:
    case ResponseType::acceleration:
      read_motion(node, context, response);
      break;
    case ResponseType::drive_torque:
    case ResponseType::drive_force:
    case ResponseType::drive_power:
      read_drive_effort(node, context, response);
      break;
    case ResponseType::reaction_force:
    case ResponseType::reaction_moment:
      read_reaction(node, context, response);
      break;
    case ResponseType::kinetic_energy:
    case ResponseType::elastic_energy:
      read_energy(node, context, response);
      break;
    case ResponseType::energy_balance:
      read_energy_balance(node, context, response);
      break;
    case ResponseType::constraint_drift:
      read_drift(node, context, response);
      break;
  }
  return response;
}

}  // namespace

std::vector<ResponseSettings> read_responses(const JsonNode& node, const ResponseContext& context) {
  std::vector<ResponseSettings> responses;
  for (const auto& [name, response] : node.members()) {
    responses.push_back(read_response(name, response, context));
  }
  return responses;
}

}  // namespace pleuel
