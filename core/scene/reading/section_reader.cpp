#include <fmt/format.h>

#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

using Reader = Section (*)(const JsonNode& node, NumberReader& numbers);

Number read_size(const JsonNode& section, const char* key, NumberReader& numbers) {
  return numbers.designable(section.at(key), quantities::length, Range::positive);
}

Section read_rectangle(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "width", "height"});
  return RectangleSection{read_size(node, "width", numbers), read_size(node, "height", numbers)};
}

Section read_circle(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "diameter"});
  return CircleSection{read_size(node, "diameter", numbers)};
}

Section read_tube(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "outer_diameter", "thickness"});
  return TubeSection{read_size(node, "outer_diameter", numbers),
                     read_size(node, "thickness", numbers)};
}

Section read_ellipse(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "width", "height"});
  return EllipseSection{read_size(node, "width", numbers), read_size(node, "height", numbers)};
}

Section read_box(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "width", "height", "thickness"});
  return BoxSection{read_size(node, "width", numbers), read_size(node, "height", numbers),
                    read_size(node, "thickness", numbers)};
}

Section read_i(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "width", "height", "flange_thickness", "web_thickness"});
  return ISection{read_size(node, "width", numbers), read_size(node, "height", numbers),
                  read_size(node, "flange_thickness", numbers),
                  read_size(node, "web_thickness", numbers)};
}

/// Bound only by sections that are chosen from a list (section_choices.hpp).
Number read_of_point(const JsonNode& node, const Quantity& quantity, Range range,
                     NumberReader& numbers) {
  const bool is_path = node.value().is_object() && node.value().contains("path");
  if (is_path) return numbers.designable(node, quantity, range);
  return numbers.fixed(node, quantity, range);
}

GeneralStressPoint read_stress_point(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"y", "z", "shear"});
  return {
      read_of_point(node.at("y"), quantities::length, Range::any, numbers),
      read_of_point(node.at("z"), quantities::length, Range::any, numbers),
      read_of_point(node.at("shear"), quantities::torsional_shear, Range::not_negative, numbers)};
}

Section read_general(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "area", "inertia_y", "inertia_z", "torsion", "points", "shear_area_y",
                   "shear_area_z"});
  const auto read = [&](const char* key, const Quantity& quantity) {
    return numbers.designable(node.at(key), quantity, Range::positive);
  };
  GeneralSection section;
  section.area = read("area", quantities::area);
  section.inertia_y = read("inertia_y", quantities::second_moment_of_area);
  section.inertia_z = read("inertia_z", quantities::second_moment_of_area);
  section.torsion = read("torsion", quantities::second_moment_of_area);
  const bool has_y = node.find("shear_area_y").has_value();
  const bool has_z = node.find("shear_area_z").has_value();
  if (has_y != has_z) {
    node.fail(fmt::format("has \"shear_area_{}\" without \"shear_area_{}\"", has_y ? 'y' : 'z',
                          has_y ? 'z' : 'y'));
  }
  if (has_y) {
    section.shear_area_y = read("shear_area_y", quantities::area);
    section.shear_area_z = read("shear_area_z", quantities::area);
  }
  const JsonNode points = node.at("points");
  for (const JsonNode& point : points.items()) {
    section.points.push_back(read_stress_point(point, numbers));
  }
  if (section.points.empty()) points.fail("must have at least one point");
  return section;
}

}  // namespace

Section read_section(const JsonNode& node, NumberReader& numbers) {
  const auto read = read_choice<Reader>(node.at("type"), {{"rectangle", read_rectangle},
                                                          {"circle", read_circle},
                                                          {"tube", read_tube},
                                                          {"ellipse", read_ellipse},
                                                          {"box", read_box},
                                                          {"i", read_i},
                                                          {"general", read_general}});
  return read(node, numbers);
}

}  // namespace pleuel
