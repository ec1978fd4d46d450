#include <cmath>

#include <fmt/format.h>

#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

constexpr int most_elements = 10000;

enum class BodyType { beam, rigid, point_mass };

Segment read_segment(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"section", "elements", "length_fraction"});
  Segment segment;
  segment.section = read_section(node.at("section"), numbers);
  segment.elements = node.at("elements").whole_number(1, most_elements);
  if (const auto fraction = node.find("length_fraction")) {
    segment.fraction = numbers.fixed(*fraction, quantities::pure_number, Range::positive);
  }
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

Damping read_damping(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"mass", "stiffness"});
  Damping damping;
  if (const auto mass = node.find("mass")) {
    damping.mass = numbers.designable(*mass, quantities::rate, Range::not_negative);
  }
  if (const auto stiffness = node.find("stiffness")) {
    damping.stiffness = numbers.designable(*stiffness, quantities::time, Range::not_negative);
  }
  return damping;
}

BeamBody read_beam(const JsonNode& node, const std::vector<std::string>& materials,
                   NumberReader& numbers) {
  node.allow_keys({"type", "from", "to", "material", "section", "elements", "segments", "frame",
                   "damping", "reference"});
  BeamBody beam;
  beam.from = numbers.triple(node.at("from"), quantities::length);
  beam.to = numbers.triple(node.at("to"), quantities::length);
  beam.material = read_known_name(node.at("material"), "material", materials);
  beam.segments = read_segments(node, numbers);
  if (const auto frame = node.find("frame")) {
    beam.frame = read_choice<ReferenceCondition>(
        *frame, {{"tangent", ReferenceCondition::tangent}, {"chord", ReferenceCondition::chord}});
  }
  if (const auto damping = node.find("damping")) beam.damping = read_damping(*damping, numbers);
  if (const auto reference = node.find("reference")) {
    beam.reference = numbers.direction(*reference);
  }
  return beam;
}

RigidBody read_rigid(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "at", "mass", "inertia"});
  RigidBody body;
  body.at = numbers.triple(node.at("at"), quantities::length);
  body.mass = numbers.designable(node.at("mass"), quantities::mass, Range::positive);
  const std::vector<JsonNode> inertia = node.at("inertia").items(body.inertia.size());
  for (std::size_t i = 0; i < inertia.size(); ++i) {
    const Range range = i < 3 ? Range::not_negative : Range::any;
    body.inertia[i] = numbers.designable(inertia[i], quantities::inertia, range);
  }
  return body;
}

PointMass read_point_mass(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "at", "mass"});
  PointMass point;
  point.at = numbers.triple(node.at("at"), quantities::length);
  point.mass = numbers.designable(node.at("mass"), quantities::mass, Range::positive);
  return point;
}

}  // namespace

Body read_body(const std::string& name, const JsonNode& node,
               const std::vector<std::string>& materials, NumberReader& numbers) {
  const auto type = read_choice<BodyType>(
      node.at("type"),
      {{"beam", BodyType::beam}, {"rigid", BodyType::rigid}, {"point-mass", BodyType::point_mass}});
  if (type == BodyType::beam) return {name, read_beam(node, materials, numbers)};
  if (type == BodyType::rigid) return {name, read_rigid(node, numbers)};
  return {name, read_point_mass(node, numbers)};
}

}  // namespace pleuel
