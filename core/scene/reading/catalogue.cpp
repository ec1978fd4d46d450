#include "core/scene/reading/catalogue.hpp"

#include <fmt/format.h>

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

}  // namespace

void expand_catalogue(Json& document, const std::string& file) {
  if (!document.is_object() || !document.contains("scene")) return;
  Json& scene = document["scene"];
  if (!scene.is_object()) return;
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
  if (!document.is_object() || !document.contains("scene")) return {};
  Json scene = document["scene"];
  if (!scene.is_object()) return {};
  std::vector<std::string> names;
  for (const SectionReference& reference : find_references(scene, "variable")) {
    const Json& name = (*reference.section)["variable"];
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

}  // namespace pleuel
