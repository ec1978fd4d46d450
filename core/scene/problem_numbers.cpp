#include "core/scene/problem_numbers.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/scene/material_library.hpp"
#include "core/scene/reading/document_reader.hpp"
#include "core/scene/scene_rules.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {

namespace {

/// No variable can stand for these.
constexpr const char* gravity = "/scene/gravity/";

bool is_used(const Json& scene, const std::string& material) {
  if (!scene.contains("bodies") || !scene["bodies"].is_object()) return false;
  return std::any_of(scene["bodies"].begin(), scene["bodies"].end(), [&](const Json& body) {
    return body.is_object() && body.contains("material") && body["material"] == material;
  });
}

Json material_document(const Material& material) {
  Json document = {{"young", material.young.constant},
                   {"poisson", material.poisson.constant},
                   {"density", material.density.constant}};
  if (material.strength) document["strength"] = material.strength->constant;
  return document;
}

/// Writes out the materials of the library that bodies name. Whatever is wrong with the document is
/// for the reader to say.
void declare_library_materials(Json& document) {
  if (!document.is_object() || !document.contains("scene")) return;
  Json& scene = document["scene"];
  if (!scene.is_object()) return;
  for (const Material& material : material_library()) {
    if (!is_used(scene, material.name)) continue;
    Json& materials = scene["materials"];
    if (materials.is_null()) materials = Json::object();
    if (materials.is_object() && !materials.contains(material.name)) {
      materials[material.name] = material_document(material);
    }
  }
}

Json document_of(const ProblemText& text) {
  Json document = whole_document(text);
  declare_library_materials(document);
  return document;
}

/// @throws InputError if a number would move a point along an elastic beam
void check_places(const ProblemFile& problem, const std::vector<NumberGroup>& groups) {
  const Design<double> start = start_values(problem.variables);
  const std::size_t first = problem.variables.size() - groups.size();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto moved = find_point_moved_along(problem.scene, start, first + i);
    if (moved) throw InputError(groups[i].name + " " + *moved);
  }
}

std::string unit_written_in(const Json& value) {
  return value.is_string() ? split_quantity(value.get<std::string>()).unit : "";
}

}  // namespace

std::vector<SceneNumber> scene_numbers(const ProblemText& text) {
  const Json document = document_of(text);
  const JsonNode root(document, text.file);
  NumberReader reader(variable_names(root));
  read_document(root, reader);
  std::vector<SceneNumber> numbers;
  for (const FixedNumber& fixed : reader.fixed_numbers()) {
    if (fixed.node.place().starts_with(gravity)) continue;
    numbers.push_back(
        {fixed.node.place(), fixed.value, fixed.quantity, unit_written_in(fixed.node.value())});
  }
  return numbers;
}

ProblemFile bind_numbers(const ProblemText& text, const std::vector<NumberGroup>& groups) {
  Json document = document_of(text);
  for (const NumberGroup& group : groups) {
    const Json value = document[Json::json_pointer(group.pointers.front())];
    document["variables"][group.name] = {{"start", value}, {"lower", value}, {"upper", value}};
    for (const std::string& pointer : group.pointers) {
      document[Json::json_pointer(pointer)] = {{"variable", group.name}};
    }
  }
  const JsonNode root(document, text.file);
  NumberReader reader(variable_names(root));
  ProblemFile problem = read_document(root, reader);
  if (!problem.load_case.empty()) keep_case(problem);
  check_places(problem, groups);
  return problem;
}

}  // namespace pleuel
