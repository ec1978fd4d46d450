#include "core/scene/reading/response_reader.hpp"

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/grammar/response_table.hpp"
#include "core/scene/reading/expression_response_reader.hpp"
#include "core/scene/reading/joint_type.hpp"
#include "core/scene/reading/key_reader.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/response_kind.hpp"

namespace pleuel {
namespace {

/// Names of columns in files of histories (docs/reference/responses.md).
void check_column(const std::string& name, const JsonNode& node) {
  if (name == "time" || name.ends_with(":error")) {
    node.fail(
        "has a name that files of histories need for their own columns: \"time\" and \"…:error\"");
  }
}

/// Of the motion in a joint: which coordinate, if it has two.
void read_joint_coordinate(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  const bool is_motion = observed_type(response.type) == ResponseType::joint_position ||
                         observed_type(response.type) == ResponseType::joint_velocity;
  if (!is_motion) return;
  const Joint& joint = *find_named(scene.joints, response.joint);
  check_coordinate_between_bodies(node.at("joint"), joint);
  response.coordinate = read_coordinate(node, joint);
}

/// But for formulas, which need all others.
ResponseSettings read_response(const std::string& name, const JsonNode& node,
                               const ResponseScope& scope, NumberReader& numbers) {
  ResponseSettings response;
  response.name = name;
  response.type = read_kind(node.at("type"), response_kinds);
  if (response.type == ResponseType::expression) return response;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, response, scope); }, {"type"});
  read_joint_coordinate(node, scope.scene, response);
  return response;
}

}  // namespace

std::vector<ResponseSettings> read_responses(const JsonNode& node, const Scene& scene,
                                             const SimulationSettings& simulation,
                                             NumberReader& numbers) {
  const ResponseScope scope{scene, simulation.end_time};
  std::vector<ResponseSettings> responses;
  read_each(node, [&](const std::string& name, const JsonNode& response) {
    check_column(name, response);
    responses.push_back(read_response(name, response, scope, numbers));
  });
  MistakeCollector mistakes;
  for (ResponseSettings& response : responses) {
    if (response.type != ResponseType::expression) continue;
    mistakes.collect([&] {
      response =
          read_expression_response(response.name, node.at(response.name), responses, numbers);
    });
  }
  mistakes.fail_if_any();
  return responses;
}

}  // namespace pleuel
