#pragma once

#include "core/scene/reading/json_node.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/units.hpp"

/// Sections that are chosen from a list: a beam has "section": {"variable": "tube"}, and the
/// variable has "choices": names in the catalogue.
///
/// Such a variable becomes a number, the place of the section in its list, which is brought into
/// ascending order of area (of equal ones: as they are written): 0, 1, 2 … Each number of the section
/// is a smooth function of it (core/base/expression.hpp) that has the values of the catalogue at whole
/// numbers. So the optimizer finds all sections, and others between them, along one path.
namespace pleuel {

/// A section of the document that is a variable.
struct SectionReference {
  Json* section;
  std::string pointer;
};

/// Writes out sections and their variables.
/// @param catalogue  its sections by name; empty if the scene has none
/// @throws InputError  if a name is unknown, or the sections of a list are not of one type
void expand_section_choices(Json& document, const std::vector<SectionReference>& references,
                            const std::string& file, const Json& catalogue);

/// That walls fit into the outline (core/scene/body_rules.hpp), at the start. At other designs
/// build_model() looks.
/// @param node  of the section. @throws InputError
void check_section(const JsonNode& node, const Section& section, const Design<double>& start);

}  // namespace pleuel
