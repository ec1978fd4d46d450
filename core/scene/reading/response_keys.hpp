#pragma once

#include <string_view>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"

/// Keys that several responses have. Everything throws InputError.
namespace pleuel {

/// What responses refer to, and who reads their times.
struct ResponseContext {
  const Scene& scene;
  const SimulationSettings& simulation;
  NumberReader& numbers;
};

const Body& read_body_name(const JsonNode& node, const Scene& scene);

/// The beam that the key "body" names, as the one body of the response.
const BeamBody& read_elastic_beam(const JsonNode& node, const Scene& scene,
                                  ResponseSettings& response);

/// The body that the key "body" names, if it is imported, as the one body of the response; else
/// null.
const ImportedBody* find_imported(const JsonNode& node, const Scene& scene,
                                  ResponseSettings& response);

/// x, y, z or the magnitude, as in ResponseSettings::direction.
int read_direction_or_magnitude(const JsonNode& node);

/// These keys, "type", and those of read_history().
void allow_history_keys(const JsonNode& node, std::vector<std::string_view> keys);

/// How the history is reduced over time, and its window.
void read_history(const JsonNode& node, const ResponseContext& context, ResponseSettings& response);

/// The times "from" and "to".
void read_window(const JsonNode& node, const ResponseContext& context, ResponseSettings& response);

}  // namespace pleuel
