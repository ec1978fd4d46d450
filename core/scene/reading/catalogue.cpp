#include "core/scene/reading/catalogue.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/material_library.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/section_choices.hpp"
#include "core/scene/reading/syntax_error.hpp"

namespace pleuel {
namespace {

namespace fs = std::filesystem;

constexpr const char* catalogue_key = "catalogue";

/// The sections of the file, as they are written.
Json read_catalogue(const fs::path& path) {
  const std::string file = path.string();
  Json document = parse_json(read_text_file(path), file);
  const JsonNode root(document, file, "", "the catalogue");
  root.allow_keys({"description", "sections"});
  if (const auto description = root.find("description")) description->text();
  NumberReader numbers({});
  for (const auto& [name, section] : root.at("sections").members()) {
    for (const auto& [key, value] : section.members()) {
      if (value.value().is_object()) value.fail("cannot be bound to a design variable");
    }
    check_section(section, read_section(section, numbers), {});
  }
  return std::move(document["sections"]);
}

/// The sections that a scene can name; none if it has no catalogue.
Json find_catalogue(const JsonNode& scene) {
  const std::optional<JsonNode> name = scene.find(catalogue_key);
  if (!name) return Json::object();
  return read_catalogue(name->named_file());
}

/// Sections that have the key. Looks as far as the document is built as it should be: what is not is for
/// the readers to complain about.
std::vector<SectionReference> find_references(Json& scene, const char* key) {
  std::vector<SectionReference> found;
  const auto look_in = [&](Json& owner, const std::string& pointer) {
    if (!owner.is_object() || !owner.contains("section")) return;
    Json& section = owner["section"];
    if (!section.is_object() || !section.contains(key)) return;
    found.push_back({&section, child_pointer(pointer, "section")});
  };
  for (const std::string& name : keys_of(scene, "bodies")) {
    Json& body = scene["bodies"][name];
    const std::string pointer = child_pointer("/scene/bodies", name);
    look_in(body, pointer);
    if (!body.is_object() || !body.contains("segments") || !body["segments"].is_array()) continue;
    Json& segments = body["segments"];
    for (std::size_t i = 0; i < segments.size(); ++i) {
      look_in(segments[i], fmt::format("{}/segments/{}", pointer, i));
    }
  }
  return found;
}

/// The scene, where there is one: what is wrong with it is for its reader to say.
Json* find_scene(Json& document) {
  if (!document.is_object() || !document.contains("scene")) return nullptr;
  return document["scene"].is_object() ? &document["scene"] : nullptr;
}

bool is_used(const Json& scene, const std::string& material) {
  if (!scene.contains("bodies") || !scene["bodies"].is_object()) return false;
  return std::ranges::any_of(scene["bodies"], [&](const Json& body) {
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

void expand_materials(Json& scene) {
  for (const Material& material : material_library()) {
    if (!is_used(scene, material.name)) continue;
    if (!scene.contains("materials")) scene["materials"] = Json::object();
    Json& materials = scene["materials"];
    if (materials.is_object() && !materials.contains(material.name)) {
      materials[material.name] = material_document(material);
    }
  }
}

}  // namespace

void expand_names(Json& document, const std::string& file) {
  Json* found = find_scene(document);
  if (found == nullptr) return;
  Json& scene = *found;
  expand_materials(scene);
  const Json catalogue = find_catalogue(JsonNode(scene, file, "/scene"));
  for (const auto& [section, pointer] : find_references(scene, catalogue_key)) {
    const JsonNode node(*section, file, pointer);
    node.allow_keys({catalogue_key});
    if (!scene.contains(catalogue_key)) {
      node.fail("needs a catalogue, but /scene names none: \"catalogue\": \"FILE\"");
    }
    *section = catalogue.at(read_known_name(node.at(catalogue_key), "section", keys_of(catalogue)));
  }
  expand_section_choices(document, find_references(scene, "variable"), file, catalogue);
}

std::vector<std::string> section_variables(const Json& document) {
  Json copy = document;
  Json* scene = find_scene(copy);
  if (scene == nullptr) return {};
  std::vector<std::string> names;
  for (const SectionReference& reference : find_references(*scene, "variable")) {
    const Json& name = (*reference.section)["variable"];
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

}  // namespace pleuel
