#include "core/scene/reading/catalogue.hpp"

#include <filesystem>

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

/// Looks as far as the document is built as it should be: what is not is for the readers to
/// complain about.
class ReferenceSearch {
 public:
  /// Sections that have the key.
  std::vector<SectionReference> find(Json& scene, const char* key) {
    key_ = key;
    if (!scene.contains("bodies") || !scene["bodies"].is_object()) return {};
    for (auto& [name, body] : scene["bodies"].items()) {
      const std::string pointer = child_pointer("/scene/bodies", name);
      look_in(body, pointer);
      if (body.is_object() && body.contains("segments") && body["segments"].is_array()) {
        look_in_all(body["segments"], child_pointer(pointer, "segments"));
      }
    }
    return std::move(found_);
  }

 private:
  void look_in(Json& owner, const std::string& pointer) {
    if (!owner.is_object() || !owner.contains("section")) return;
    Json& section = owner["section"];
    if (!section.is_object() || !section.contains(key_)) return;
    found_.push_back({&section, child_pointer(pointer, "section")});
  }
  void look_in_all(Json& segments, const std::string& pointer) {
    for (std::size_t i = 0; i < segments.size(); ++i) {
      look_in(segments[i], child_pointer(pointer, std::to_string(i)));
    }
  }

  const char* key_ = "";
  std::vector<SectionReference> found_;
};

}  // namespace

void expand_catalogue(Json& document, const std::string& file) {
  if (!document.is_object() || !document.contains("scene")) return;
  Json& scene = document["scene"];
  if (!scene.is_object()) return;
  const Json catalogue = find_catalogue(JsonNode(scene, file, "/scene"));
  std::vector<std::string> names;
  for (const auto& [name, section] : catalogue.items()) names.push_back(name);
  for (const auto& [section, pointer] : ReferenceSearch().find(scene, catalogue_key)) {
    const JsonNode node(*section, file, pointer);
    node.allow_keys({catalogue_key});
    if (!scene.contains(catalogue_key)) {
      node.fail("needs a catalogue, but /scene names none: \"catalogue\": \"FILE\"");
    }
    *section = catalogue.at(read_known_name(node.at(catalogue_key), "section", names));
  }
  expand_section_choices(document, ReferenceSearch().find(scene, "variable"), file, catalogue);
}

std::vector<std::string> section_variables(const Json& document) {
  if (!document.is_object() || !document.contains("scene")) return {};
  Json scene = document["scene"];
  if (!scene.is_object()) return {};
  std::vector<std::string> names;
  for (const SectionReference& reference : ReferenceSearch().find(scene, "variable")) {
    const Json& name = (*reference.section)["variable"];
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

}  // namespace pleuel
