#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

enum class SectionType { rectangle, circle, tube };

Number read_size(const JsonNode& section, const char* key, NumberReader& numbers) {
  return numbers.designable(section.at(key), quantities::length, Range::positive);
}

}  // namespace

Section read_section(const JsonNode& node, NumberReader& numbers) {
  const auto type =
      read_choice<SectionType>(node.at("type"), {{"rectangle", SectionType::rectangle},
                                                 {"circle", SectionType::circle},
                                                 {"tube", SectionType::tube}});
  switch (type) {
    case SectionType::rectangle:
      node.allow_keys({"type", "width", "height"});
      return RectangleSection{read_size(node, "width", numbers),
                              read_size(node, "height", numbers)};
    case SectionType::circle:
      node.allow_keys({"type", "diameter"});
      return CircleSection{read_size(node, "diameter", numbers)};
    case SectionType::tube:
      break;
  }
  node.allow_keys({"type", "outer_diameter", "thickness"});
  return TubeSection{read_size(node, "outer_diameter", numbers),
                     read_size(node, "thickness", numbers)};
}

}  // namespace pleuel
