#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

Segment read_segment(const JsonNode& node, NumberReader& numbers) {
  Segment segment;
  read_keys(node, numbers, segment);
  segment.section = read_section(node.at("section"), numbers);
  return segment;
}

/// Written fractions are rounded ("0.3333"): what passes the check is made exact.
void normalize_fractions(const JsonNode& node, std::vector<Segment>& segments) {
  std::size_t given = 0;
  double sum = 0.0;
  for (const Segment& segment : segments) {
    if (!segment.fraction) continue;
    ++given;
    sum += *segment.fraction;
  }
  if (given == 0) return;
  if (given != segments.size()) {
    node.fail("must have a \"length_fraction\" in all segments or in none");
  }
  if (std::abs(sum - 1.0) > 1e-6) {
    node.fail(fmt::format("must have length fractions with the sum 1, got the sum {:.9g}", sum));
  }
  for (Segment& segment : segments) *segment.fraction /= sum;
}

std::vector<Segment> read_segments(const JsonNode& node, NumberReader& numbers) {
  const std::optional<JsonNode> list = node.find("segments");
  if (!list) {
    Segment whole;
    whole.section = read_section(node.at("section"), numbers);
    whole.elements = node.at("elements").whole_number(1, most_elements);
    return {whole};
  }
  for (const char* key : {"section", "elements"}) {
    if (node.find(key)) node.fail(fmt::format("has both \"segments\" and \"{}\"", key));
  }
  std::vector<Segment> segments;
  for (const JsonNode& item : list->items()) segments.push_back(read_segment(item, numbers));
  if (segments.empty()) list->fail("must have at least one segment");
  normalize_fractions(*list, segments);
  return segments;
}

/// Of general sections nobody knows how they shear.
void check_shear(const JsonNode& node, const BeamBody& beam) {
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const auto* general = std::get_if<GeneralSection>(&beam.segments[i].section);
    if (!beam.has_shear || general == nullptr || general->shear_area_y) continue;
    node.at("shear").fail(fmt::format(
        "needs \"shear_area_y\" and \"shear_area_z\" [m^2] of sections of the type \"general\", "
        "which the section{} has not",
        beam.segments.size() > 1 ? fmt::format(" of segment {}", i) : ""));
  }
}

/// Damping that is stated for the motion against one frame changes its meaning with many.
void check_damping(const JsonNode& node, const BeamBody& beam) {
  const auto damping = node.find("damping");
  if (!damping) return;
  if (damping->find("modal") && !beam.reduction) {
    damping->at("modal").fail("is for beams with a \"reduction\" only");
  }
  for (const char* key : {"mass", "modal"}) {
    if (beam.frames == 1 || !damping->find(key)) continue;
    node.at("frames").fail(fmt::format(
        "cannot be more than 1 with \"{}\" damping, which acts on the motion against one frame; "
        "\"stiffness\" damping is the same for any number of frames",
        key));
  }
}

OutsideHold read_outside_hold(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"direction", "at"});
  OutsideHold held{numbers.unit_vector(node.at("direction"))};
  const auto at = node.find("at");
  if (!at) return held;
  const std::vector<JsonNode> places =
      at->value().is_array() ? at->items() : std::vector<JsonNode>{*at};
  if (places.empty()) at->fail("must have at least one place");
  for (const JsonNode& place : places) {
    held.at.push_back(numbers.fixed(place, quantities::pure_number, Range::fraction));
  }
  return held;
}

BeamBody read_beam(const JsonNode& node, const std::vector<std::string>& materials,
                   NumberReader& numbers) {
  BeamBody beam;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, beam, materials); },
            {"type", "section", "elements", "segments", "velocity", "angular_velocity",
             "initial_deflections", "held"});
  beam.segments = read_segments(node, numbers);
  check_shear(node, beam);
  check_damping(node, beam);
  if (const auto held = node.find("held")) beam.held = read_outside_hold(*held, numbers);
  return beam;
}

RigidBody read_rigid(const JsonNode& node, NumberReader& numbers) {
  RigidBody body;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, body); },
            {"type", "velocity", "angular_velocity"});
  const std::vector<JsonNode> inertia = node.at("inertia").items(body.inertia.size());
  for (std::size_t i = 0; i < inertia.size(); ++i) {
    const Range range = i < 3 ? Range::not_negative : Range::any;
    body.inertia[i] = numbers.designable(inertia[i], quantities::inertia, range);
  }
  return body;
}

PointMass read_point_mass(const JsonNode& node, NumberReader& numbers) {
  if (const auto turning = node.find("angular_velocity")) {
    turning->fail("is not for a point mass, which does not turn");
  }
  PointMass point;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, point); }, {"type", "velocity"});
  return point;
}

void read_velocities(const JsonNode& node, Body& body, NumberReader& numbers) {
  if (const auto velocity = node.find("velocity")) {
    body.velocity = numbers.triple(*velocity, quantities::speed);
  }
  if (const auto velocity = node.find("angular_velocity")) {
    body.angular_velocity = numbers.triple(*velocity, quantities::angular_speed);
  }
}

void read_initial_deflections(const JsonNode& node, Body& body, NumberReader& numbers) {
  const auto list = node.find("initial_deflections");
  if (!list) return;
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    if (beam->is_rigid) list->fail("is not for a rigid beam");
    if (beam->frames > 1) {
      list->fail("cannot be given with \"frames\" more than 1: each of them counts its own");
    }
  }
  for (const JsonNode& item : list->items()) {
    read_keys(item, numbers, body.initial_deflections.emplace_back());
  }
}

}  // namespace

Body read_body(const std::string& name, const JsonNode& node,
               const std::vector<std::string>& materials, NumberReader& numbers) {
  const Choice<std::function<decltype(Body::shape)()>> shapes[] = {
      {"beam", [&] { return read_beam(node, materials, numbers); }},
      {"rigid", [&] { return read_rigid(node, numbers); }},
      {"point-mass", [&] { return read_point_mass(node, numbers); }},
      {"invariants", [&] { return read_imported_body(name, node, numbers); }}};
  Body body{name, read_choice(node.at("type"), shapes)()};
  read_velocities(node, body, numbers);
  read_initial_deflections(node, body, numbers);
  return body;
}

}  // namespace pleuel
