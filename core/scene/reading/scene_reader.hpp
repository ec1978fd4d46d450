#pragma once

#include "core/base/find_named.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/key_reader.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// Gravity, materials, bodies, joints and loads, with every name in them known. @throws InputError
Scene read_scene(const JsonNode& node, NumberReader& numbers);

/// `materials` are the names there are. @throws InputError
Body read_body(const std::string& name, const JsonNode& node,
               const std::vector<std::string>& materials, NumberReader& numbers);

/// A body from a file of invariants, or one that is made for each design. @throws InputError
ImportedBody read_imported_body(const std::string& name, const JsonNode& node,
                                NumberReader& numbers);

/// `bodies` are the names there are, "ground" among them. @throws InputError
Joint read_joint(const std::string& name, const JsonNode& node,
                 const std::vector<std::string>& bodies, NumberReader& numbers);

/// The names of two different bodies, "ground" among them. @throws InputError
std::array<std::string, 2> read_pair(const JsonNode& node, const std::vector<std::string>& bodies);

/// `scene` has its bodies and joints. @throws InputError
Load read_load(const std::string& name, const JsonNode& node, const Scene& scene,
               NumberReader& numbers);

/// @throws InputError
inline Section read_section(const JsonNode& node, NumberReader& numbers) {
  Section section = read_row(node.at("type"), section_kinds()).made;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, section); }, {"type"});
  return section;
}

}  // namespace pleuel
