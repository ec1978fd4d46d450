#include "core/scene/reading/response_keys.hpp"

#include <fmt/format.h>

#include "core/scene/magnitude_direction.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/response_names.hpp"

namespace pleuel {

const Body& read_body_name(const JsonNode& node, const Scene& scene) {
  return *find_named(scene.bodies, read_known_name(node, "body", names_of(scene.bodies)));
}

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

const ImportedBody* find_imported(const JsonNode& node, const Scene& scene,
                                  ResponseSettings& response) {
  const Body& body = read_body_name(node.at("body"), scene);
  const auto* imported = std::get_if<ImportedBody>(&body.shape);
  if (imported != nullptr) response.bodies = {body.name};
  return imported;
}

void allow_history_keys(const JsonNode& node, std::vector<std::string_view> keys) {
  keys.insert(keys.begin(), "type");
  keys.insert(keys.end(), {"over_time", "from", "to"});
  node.allow_keys(keys);
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
  response.over_time = read_choice(node.at("over_time"), over_time_kinds);
  read_window(node, context, response);
}

int read_direction_or_magnitude(const JsonNode& node) {
  return read_choice<int>(node, {{"x", 0}, {"y", 1}, {"z", 2}, {"magnitude", magnitude_direction}});
}

}  // namespace pleuel
