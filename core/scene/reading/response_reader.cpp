#include "core/scene/reading/response_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/number_reader.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

const Body& read_body_name(const JsonNode& node, const Scene& scene) {
  const std::string name = read_known_name(node, "body", names_of(scene.bodies));
  return *std::find_if(scene.bodies.begin(), scene.bodies.end(),
                       [&name](const Body& body) { return body.name == name; });
}

const BeamBody& read_beam_name(const JsonNode& node, const Scene& scene) {
  const Body& body = read_body_name(node, scene);
  if (!std::holds_alternative<BeamBody>(body.shape)) {
    node.fail(fmt::format("must name a beam, but \"{}\" is none", body.name));
  }
  return std::get<BeamBody>(body.shape);
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

double read_place(const JsonNode& node) {
  if (!is_within(Range::fraction, node.number())) {
    node.fail_with_value("must be a place along the beam from 0 to 1");
  }
  return node.number();
}

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

void read_stress(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  node.allow_keys({"type", "body", "segment", "over_time"});
  const BeamBody& beam = read_beam_name(node.at("body"), scene);
  response.bodies = {node.at("body").text()};
  if (const auto segment = node.find("segment")) {
    response.segment = segment->whole_number(0, static_cast<int>(beam.segments.size()) - 1);
  }
  response.over_time = read_over_time(node.at("over_time"));
}

void read_deflection(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  node.allow_keys({"type", "body", "at", "direction", "over_time"});
  read_beam_name(node.at("body"), scene);
  response.bodies = {node.at("body").text()};
  response.at = read_place(node.at("at"));
  if (const auto direction = node.find("direction")) {
    response.direction = read_choice<int>(*direction, {{"y", 1}, {"z", 2}});
  }
  response.over_time = read_over_time(node.at("over_time"));
}

void read_position(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  node.allow_keys({"type", "body", "at", "direction", "over_time"});
  const Body& body = read_body_name(node.at("body"), scene);
  response.bodies = {body.name};
  const bool is_beam = std::holds_alternative<BeamBody>(body.shape);
  const std::optional<JsonNode> place = node.find("at");
  if (place && !is_beam) {
    place->fail(fmt::format("is for beams only, but \"{}\" is none", body.name));
  }
  if (is_beam) response.at = read_place(node.at("at"));
  response.direction = read_choice<int>(node.at("direction"), {{"x", 0}, {"y", 1}, {"z", 2}});
  response.over_time = read_over_time(node.at("over_time"));
}

void read_drive_torque(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  node.allow_keys({"type", "joint", "over_time"});
  const JsonNode name = node.at("joint");
  response.joint = read_known_name(name, "joint", names_of(scene.joints));
  const bool is_driven =
      std::any_of(scene.joints.begin(), scene.joints.end(), [&response](const Joint& joint) {
        return joint.name == response.joint && joint.drive.has_value();
      });
  if (!is_driven)
    name.fail(fmt::format("names the joint \"{}\", which has no drive", response.joint));
  response.over_time = read_over_time(node.at("over_time"));
}

ResponseSettings read_response(const std::string& name, const JsonNode& node, const Scene& scene) {
  ResponseSettings response;
  response.name = name;
  response.type =
      read_choice<ResponseType>(node.at("type"), {{"mass", ResponseType::mass},
                                                  {"stress", ResponseType::stress},
                                                  {"deflection", ResponseType::deflection},
                                                  {"position", ResponseType::position},
                                                  {"drive-torque", ResponseType::drive_torque}});
  switch (response.type) {
    case ResponseType::mass:
      read_mass(node, scene, response);
      break;
    case ResponseType::stress:
      read_stress(node, scene, response);
      break;
    case ResponseType::deflection:
      read_deflection(node, scene, response);
      break;
    case ResponseType::position:
      read_position(node, scene, response);
      break;
    case ResponseType::drive_torque:
      read_drive_torque(node, scene, response);
      break;
  }
  return response;
}

}  // namespace

std::vector<ResponseSettings> read_responses(const JsonNode& node, const Scene& scene) {
  std::vector<ResponseSettings> responses;
  for (const auto& [name, response] : node.members()) {
    responses.push_back(read_response(name, response, scene));
  }
  return responses;
}

}  // namespace pleuel
